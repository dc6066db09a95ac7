#pragma once
// The window's picture between frames. Main thread only, private to renderer/.

#include "renderer/gpu_memory.h"

namespace touchstone {

/// What a software device would pay for in every frame although it rarely changes, the panels, stays in an
/// image of its own: a frame draws a part of it anew, and the whole is copied to the swapchain, which costs a
/// tenth of drawing it.
class WindowCanvas {
  public:
    WindowCanvas(const Gpu::Impl& gpu, vk::Format format);

    /// Another size, without content. The device must be idle.
    void resize(vk::Extent2D extent);
    [[nodiscard]] bool painted() const { return painted_; }

    /// Begins a render pass that clears it all, or one that draws over what it holds within `area`; commands
    /// end the pass. It is then laid out to be copied from.
    void begin(const vk::raii::CommandBuffer& commands, const vk::ClearValue& clear);
    void beginWithin(const vk::raii::CommandBuffer& commands, const vk::Rect2D& area) const;

    /// Onto an image of the swapchain whose content does not matter, which is then ready to be presented.
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
