#pragma once
// A Scene in device memory. Main thread only, private to renderer/.

#include "engine/scene/scene.h"
#include "renderer/false_color.h"
#include "renderer/gpu_memory.h"
#include "renderer/pipelines.h"
#include "renderer/texture_levels.h"

#include <map>
#include <optional>

namespace touchstone {

/// Uploads everything that the shaded view needs on construction; what a false-colour view needs, when it is
/// asked for.
class GpuScene {
  public:
    GpuScene(const Gpu::Impl& gpu, const Pipelines& pipelines, ScenePtr scene);

    struct MeshRange {
        uint32_t firstIndex = 0, indexCount = 0;
        int32_t firstVertex = 0;
        glm::dvec3 centre{0.0}; ///< mesh frame; the uploaded positions are relative to it
        uint32_t features = 0;  ///< kHas... bits of mesh and material, without lights
    };

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const MeshRange& mesh(int index) const { return meshes_[static_cast<size_t>(index)]; }
    [[nodiscard]] vk::DescriptorSet material(int index) const {
        return materialSets_[static_cast<size_t>(index)];
    }
    [[nodiscard]] vk::Buffer vertices() const { return *vertices_.buffer; }
    [[nodiscard]] vk::Buffer indices() const { return *indices_.buffer; }
    [[nodiscard]] uint64_t deviceBytes() const { return deviceBytes_; }

    /// Makes `falseColorMaterial` and `scalars` those of `mode`. The device must be idle when the mode
    /// changes.
    void prepareFalseColor(ViewMode mode, const std::vector<glm::vec3>& materialColors);
    void forgetFalseColor() { falseColor_.reset(); }
    [[nodiscard]] const FalseColorScale* scale() const { return falseColor_ ? &falseColor_->scale : nullptr; }
    [[nodiscard]] bool falseColorReady(ViewMode mode) const {
        return falseColor_ && falseColor_->mode == mode;
    }
    [[nodiscard]] vk::DescriptorSet falseColorMaterial(int index) const {
        return falseColor_->sets[static_cast<size_t>(index)];
    }
    [[nodiscard]] vk::Buffer scalars() const { return *falseColor_->scalars.buffer; }

  private:
    struct FalseColor {
        ViewMode mode = ViewMode::Shaded;
        FalseColorScale scale;
        GpuBuffer scalars, uniforms;
        vk::raii::DescriptorPool pool{nullptr};
        std::vector<vk::DescriptorSet> sets;
    };
    /// Images that stand for what a material lacks.
    enum class Neutral : uint8_t { White, Grey, Black, FlatNormal };

    void uploadMeshes(Uploader& uploader);
    void uploadMaterials(Uploader& uploader);
    void uploadScalars(Uploader& uploader, FalseColor& target) const;
    [[nodiscard]] uint32_t materialFeatures(const Material& material) const;
    [[nodiscard]] vk::ImageView texture(Uploader& uploader, const TextureRef& reference, TextureRole role,
                                        Neutral neutral);
    [[nodiscard]] vk::ImageView neutralTexture(Uploader& uploader, Neutral neutral);
    [[nodiscard]] vk::Sampler sampler(const TextureRef& reference);
    void upload(Uploader& uploader, const TextureLevels& levels, GpuImage& image);

    const Gpu::Impl& gpu_;
    const Pipelines& pipelines_;
    ScenePtr scene_;
    GpuBuffer vertices_, indices_, materialUniforms_;
    std::vector<MeshRange> meshes_;
    std::map<std::pair<int, TextureRole>, GpuImage> textures_;
    std::map<Neutral, GpuImage> neutrals_;
    std::map<std::tuple<Wrap, Wrap, bool>, vk::raii::Sampler> samplers_;
    vk::raii::DescriptorPool pool_{nullptr};
    std::vector<vk::DescriptorSet> materialSets_;
    std::optional<FalseColor> falseColor_;
    uint64_t deviceBytes_ = 0;
};

} // namespace touchstone
