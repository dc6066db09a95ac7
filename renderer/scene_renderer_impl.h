#pragma once
// Implementation of SceneRenderer; for renderer/ only.

#include "renderer/frame_slot.h"
#include "renderer/gpu_scene.h"
#include "renderer/overlay_geometry.h"
#include "renderer/pipelines.h"
#include "renderer/scene_renderer.h"
#include "shaders/shared/scene_types.h"

#include <array>
#include <memory>
#include <vector>

namespace touchstone {

/// One instance in one frame.
struct DrawItem {
    int instance = 0;
    uint32_t firstIndex = 0, indexCount = 0; ///< of triangles; otherwise the mesh's lines or points are drawn
    uint32_t features = 0;
    /// Of transmissive items: side to draw. All: as in the material.
    enum class Sides : uint8_t { All, Far, Near } sides = Sides::All;
    double distance = 0.0;
    bool mirrored = false;
    shared::ObjectConstants constants;
};

struct SceneRenderer::Impl {
    explicit Impl(Gpu& owner);
    ~Impl();

    /// The image of an eye's last frame, for the window; valid until its next render.
    [[nodiscard]] const FrameSlot* lastFrame(Eye eye) const { return rings_[static_cast<size_t>(eye)].last; }

    void clear();
    void beginScene(std::shared_ptr<const PreparedScene> prepared);
    [[nodiscard]] bool continueScene(double seconds);
    void abandon() { coming_.reset(); }
    void compileLater() { cold_.clear(); } ///< of the new scene: when it is first drawn
    void render(const View& view, const Overlay& overlay, int width, int height, Eye eye);
    void setMaterialColors(std::vector<glm::vec3> colors);
    void setEnvironment(std::shared_ptr<const Environment> environment);
    [[nodiscard]] PixelData readPixels();
    /// The last frame of the main eye was no frame of a window: its time does not count.
    void forgetTime() {
        for (FrameSlot& slot : rings_[static_cast<size_t>(Eye::Main)].slots)
            slot.timed = slot.timed && &slot != lastFrame(Eye::Main);
    }
    [[nodiscard]] FalseColorScale falseColorScale() const {
        return scene_ && scene_->scale() != nullptr ? *scene_->scale() : FalseColorScale{};
    }

    Gpu::Impl& gpu;
    std::vector<glm::dmat4> poses;
    SceneRenderer::Statistics statistics;

    [[nodiscard]] const Scene* scene() const { return scene_ ? &scene_->scene() : nullptr; }

  private:
    void warmUp(int instance);
    void collectDraws(const View& view, const glm::dvec3& eye, vk::Extent2D extent);
    void addBlended(DrawItem item, double distance, double halfDepth);
    void writeUniforms(FrameSlot& slot, const View& view, const glm::dvec3& eye, const Overlay& overlay,
                       vk::Extent2D extent);
    void writeOverlay(FrameSlot& slot, const OverlayDraw& draw);
    void record(FrameSlot& slot, const View& view, const Overlay& overlay, const OverlayDraw& draw);
    void drawScene(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet, ViewMode mode);
    void drawItem(const vk::raii::CommandBuffer& commands, const DrawItem& item, ViewMode mode);
    void drawBackground(const vk::raii::CommandBuffer& commands, vk::DescriptorSet frameSet);
    void drawOverlay(const vk::raii::CommandBuffer& commands, const FrameSlot& slot, const OverlayDraw& draw,
                     bool showHidden);

    Pipelines pipelines_;
    std::unique_ptr<GpuScene> scene_, coming_;
    GpuEnvironment environment_;
    GpuBuffer shapeVertices_, shapeIndices_;
    ShapeMeshes shapes_;
    std::array<FrameRing, 2> rings_; ///< of each Eye
    FrameSlot warm_;                 ///< for frames that compile pipelines and are not shown
    std::vector<int> cold_;          ///< instances of `coming_` whose pipelines have not been used yet
    std::vector<glm::vec3> materialColors_;
    std::vector<DrawItem> draws_; ///< a member, to reuse its memory between frames
};

} // namespace touchstone
