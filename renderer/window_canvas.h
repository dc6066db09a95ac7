#pragma once
// The window's picture between frames. Main thread only, private to renderer/.

#include "renderer/gpu_memory.h"

namespace touchstone {

/// Caches the panels, which change rarely but are expensive on a software device: a frame redraws a part of
/// the image, and the whole is copied to the swapchain, at a tenth of the cost of drawing it.
class WindowCanvas {
  public:
    WindowCanvas(const Gpu::Impl& gpu, vk::Format format);

    /// Sets the size and discards the content. The device must be idle.
    void resize(vk::Extent2D extent);
    [[nodiscard]] bool painted() const { return painted_; }

    /// Begins a render pass that clears the image, or one that keeps it and draws within `area`; commands end
    /// the pass. The image is then in the layout of a copy source.
    void begin(const vk::raii::CommandBuffer& commands, const vk::ClearValue& clear);
    void beginWithin(const vk::raii::CommandBuffer& commands, const vk::Rect2D& area) const;

    /// Copies to an image of the swapchain, whose content is overwritten, and makes it ready to be presented.
    void copyTo(const vk::raii::CommandBuffer& commands, vk::Image target) const;

  private:
    const Gpu::Impl& gpu_;
    vk::Format format_;
    vk::raii::RenderPass clearing_, keeping_;
    GpuImage image_;
    vk::raii::Framebuffer framebuffer_{nullptr};
    bool painted_ = false;
};

} // namespace touchstone
