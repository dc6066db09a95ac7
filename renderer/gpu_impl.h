#pragma once
// Implementation of Gpu; for renderer/ only.

#include "renderer/gpu.h"
#include "renderer/vulkan.h"

#include <functional>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace touchstone {

struct Gpu::Impl {
    // Destroyed in reverse order: the device before the surface, the instance last.
    std::shared_ptr<ValidationLog> log;
    vk::raii::Context context;
    vk::raii::Instance instance{nullptr};
    vk::raii::DebugUtilsMessengerEXT messenger{nullptr};
    vk::raii::SurfaceKHR surface{nullptr}; ///< null when headless
    vk::raii::PhysicalDevice physical{nullptr};
    vk::raii::Device device{nullptr};
    vk::raii::Queue queue{nullptr};
    vk::raii::CommandPool commandPool{nullptr}; ///< command buffers can be reset individually

    uint32_t queueFamily = 0;
    vk::PhysicalDeviceMemoryProperties memory;
    vk::PhysicalDeviceLimits limits;
    uint32_t timestampBits = 0;
    bool software = false;
    bool lineTriangles = false;      ///< without it no wireframe is drawn
    bool dualSourceBlending = false; ///< without it coloured glass is blended in grey
    bool validation = false;
    std::string name, description, validationNote;

    /// Waits until the device is idle; a lost device is idle and cannot be waited for.
    void settle() const {
        try {
            device.waitIdle();
        } catch (const vk::SystemError&) {
        }
    }
};

/// For window_target.cpp: instance extensions of the window system and the surface to present to.
struct SurfaceRequest {
    std::vector<std::string> instanceExtensions;
    std::function<VkSurfaceKHR(VkInstance)> create;
};

/// Creates instance, surface (if requested) and device. Throws Error.
[[nodiscard]] std::unique_ptr<Gpu> createGpu(const GpuOptions& options, const SurfaceRequest* surface);

/// Converts exceptions of vulkan.hpp to Error: DeviceLost, out of memory.
[[noreturn]] void throwVulkanError(const vk::SystemError& error, const char* whileDoing);

template <class Work>
auto translatingErrors(const char* whileDoing, Work&& work) {
    try {
        return work();
    } catch (const vk::SystemError& error) {
        throwVulkanError(error, whileDoing);
    }
}

} // namespace touchstone
