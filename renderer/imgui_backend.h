#pragma once
// Dear ImGui in our window. Main thread only, private to renderer/.

#include "renderer/gpu_impl.h"
#include "renderer/window_target.h"

#include <functional>

struct ImDrawData;

namespace touchstone {

/// Its context and GLFW half live as long as this, its Vulkan half as long as a device.
class ImGuiBackend {
  public:
    /// `setUp`: once, with the context current: fonts, style. May be empty.
    ImGuiBackend(GLFWwindow* window, const std::function<void()>& setUp);
    ~ImGuiBackend();
    ImGuiBackend(const ImGuiBackend&) = delete;
    ImGuiBackend& operator=(const ImGuiBackend&) = delete;

    /// Uploads the font. `descriptors` and whatever draws with `pass` outlive leaveDevice.
    void takeDevice(const Gpu::Impl& gpu, vk::RenderPass pass, vk::DescriptorPool descriptors,
                    uint32_t framesInFlight);
    /// Destroys what it has on the device, which must be idle or lost.
    void leaveDevice();

    void beginFrame();
};

/// The user does something in a window of ImGui's, or did until now, that should be seen at once; any key
/// that goes down or up may be such. `picture`: where the pointer belongs to the model, framebuffer pixels.
/// Between NewFrame and EndFrame.
[[nodiscard]] bool userIsAtPanels(const PixelRect& picture);

/// Leaves of what is to be drawn only what lies in `area`, framebuffer pixels.
void keepWithin(ImDrawData& data, const PixelRect& area);

} // namespace touchstone
