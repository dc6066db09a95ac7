#pragma once
// A Scene in device memory. Main thread only, private to renderer/.

#include "engine/scene/scene.h"
#include "renderer/false_color.h"
#include "renderer/gpu_memory.h"
#include "renderer/gpu_programs.h"
#include "renderer/pipelines.h"
#include "renderer/prepared_scene.h"
#include "renderer/reshaped_mesh.h"

#include <array>
#include <deque>
#include <functional>
#include <map>
#include <optional>

namespace touchstone {

/// Uploads the data of the shaded view in steps of a few milliseconds, and those of a false-colour view on
/// request.
class GpuScene {
  public:
    GpuScene(const Gpu::Impl& gpu, const Pipelines& pipelines, std::shared_ptr<const PreparedScene> prepared);
    GpuScene(const GpuScene&) = delete;
    GpuScene& operator=(const GpuScene&) = delete;

    /// Executes the next step of the upload. True when complete; nothing of it may be drawn before.
    bool uploadNext();

    struct DrawnMesh {
        PreparedMesh mesh;
        uint32_t features = 0; ///< kHas... bits of mesh and material, without lights
    };

    [[nodiscard]] const Scene& scene() const { return *scene_; }
    [[nodiscard]] const DrawnMesh& mesh(int index) const { return meshes_[static_cast<size_t>(index)]; }
    /// Of a mesh whose vertices moved: about its centre, mesh frame.
    void setBounds(int index, double radius, const glm::dvec3& halfSize) {
        PreparedMesh& mesh = meshes_[static_cast<size_t>(index)].mesh;
        mesh.radius = radius;
        mesh.halfSize = halfSize;
    }
    [[nodiscard]] vk::DescriptorSet material(int index) const {
        return materialSets_[static_cast<size_t>(index)];
    }
    [[nodiscard]] const GpuPrograms& programs() const { return *programs_; }
    /// One for each material, in place of the file's. No frame may be in flight.
    void setPrograms(std::vector<MaterialProgram> programs);
    bool setTexels(const PersistentTexels& texels) { return programs_ && programs_->setTexels(texels); }
    /// Draws other triangles in place of a mesh's from the next frame on; its buffers are
    ///  those of kGenerations calls ago, which no frame in flight uses: at most one call a frame.
    void reshape(int index, const ReshapedMesh& reshaped);
    [[nodiscard]] bool isReshaped(int index) const { return reshaped_.contains(index); }
    /// Binds the buffers of a mesh that was reshaped; false where it was not.
    bool bindReshaped(const vk::raii::CommandBuffer& commands, int index, ViewMode mode) const;
    [[nodiscard]] vk::Buffer vertices() const { return *vertices_.buffer; }
    [[nodiscard]] vk::Buffer indices() const { return *indices_.buffer; }
    [[nodiscard]] uint64_t deviceBytes() const { return deviceBytes_; }

    /// Sets `falseColorMaterial` and `scalars` for `mode`. The device must be idle when the mode changes.
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
    /// Placeholders for missing textures.
    enum class Neutral : uint8_t { White, Grey, Black, FlatNormal };

    /// Frames in flight: two of each eye, two over the kept picture, its step; and one more.
    static constexpr size_t kGenerations = 8;
    struct Reshaped {
        struct Buffers {
            GpuBuffer vertices, indices, scalars;
        };
        std::array<Buffers, kGenerations> buffers;
        size_t current = 0;
    };

    void planMeshes();
    void planTexture(const TextureLevels& levels, GpuImage& image);
    void uploadNow(const TextureLevels& levels, GpuImage& image);
    void uploadMaterials();
    void uploadScalars(FalseColor& target);
    [[nodiscard]] vk::ImageView texture(const TextureRef& reference, TextureRole role, Neutral neutral);
    [[nodiscard]] vk::ImageView neutralTexture(Neutral neutral);
    [[nodiscard]] vk::Sampler sampler(const TextureRef& reference);

    const Gpu::Impl& gpu_;
    const Pipelines& pipelines_;
    ScenePtr scene_;
    std::shared_ptr<const PreparedScene> prepared_; ///< until it is uploaded
    Uploader uploader_;
    std::deque<std::function<void()>> steps_;
    GpuBuffer vertices_, indices_, materialUniforms_;
    std::vector<DrawnMesh> meshes_;
    std::map<int, Reshaped> reshaped_;
    std::map<std::pair<int, TextureRole>, GpuImage> textures_;
    std::map<Neutral, GpuImage> neutrals_;
    std::map<std::tuple<Wrap, Wrap, bool>, vk::raii::Sampler> samplers_;
    vk::raii::DescriptorPool pool_{nullptr};
    std::vector<vk::DescriptorSet> materialSets_;
    std::optional<GpuPrograms> programs_;
    std::optional<FalseColor> falseColor_;
    uint64_t deviceBytes_ = 0;
};

} // namespace touchstone
