#pragma once
// Swapchain with its classic render pass, which Dear ImGui 1.86 demands. Main thread only, private to
// renderer/.

#include "renderer/gpu_impl.h"

#include <vector>

namespace touchstone {

class Swapchain {
  public:
    explicit Swapchain(const Gpu::Impl& gpu);

    /// Made once: the format does not change with the size.
    [[nodiscard]] vk::RenderPass renderPass() const { return *renderPass_; }
    [[nodiscard]] vk::Extent2D extent() const { return extent_; }
    [[nodiscard]] bool usable() const { return *swapchain_ != vk::SwapchainKHR{}; }
    [[nodiscard]] bool copyable() const { return copyable_; } ///< images may be read back
    [[nodiscard]] uint32_t imageCount() const { return static_cast<uint32_t>(images_.size()); }
    [[nodiscard]] uint32_t minImageCount() const { return minImageCount_; }
    [[nodiscard]] vk::SwapchainKHR handle() const { return *swapchain_; }
    [[nodiscard]] vk::Image image(uint32_t index) const { return images_[index]; }
    [[nodiscard]] vk::Framebuffer framebuffer(uint32_t index) const { return *framebuffers_[index]; }
    [[nodiscard]] bool blueFirst() const { return format_.format == vk::Format::eB8G8R8A8Unorm; }
    /// Waited for before presenting this image; one for each image, as presentation may hold it that long.
    [[nodiscard]] vk::Semaphore drawn(uint32_t index) const { return *drawn_[index]; }

    /// Makes it anew in this size; false while the surface has no area. The device must be idle.
    bool recreate(vk::Extent2D wanted);
    void destroy();

  private:
    void chooseFormat();
    void makeRenderPass();

    const Gpu::Impl& gpu_;
    vk::SurfaceFormatKHR format_;
    vk::raii::RenderPass renderPass_{nullptr};
    vk::raii::SwapchainKHR swapchain_{nullptr};
    std::vector<vk::Image> images_;
    std::vector<vk::raii::ImageView> views_;
    std::vector<vk::raii::Framebuffer> framebuffers_;
    std::vector<vk::raii::Semaphore> drawn_;
    vk::Extent2D extent_;
    uint32_t minImageCount_ = 2;
    bool copyable_ = false;
};

} // namespace touchstone
