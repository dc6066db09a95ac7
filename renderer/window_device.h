#pragma once
// A window's device objects. Main thread only, private to renderer/.

#include "renderer/gpu_memory.h"
#include "renderer/swapchain.h"
#include "renderer/window_canvas.h"
#include "renderer/window_target.h"

#include <array>
#include <optional>

namespace touchstone {

struct FrameSlot;

/// Swapchain, frames in flight and the pipeline that draws scene images into the window.
class WindowDevice {
  public:
    static constexpr uint32_t kFramesInFlight = 2;

    WindowDevice(const Gpu::Impl& gpu, GLFWwindow* window);
    ~WindowDevice() { gpu_.settle(); }
    WindowDevice(const WindowDevice&) = delete;
    WindowDevice& operator=(const WindowDevice&) = delete;

    [[nodiscard]] const Gpu::Impl& gpu() const { return gpu_; }
    [[nodiscard]] vk::RenderPass renderPass() const { return swapchain_.renderPass(); }
    [[nodiscard]] vk::DescriptorPool descriptors() const { return *pool_; }
    [[nodiscard]] vk::Extent2D extent() const { return swapchain_.extent(); }

    /// Whether a frame may redraw only a part.
    void keepPanels(bool may) {
        outdated_ |= keepsPanels_ != may; // with or without a canvas
        keepsPanels_ = may;
    }
    /// Adapts the swapchain to the framebuffer size. False while the window has no area.
    bool followWindow(WindowTarget::Statistics& statistics);
    /// A frame may redraw only a part: there is a canvas, and it holds the rest.
    [[nodiscard]] bool canKeep() const { return drawsOnCanvas() && canvas_.painted(); }
    /// Draws the scene images (null: none) and ImGui's draw data, all or only within where.main, and
    /// presents. False where the window system took no frame.
    bool present(const SceneRenderer* scene, const EyePlaces& where, bool whole,
                 WindowTarget::Statistics& statistics);

    /// A set of our own pipeline for an image in layout ShaderReadOnlyOptimal; valid as long as this object.
    [[nodiscard]] vk::DescriptorSet makeSet(vk::ImageView image) const;
    /// While ImGui's draw data are recorded: draws the image over the viewport, clipped to `visible`.
    void drawImage(vk::DescriptorSet image, const vk::Viewport& viewport, const PixelRect& visible) const;

    bool captureWanted = false;
    [[nodiscard]] std::optional<PixelData> takeCapture();

  private:
    /// Resources of a frame in flight.
    struct Frame {
        vk::raii::CommandBuffer commands{nullptr};
        vk::raii::Fence done{nullptr};
        vk::raii::Semaphore acquired{nullptr};
        vk::raii::QueryPool timestamps{nullptr};
        bool timed = false;
        std::array<vk::DescriptorSet, 2> sceneSets; ///< of each Eye
    };

    void createScenePipeline();
    void createFrames();
    [[nodiscard]] bool drawsOnCanvas() const { return keepsPanels_ && swapchain_.fillable(); }
    [[nodiscard]] vk::Extent2D framebufferSize() const;
    [[nodiscard]] std::optional<uint32_t> acquire(const Frame& frame);
    void waitFor(const Frame& frame, WindowTarget::Statistics& statistics);
    void record(Frame& frame, uint32_t image, const SceneRenderer* scene, const EyePlaces& where, bool whole);
    void begin(const Frame& frame, uint32_t image, const EyePlaces& where, bool whole);
    [[nodiscard]] vk::DescriptorSet newSet() const;
    void point(vk::DescriptorSet set, vk::ImageView image) const;
    void drawScene(vk::DescriptorSet set, const FrameSlot& scene, const PixelRect& where) const;
    void recordCapture(const Frame& frame, uint32_t image);
    void submit(const Frame& frame, uint32_t image);

    const Gpu::Impl& gpu_;
    GLFWwindow* window_;
    Swapchain swapchain_;
    WindowCanvas canvas_;
    vk::raii::Sampler sampler_{nullptr};
    vk::raii::DescriptorSetLayout sceneSetLayout_{nullptr};
    vk::raii::PipelineLayout sceneLayout_{nullptr};
    vk::raii::Pipeline scenePipeline_{nullptr};
    vk::raii::DescriptorPool pool_{nullptr}; ///< our sets and ImGui's font
    std::array<Frame, kFramesInFlight> frames_;
    size_t nextFrame_ = 0;
    const vk::raii::CommandBuffer* recording_ = nullptr;
    vk::Extent2D lastSize_;
    bool outdated_ = true;
    bool keepsPanels_ = false;

    GpuBuffer captureBuffer_;
    vk::Extent2D captureExtent_;
    bool captured_ = false;
};

} // namespace touchstone
