#include "renderer/window_target.h"

#include "engine/core/error.h"
#include "renderer/gui_pictures.h"
#include "renderer/imgui_backend.h"
#include "renderer/window_device.h"

#define GLFW_INCLUDE_NONE
#include <GLFW/glfw3.h>
#include <imgui.h>

#include <chrono>
#include <optional>
#include <stdexcept>

// GLFW declares this only when it includes Vulkan itself.
extern "C" VkResult glfwCreateWindowSurface(VkInstance instance, GLFWwindow* window,
                                            const VkAllocationCallbacks* allocator, VkSurfaceKHR* surface);

namespace touchstone {

namespace {

using Clock = std::chrono::steady_clock;

/// Number of frames with panels after user input: the effect of a key or click appears a frame later, and the
/// layout one frame after that.
constexpr int kWholeAfter = 3;

bool same(const PixelRect& a, const PixelRect& b) {
    return a.x == b.x && a.y == b.y && a.width == b.width && a.height == b.height;
}

} // namespace

std::unique_ptr<Gpu> createGpuForWindow(GLFWwindow* window, const GpuOptions& options) {
    uint32_t count = 0;
    const char** names = glfwGetRequiredInstanceExtensions(&count);
    if (names == nullptr)
        throw Error(
            "Vulkan", "window", "the window system offers no Vulkan surface",
            "apt install libvulkan1 mesa-vulkan-drivers, or run without a window: touchstone run --headless");
    SurfaceRequest request;
    request.instanceExtensions.assign(names, names + count);
    request.create = [window](VkInstance instance) {
        VkSurfaceKHR surface = VK_NULL_HANDLE;
        if (glfwCreateWindowSurface(instance, window, nullptr, &surface) != VK_SUCCESS)
            throw Error("Vulkan", "window", "no surface can be made for this window",
                        "run without a window: touchstone run --headless");
        return surface;
    };
    return createGpu(options, &request);
}

struct WindowTarget::Impl {
    Impl(GLFWwindow* target, const std::function<void()>& setUp) : window(target), gui(target, setUp) {}
    ~Impl() { leaveDevice(); }
    Impl(const Impl&) = delete;
    Impl& operator=(const Impl&) = delete;

    void takeDevice(Gpu& gpu);
    void leaveDevice();
    [[nodiscard]] WindowDevice& onDevice();
    [[nodiscard]] bool wholeWanted(const EyePlaces& where);

    GLFWwindow* window;
    ImGuiBackend gui;
    std::unique_ptr<WindowDevice> device; ///< destroyed before ImGui's part of the device
    GuiPictures pictures;
    EyePlaces lastPlaces;
    Clock::time_point lastWhole;
    /// A higher rate is not readable, and drawing panels takes a third of a frame on the CPU.
    std::chrono::duration<double> panelPeriod{WindowTarget::kPanelPeriod};
    int wholeLeft = 0; ///< frames, after input in the panels
    bool frameBegun = false;
    bool captureWanted = false;
    std::optional<bool> keepsPanels; ///< unset: depends on the device
    WindowTarget::Statistics statistics;
};

void WindowTarget::Impl::takeDevice(Gpu& gpu) {
    if (!*gpu.impl().surface)
        throw std::invalid_argument("this Gpu was not made for a window");
    device = std::make_unique<WindowDevice>(gpu.impl(), window);
    device->keepPanels(keepsPanels.value_or(gpu.impl().software));
    pictures.takeDevice(*device);
    gui.takeDevice(gpu.impl(), device->renderPass(), device->descriptors(), WindowDevice::kFramesInFlight);
}

void WindowTarget::Impl::leaveDevice() {
    if (frameBegun)
        ImGui::EndFrame();
    frameBegun = false;
    if (device == nullptr)
        return;
    device->gpu().settle();
    gui.leaveDevice();
    pictures.leaveDevice();
    device.reset();
}

WindowDevice& WindowTarget::Impl::onDevice() {
    if (device == nullptr)
        throw std::logic_error("the window has no device");
    return *device;
}

bool WindowTarget::Impl::wholeWanted(const EyePlaces& where) {
    if (userIsAtPanels(where.main))
        wholeLeft = kWholeAfter;
    return !device->canKeep() || !same(where.main, lastPlaces.main) || wholeLeft > 0 ||
           Clock::now() - lastWhole >= panelPeriod;
}

WindowTarget::WindowTarget(Gpu& gpu, GLFWwindow* window, const std::function<void()>& setUp)
    : impl_(std::make_unique<Impl>(window, setUp)) {
    takeDevice(gpu);
}

WindowTarget::~WindowTarget() = default;

void WindowTarget::takeDevice(Gpu& gpu) {
    translatingErrors("setting up the window", [&] {
        impl_->leaveDevice();
        impl_->takeDevice(gpu);
    });
}

void WindowTarget::leaveDevice() {
    impl_->leaveDevice();
}

void WindowTarget::keepPanels(bool may, double period) {
    impl_->keepsPanels = may;
    impl_->panelPeriod = std::chrono::duration<double>(period);
    impl_->onDevice().keepPanels(may);
}

glm::ivec2 WindowTarget::size() const {
    const vk::Extent2D size = impl_->onDevice().extent();
    return {static_cast<int>(size.width), static_cast<int>(size.height)};
}

bool WindowTarget::beginFrame() {
    return translatingErrors("following the window", [&] {
        if (!impl_->onDevice().followWindow(impl_->statistics))
            return false;
        impl_->gui.beginFrame();
        impl_->frameBegun = true;
        return true;
    });
}

void WindowTarget::endFrame(SceneRenderer* scene, const EyePlaces& where) {
    if (!impl_->frameBegun)
        return;
    const bool whole = impl_->wholeWanted(where);
    impl_->frameBegun = false;
    ImGui::Render();
    WindowDevice& device = impl_->onDevice();
    device.captureWanted = impl_->captureWanted; // outlives a device
    const bool presented = translatingErrors("presenting a frame", [&] {
        impl_->pictures.upload();
        return device.present(scene, where, whole, impl_->statistics);
    });
    impl_->pictures.forgetShown();
    impl_->captureWanted = device.captureWanted;
    if (!presented)
        return;
    if (whole)
        impl_->lastWhole = Clock::now();
    impl_->wholeLeft -= impl_->wholeLeft > 0;
    impl_->lastPlaces = where;
}

void WindowTarget::setPicture(size_t place, const PixelData& pixels) {
    impl_->pictures.set(place, pixels);
}

void WindowTarget::showPicture(size_t place, const glm::vec2& from, const glm::vec2& to) {
    impl_->pictures.show(place, from, to);
}

void WindowTarget::requestCapture() {
    impl_->captureWanted = true;
}

std::optional<PixelData> WindowTarget::takeCapture() {
    return translatingErrors("reading the window", [&] { return impl_->onDevice().takeCapture(); });
}

const WindowTarget::Statistics& WindowTarget::statistics() const {
    return impl_->statistics;
}

} // namespace touchstone
