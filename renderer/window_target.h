#pragma once
// A GLFW window as the target of frames: swapchain, Dear ImGui, present. The only part of the renderer that
// depends on a window system; headless code does not include it.

#include "engine/scene/image.h"
#include "renderer/gpu.h"
#include "renderer/scene_renderer.h"

#include <glm/glm.hpp>

#include <functional>
#include <memory>
#include <optional>

struct GLFWwindow;

namespace touchstone {

/// A device that can present to this window (created with GLFW_CLIENT_API = GLFW_NO_API). Throws Error.
[[nodiscard]] std::unique_ptr<Gpu> createGpuForWindow(GLFWwindow* window, const GpuOptions& options = {});

/// Part of the window in framebuffer pixels, from the upper left corner.
struct PixelRect {
    int x = 0, y = 0, width = 0, height = 0;
};

/// Rectangles of the picture of each Eye; without area it is not shown. The magnifier lies over the main one.
struct EyePlaces {
    PixelRect main, magnifier;
};

/// Owns the swapchain and the Dear ImGui context with its GLFW and Vulkan backends. Install your own GLFW
/// callbacks before construction: ImGui's backend chains to them. Main thread only. The window outlives it.
class WindowTarget {
  public:
    /// `setUp` is called once with the ImGui context current and before the font is uploaded: fonts, style.
    /// May be empty.
    WindowTarget(Gpu& gpu, GLFWwindow* window, const std::function<void()>& setUp = {});
    ~WindowTarget();
    WindowTarget(const WindowTarget&) = delete;
    WindowTarget& operator=(const WindowTarget&) = delete;

    /// Before the device ends, or when it is lost: destroys the window's objects on it and cancels a frame in
    /// progress. Until takeDevice only statistics may be called; Dear ImGui's state stays.
    void leaveDevice();
    /// Continues with another device of the same window. Throws Error.
    void takeDevice(Gpu& gpu);

    /// Whether the panels may be redrawn less often than the picture, once per `period` seconds. Default: on
    /// a software device, ten times a second. Call before a beginFrame.
    static constexpr double kPanelPeriod = 0.1;
    void keepPanels(bool may, double period = kPanelPeriod);

    /// Framebuffer size in pixels at the last beginFrame.
    [[nodiscard]] glm::ivec2 size() const;

    /// Starts an ImGui frame. False when the window is minimised or has no area: draw nothing and wait for
    /// events. The swapchain follows the framebuffer size, which is compared every frame (Xvfb does not
    /// report resizes).
    [[nodiscard]] bool beginFrame();

    /// Ends the ImGui frame, draws the last images of `scene` (may be null) bilinearly into their rectangles,
    /// the ImGui windows over them, and presents. After every beginFrame that returned true. With kept
    /// panels, everything outside where.main is redrawn once per period only, except during and shortly after
    /// pointer or key input there.
    void endFrame(SceneRenderer* scene, const EyePlaces& where);

    /// Small pictures for ImGui's windows, in `kPictures` slots: RGBA8, sRGB, opaque. A slot keeps its last
    /// picture, on another device too. Throws std::invalid_argument for another size.
    static constexpr size_t kPictures = 64; ///< our scenes, and WindowMemory::kMaxRecent
    static constexpr int kPictureWidth = 208, kPictureHeight = 130;
    void setPicture(size_t place, const PixelData& pixels);
    /// Between beginFrame and endFrame, over the current content of the ImGui window, corners in its
    /// coordinates. Draws nothing for an empty slot.
    void showPicture(size_t place, const glm::vec2& from, const glm::vec2& to);

    /// The next endFrame copies what it presents.
    void requestCapture();
    /// The copy: RGBA8, sRGB; empty until a requested frame was presented. Waits for that frame.
    [[nodiscard]] std::optional<PixelData> takeCapture();

    struct Statistics {
        uint64_t framesPresented = 0;
        uint64_t wholeFrames = 0; ///< of these, with the panels redrawn
        uint64_t swapchainsMade = 0;
        double gpuSeconds = 0.0;  ///< device time of the last finished frame; 0: not measurable
        double waitSeconds = 0.0; ///< time that the last frame waited for the device and the window system
    };
    [[nodiscard]] const Statistics& statistics() const;

  private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

} // namespace touchstone
