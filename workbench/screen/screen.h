#pragma once
// The window's Vulkan device, target and renderer.

#include "renderer/device_losses.h"
#include "renderer/gpu.h"
#include "renderer/scene_renderer.h"
#include "renderer/window_target.h"
#include "workbench/screen/window.h"

#include <memory>

namespace touchstone {

/// The device with the window's target and the model's renderer. When a device is lost (DeviceLost, from any
/// use), another is created, and everything drawn must be uploaded again. Main thread; the servo is not
/// affected.
class Screen {
  public:
    Screen(Window& window, const GpuOptions& options);
    ~Screen();
    Screen(const Screen&) = delete;
    Screen& operator=(const Screen&) = delete;

    [[nodiscard]] Gpu& gpu() { return *gpu_; }
    [[nodiscard]] const Gpu& gpu() const { return *gpu_; }
    [[nodiscard]] WindowTarget& target() { return target_; }
    [[nodiscard]] const WindowTarget& target() const { return target_; }
    [[nodiscard]] SceneRenderer& renderer() { return *renderer_; }

    /// After `lost`, at `now`, s: with an empty renderer. Throws Error where no device is available, or on
    /// the third loss within ten seconds.
    void renew(const DeviceLost& lost, double now);
    /// Fonts and spacing for another `scale`, window coordinates per layout unit. Between frames; takes as
    /// long as a new swapchain. Nothing where it is as it was.
    void restyle(float scale);
    /// Over all devices so far.
    [[nodiscard]] size_t validationMessages() const { return options_.log->messages().size(); }
    /// s of device time of the last finished frame; 0 where it cannot be measured.
    [[nodiscard]] double busy() const;

  private:
    void drop();

    Window& window_;
    GpuOptions options_;
    float scale_;
    DeviceLosses losses_;
    std::unique_ptr<Gpu> gpu_;
    WindowTarget target_;
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace touchstone
