#pragma once
// What draws the window.

#include "renderer/device_losses.h"
#include "renderer/gpu.h"
#include "renderer/scene_renderer.h"
#include "renderer/window_target.h"
#include "workbench/screen/window.h"

#include <memory>

namespace touchstone {

/// The device with the window's target and the model's renderer on it. A device may be lost (DeviceLost, from
/// whatever uses it): then another is taken, and what was drawn on the lost one must be taken in again. Main
/// thread; what touches does not notice.
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

    /// After `lost`, at `now`, s: with an empty renderer. Throws Error where no device can be had, or the
    /// third one within ten seconds was lost.
    void renew(const DeviceLost& lost, double now);
    /// Of all devices so far.
    [[nodiscard]] size_t validationMessages() const { return options_.log->messages().size(); }
    /// s of the device's time that the last finished frame took; 0 where it cannot measure that.
    [[nodiscard]] double busy() const;

  private:
    void drop();

    Window& window_;
    GpuOptions options_;
    DeviceLosses losses_;
    std::unique_ptr<Gpu> gpu_;
    WindowTarget target_;
    std::unique_ptr<SceneRenderer> renderer_;
};

} // namespace touchstone
