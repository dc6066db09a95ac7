#pragma once
// Descriptor layouts and pipelines, created at first use and cached. Main thread only, private to renderer/.

#include "renderer/graphics_pipeline.h"
#include "renderer/scene_vertex.h"
#include "renderer/view.h"

#include <map>
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
    [[nodiscard]] vk::PipelineLayout sceneLayout() const { return *sceneLayout_; }
    [[nodiscard]] vk::PipelineLayout falseColorLayout() const { return *falseColorLayout_; }
    [[nodiscard]] vk::PipelineLayout overlayLayout() const { return *overlayLayout_; }
    [[nodiscard]] vk::PipelineLayout keptLayout() const { return *keptLayout_; }

    /// `features`: kHas... bits of shaders/shared/scene_types.h. Cull mode and front face are dynamic.
    /// `keepsLight`: into the attachments of a kept picture; not for blended features.
    [[nodiscard]] vk::Pipeline scene(uint32_t features, bool keepsLight = false);
    [[nodiscard]] vk::Pipeline falseColor(uint32_t features, ViewMode mode);
    /// `clipped`: kIsClipped. Only where the device draws triangles as lines.
    [[nodiscard]] vk::Pipeline wireframe(bool clipped);
    [[nodiscard]] vk::Pipeline background(bool keepsLight = false);
    [[nodiscard]] vk::Pipeline keptShadow();
    [[nodiscard]] vk::Pipeline shapes(OverlayPass pass);
    [[nodiscard]] vk::Pipeline lines(OverlayPass pass);

    [[nodiscard]] size_t compiled() const { return pipelines_.size(); }

  private:
    enum class Kind : uint8_t { Scene, FalseColor, Wireframe, Background, KeptShadow, Shapes, Lines };
    using Key = std::tuple<Kind, uint32_t, uint32_t>;
    template <class Make>
    vk::Pipeline cached(const Key& key, Make&& make);

    const Gpu::Impl& gpu_;
    vk::raii::DescriptorSetLayout frameSet_, materialSet_, falseColorSet_, keptSet_;
    vk::raii::PipelineLayout sceneLayout_, falseColorLayout_, overlayLayout_, keptLayout_;
    vk::raii::PipelineCache cache_;
    std::map<Key, vk::raii::Pipeline> pipelines_;
};

} // namespace touchstone
