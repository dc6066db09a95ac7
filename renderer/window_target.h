#pragma once
// A GLFW window as the place where frames end up: swapchain, Dear ImGui, present. The only part of the
// renderer that knows a window system; headless code does not include it.

#include "engine/scene/image.h"
#include "renderer/gpu.h"
#include "renderer/scene_renderer.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <optional>

struct GLFWwindow;

namespace touchstone {

/// A device that can present to this window (made with GLFW_CLIENT_API = GLFW_NO_API). Throws Error.
[[nodiscard]] std::unique_ptr<Gpu> createGpuForWindow(GLFWwindow* window, const GpuOptions& options = {});

/// Part of the window in framebuffer pixels, from the upper left corner.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Where the pictures of each Eye go; without area it is not shown. The magnifier lies over the main one.
struct EyePlaces {
    PixelRect main, magnifier;
};

/// Owns the swapchain and the Dear ImGui context with its GLFW and Vulkan backends. Install own GLFW
/// callbacks before construction: ImGui's backend chains to them. Main thread only. The window outlives it.
class WindowTarget {
  public:
    /// `setUp` is called once with the ImGui context current and before the font is uploaded: fonts, style.
    /// May be empty.
    WindowTarget(Gpu& gpu, GLFWwindow* window, const std::function<void()>& setUp = {});
    ~WindowTarget();
    WindowTarget(const WindowTarget&) = delete;
    WindowTarget& operator=(const WindowTarget&) = delete;

    /// The device is about to end, or is lost: destroys what the window has on it and gives up a frame that
    /// was begun. Until takeDevice nothing below may be called but statistics; Dear ImGui's state stays.
    void leaveDevice();
    /// Goes on with another device of the same window. Throws Error.
    void takeDevice(Gpu& gpu);

    /// Whether what lies outside the picture may be drawn less often than it; where the CPU draws it may, at
    /// first: once in `period` seconds, ten times a second when nothing else is said. Before a beginFrame.
    static constexpr double kPanelPeriod = 0.1;
    void keepPanels(bool may, double period = kPanelPeriod);

    /// Framebuffer size in pixels at the last beginFrame.
    [[nodiscard]] glm::ivec2 size() const;

    /// Starts an ImGui frame. False when the window is minimised or has no area: draw nothing and wait for
    /// events. The swapchain follows the framebuffer size, which is compared every frame (Xvfb does not
    /// report resizes).
    [[nodiscard]] bool beginFrame();

    /// Ends the ImGui frame, draws the last images of `scene` (may be null) bilinearly into their places, the
    /// ImGui windows over them, and presents. After every beginFrame that returned true. Where panels are
    /// kept, what lies outside where.main is drawn once in their period only, except while the user is at it,
    /// by pointer or key, and shortly after.
    void endFrame(SceneRenderer* scene, const EyePlaces& where);

    /// Small pictures that ImGui's windows may show, in `kPictures` places: RGBA8, sRGB, opaque. A place
    /// keeps what was set last, on another device too. Throws std::invalid_argument for another size.
    static constexpr size_t kPictures = 32;
    static constexpr int kPictureWidth = 208, kPictureHeight = 130;
    void setPicture(size_t place, const PixelData& pixels);
    /// Between beginFrame and endFrame, over what is in the current ImGui window so far, corners in its
    /// coordinates. Shows nothing where nothing was set.
    void showPicture(size_t place, const glm::vec2& from, const glm::vec2& to);

    /// The next endFrame keeps a copy of what it presents.
    void requestCapture();
    /// The copy: RGBA8, sRGB; empty until a requested frame was presented. Waits for that frame.
    [[nodiscard]] std::optional<PixelData> takeCapture();

    struct Statistics {
        uint64_t framesPresented = 0;
        uint64_t wholeFrames = 0; ///< of these, with all that is outside the picture
        uint64_t swapchainsMade = 0;
        double gpuSeconds = 0.0;  ///< of the last finished frame as the device measured it; 0: it cannot
        double waitSeconds = 0.0; ///< that the last frame waited for the device and the window system
    };
    [[nodiscard]] const Statistics& statistics() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace touchstone
