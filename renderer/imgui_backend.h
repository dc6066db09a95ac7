#pragma once
// Dear ImGui in our window. Main thread only, private to renderer/.

#include "renderer/gpu_impl.h"
#include "renderer/pointer_queue.h"
#include "renderer/window_target.h"

#include <functional>
#include <optional>

struct ImDrawData;

namespace touchstone {

/// Its context and GLFW backend live as long as this object, its Vulkan backend as long as a device.
class ImGuiBackend {
  public:
    /// `setUp`: called once with the context current: fonts, style. May be empty.
    ImGuiBackend(GLFWwindow* window, const std::function<void()>& setUp);
    ~ImGuiBackend();
    ImGuiBackend(const ImGuiBackend&) = delete;
    ImGuiBackend& operator=(const ImGuiBackend&) = delete;

    /// Uploads the font. `descriptors` and everything that draws with `pass` outlive leaveDevice.
    void takeDevice(const Gpu::Impl& gpu, vk::RenderPass pass, vk::DescriptorPool descriptors,
                    uint32_t framesInFlight);
    /// Destroys its device objects; the device must be idle or lost.
    void leaveDevice();

    void beginFrame();

  private:
    std::optional<PointerQueue> pointer_; ///< where ImGui has none of its own
};

/// True if the user interacts with an ImGui window, or did until now, in a way that must be visible at once;
/// any key press or release counts. `picture`: where the pointer belongs to the model, framebuffer pixels.
/// Between NewFrame and EndFrame.
[[nodiscard]] bool userIsAtPanels(const PixelRect& picture);

/// Clips the draw data to `area`, framebuffer pixels.
void keepWithin(ImDrawData& data, const PixelRect& area);

} // namespace touchstone
