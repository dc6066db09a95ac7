#pragma once
// Swapchain with its classic render pass, which Dear ImGui 1.86 requires. Main thread only, private to
// renderer/.

#include "renderer/gpu_impl.h"

#include <vector>

namespace touchstone {

struct WindowPass {
    vk::Format format;
    vk::AttachmentLoadOp load;
    vk::ImageLayout before, after;
};
/// A pass that draws the window's contents. All of one format are compatible: pipelines for one work with the
/// others.
[[nodiscard]] vk::raii::RenderPass makeWindowPass(const Gpu::Impl& gpu, const WindowPass& pass);

class Swapchain {
  public:
    explicit Swapchain(const Gpu::Impl& gpu);

    /// Created once: the format does not change with the size.
    [[nodiscard]] vk::RenderPass renderPass() const { return *renderPass_; }
    [[nodiscard]] vk::Extent2D extent() const { return extent_; }
    [[nodiscard]] bool usable() const { return *swapchain_ != vk::SwapchainKHR{}; }
    [[nodiscard]] vk::Format format() const { return format_.format; }
    [[nodiscard]] bool copyable() const { return copyable_; } ///< images may be read back
    [[nodiscard]] bool fillable() const { return fillable_; } ///< images may be copied to
    [[nodiscard]] vk::SwapchainKHR handle() const { return *swapchain_; }
    [[nodiscard]] vk::Image image(uint32_t index) const { return images_[index]; }
    [[nodiscard]] vk::Framebuffer framebuffer(uint32_t index) const { return *framebuffers_[index]; }
    [[nodiscard]] bool blueFirst() const { return format_.format == vk::Format::eB8G8R8A8Unorm; }
    /// Waited for before presenting this image; one per image, as presentation may hold it that long.
    [[nodiscard]] vk::Semaphore drawn(uint32_t index) const { return *drawn_[index]; }

    /// Recreates it in this size; false while the surface has no area. The device must be idle.
    bool recreate(vk::Extent2D wanted);
    void destroy();

  private:
    void chooseFormat();

    const Gpu::Impl& gpu_;
    vk::SurfaceFormatKHR format_;
    vk::raii::RenderPass renderPass_{nullptr};
    vk::raii::SwapchainKHR swapchain_{nullptr};
    std::vector<vk::Image> images_;
    std::vector<vk::raii::ImageView> views_;
    std::vector<vk::raii::Framebuffer> framebuffers_;
    std::vector<vk::raii::Semaphore> drawn_;
    vk::Extent2D extent_;
    bool copyable_ = false, fillable_ = false;
};

} // namespace touchstone
