#pragma once
// Descriptor layouts and pipelines, created at first use and cached. Main thread only, private to renderer/.

#include "engine/program/surface_program.h"
#include "renderer/graphics_pipeline.h"
#include "renderer/scene_vertex.h"
#include "renderer/view.h"

#include <map>
#include <memory>
#include <span>
#include <string>
#include <tuple>

namespace touchstone {

/// The stages that read shared::ObjectConstants.
inline constexpr vk::ShaderStageFlags kObjectStages =
    vk::ShaderStageFlagBits::eVertex | vk::ShaderStageFlagBits::eFragment;

/// The three passes of the overlay.
enum class OverlayPass : uint8_t { Hidden, Opaque, Translucent };

class Pipelines {
  public:
    explicit Pipelines(const Gpu::Impl& gpu);

    [[nodiscard]] vk::DescriptorSetLayout frameSet() const { return *frameSet_; }
    [[nodiscard]] vk::DescriptorSetLayout materialSet() const { return *materialSet_; }
    [[nodiscard]] vk::DescriptorSetLayout falseColorSet() const { return *falseColorSet_; }
    /// Depth and light of a kept picture.
    [[nodiscard]] vk::DescriptorSetLayout keptSet() const { return *keptSet_; }
    /// Parameters of a haptic program, and the place of an instance (dynamic offset).
    [[nodiscard]] vk::DescriptorSetLayout programSet() const { return *programSet_; }
    /// Of `programmed`; compatible with sceneLayout in its sets 0 and 1.
    [[nodiscard]] vk::PipelineLayout programLayout() const { return *programLayout_; }
    [[nodiscard]] vk::PipelineLayout sceneLayout() const { return *sceneLayout_; }
    [[nodiscard]] vk::PipelineLayout falseColorLayout() const { return *falseColorLayout_; }
    [[nodiscard]] vk::PipelineLayout overlayLayout() const { return *overlayLayout_; }
    [[nodiscard]] vk::PipelineLayout keptLayout() const { return *keptLayout_; }

    /// `features`: kHas... bits of shaders/shared/scene_types.h. Cull mode and front face are dynamic.
    /// `keepsLight`: into the attachments of a kept picture; not for blended features.
    [[nodiscard]] vk::Pipeline scene(uint32_t features, bool keepsLight = false);
    /// The same with a haptic program; null where it cannot be shown: the surface is plain (programProblem).
    /// Glass, lines and points show none.
    [[nodiscard]] vk::Pipeline programmed(uint32_t features, bool keepsLight,
                                          const std::shared_ptr<const SurfaceProgram>& program);
    /// Empty, or why it is not shown; known once `programmed` was asked for it.
    [[nodiscard]] std::string programProblem(const std::shared_ptr<const SurfaceProgram>& program) const;
    /// Drops pipelines of all programs but these. No frame may be in flight.
    void keepPrograms(std::span<const MaterialProgram> programs);
    [[nodiscard]] vk::Pipeline falseColor(uint32_t features, ViewMode mode);
    /// `clipped`: kIsClipped. Only where the device draws triangles as lines.
    [[nodiscard]] vk::Pipeline wireframe(bool clipped);
    [[nodiscard]] vk::Pipeline background(bool keepsLight = false);
    [[nodiscard]] vk::Pipeline keptShadow();
    [[nodiscard]] vk::Pipeline shapes(OverlayPass pass);
    [[nodiscard]] vk::Pipeline lines(OverlayPass pass);

    [[nodiscard]] size_t compiled() const { return pipelines_.size(); }

  private:
    /// A program and the shaders that it is part of.
    struct LinkedShaders {
        uint32_t number = 0; ///< in keys
        std::vector<uint32_t> plain, kept;
        std::string problem;
    };
    LinkedShaders& linked(const std::shared_ptr<const SurfaceProgram>& program);
    void describeScene(PipelineRecipe& recipe, uint32_t features, bool keepsLight) const;

    enum class Kind : uint8_t {
        Scene,
        Programmed,
        FalseColor,
        Wireframe,
        Background,
        KeptShadow,
        Shapes,
        Lines
    };
    using Key = std::tuple<Kind, uint32_t, uint32_t, uint32_t>; ///< the last one: of a program
    template <class Make>
    vk::Pipeline cached(const Key& key, Make&& make);

    const Gpu::Impl& gpu_;
    vk::raii::DescriptorSetLayout frameSet_, materialSet_, falseColorSet_, keptSet_, programSet_;
    vk::raii::PipelineLayout sceneLayout_, programLayout_, falseColorLayout_, overlayLayout_, keptLayout_;
    vk::raii::PipelineCache cache_;
    std::map<Key, vk::raii::Pipeline> pipelines_;
    std::map<std::shared_ptr<const SurfaceProgram>, LinkedShaders> programs_;
    uint32_t programNumbers_ = 0;
};

} // namespace touchstone
