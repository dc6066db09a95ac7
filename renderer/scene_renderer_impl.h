#pragma once
// What is behind SceneRenderer; for renderer/ only.

#include "renderer/gpu_scene.h"
#include "renderer/overlay_geometry.h"
#include "renderer/pipelines.h"
#include "renderer/scene_renderer.h"
#include "shaders/shared/scene_types.h"

#include <array>
#include <memory>
#include <vector>

namespace touchstone {

/// One of the frames in flight, with everything that the device may still be reading or writing.
struct FrameSlot {
    vk::raii::CommandBuffer commands{nullptr};
    vk::raii::Fence done{nullptr};
    vk::raii::QueryPool timestamps{nullptr};
    GpuBuffer uniforms, overlay;
    vk::raii::DescriptorPool pool{nullptr};
    vk::DescriptorSet frameSet;
    GpuImage color, depth;
    vk::raii::ImageView colorBytes{nullptr}; ///< the colour image without sRGB decoding
    bool timed = false;
};

/// One instance in one frame.
struct DrawItem {
    int instance = 0;
    uint32_t features = 0;
    double distance = 0.0;
    bool mirrored = false;
    shared::ObjectConstants constants;
};

struct SceneRenderer::Impl {
    explicit Impl(Gpu& owner);
    ~Impl();

    /// The image of the last frame, for the window; valid until the next render.
    [[nodiscard]] const FrameSlot* lastFrame() const { return last_; }

    void setScene(ScenePtr scene);
    void render(const View& view, const Overlay& overlay, int width, int height);
    [[nodiscard]] PixelData readPixels();

    Gpu::Impl& gpu;
    std::vector<glm::dmat4> poses;
    SceneRenderer::Statistics statistics;

    [[nodiscard]] const Scene* scene() const { return scene_ ? &scene_->scene() : nullptr; }

  private:
    void createSlot(FrameSlot& slot);
    void resize(FrameSlot& slot, vk::Extent2D extent);
    void waitFor(FrameSlot& slot);
    void collectDraws(const View& view, const glm::dvec3& eye);
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
    std::unique_ptr<GpuScene> scene_;
    GpuBuffer shapeVertices_, shapeIndices_;
    ShapeMeshes shapes_;
    std::array<FrameSlot, 2> slots_;
    size_t next_ = 0;
    FrameSlot* last_ = nullptr;
    std::vector<DrawItem> draws_; ///< kept between frames for its memory
};

} // namespace touchstone
