// A Vulkan layer that loses the device, or the window's surface, when a test says so. Which call reports the
// loss stands in the file that TOUCHSTONE_LOSS_FILE names: "submit", "present", "acquire" or "wait" lose the
// device, "surface" the surface at the next acquire, "create" lets no device be made; a number behind it says
// at how many such calls from now. The file is removed when that has happened, and "again" behind the number
// keeps it for the next device. A device that is lost stays so: as with a real one nothing that is submitted
// to it is done, and all that waits for it returns at once.

#include <vulkan/vk_layer.h>
#include <vulkan/vulkan.h>

#include <cstdlib>
#include <cstring>
#include <fstream>
#include <map>
#include <mutex>
#include <string>

namespace {

/// Handles of one instance or device begin with the same pointer.
void* keyOf(const void* handle) {
    return *static_cast<void* const*>(handle);
}

struct DeviceTable {
    VkDevice device = VK_NULL_HANDLE;
    PFN_vkGetDeviceProcAddr next = nullptr;
    bool lost = false;

    template <class Function>
    [[nodiscard]] Function function(const char* name) const {
        return reinterpret_cast<Function>(next(device, name));
    }
};

struct InstanceTable {
    VkInstance instance = VK_NULL_HANDLE;
    PFN_vkGetInstanceProcAddr next = nullptr;
};

std::mutex mutex;
std::map<void*, DeviceTable> devices;
std::map<void*, InstanceTable> instances;
std::string counted; ///< the content of the file that `calls` belongs to
int calls = 0;

/// A call of this kind is the one at which the loss happens.
bool strikes(const std::string& kind) {
    const char* file = std::getenv("TOUCHSTONE_LOSS_FILE");
    if (file == nullptr)
        return false;
    std::string wanted, again;
    int at = 1;
    std::ifstream in(file);
    if (!(in >> wanted) || wanted != kind)
        return false;
    in >> at >> again;
    if (const std::string content = wanted + std::to_string(at) + again; content != counted) {
        counted = content;
        calls = 0;
    }
    if (++calls < at)
        return false;
    counted.clear();
    if (again != "again")
        std::remove(file);
    return true;
}

/// What there is to call, unless the device is or becomes lost.
template <class Function>
Function onDevice(const void* handle, const char* name, const char* kind) {
    const std::lock_guard lock(mutex);
    DeviceTable& table = devices.at(keyOf(handle));
    table.lost = table.lost || strikes(kind);
    return table.lost ? nullptr : table.function<Function>(name);
}

/// What has begun comes to its end, whether or not it is lost.
VkResult settle(const void* handle) {
    DeviceTable table;
    {
        const std::lock_guard lock(mutex);
        table = devices.at(keyOf(handle));
    }
    const VkResult result = table.function<PFN_vkDeviceWaitIdle>("vkDeviceWaitIdle")(table.device);
    return table.lost ? VK_ERROR_DEVICE_LOST : result;
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit(VkQueue queue, uint32_t count, const VkSubmitInfo* infos,
                                           VkFence fence) {
    const auto next = onDevice<PFN_vkQueueSubmit>(queue, "vkQueueSubmit", "submit");
    return next != nullptr ? next(queue, count, infos, fence) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL queueSubmit2(VkQueue queue, uint32_t count, const VkSubmitInfo2* infos,
                                            VkFence fence) {
    const auto next = onDevice<PFN_vkQueueSubmit2>(queue, "vkQueueSubmit2", "submit");
    return next != nullptr ? next(queue, count, infos, fence) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL queuePresent(VkQueue queue, const VkPresentInfoKHR* info) {
    const auto next = onDevice<PFN_vkQueuePresentKHR>(queue, "vkQueuePresentKHR", "present");
    return next != nullptr ? next(queue, info) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL acquireNextImage(VkDevice device, VkSwapchainKHR swapchain, uint64_t timeout,
                                                VkSemaphore semaphore, VkFence fence, uint32_t* image) {
    {
        const std::lock_guard lock(mutex);
        if (strikes("surface"))
            return VK_ERROR_SURFACE_LOST_KHR;
    }
    const auto next = onDevice<PFN_vkAcquireNextImageKHR>(device, "vkAcquireNextImageKHR", "acquire");
    return next != nullptr ? next(device, swapchain, timeout, semaphore, fence, image) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL waitForFences(VkDevice device, uint32_t count, const VkFence* fences,
                                             VkBool32 all, uint64_t timeout) {
    const auto next = onDevice<PFN_vkWaitForFences>(device, "vkWaitForFences", "wait");
    return next != nullptr ? next(device, count, fences, all, timeout) : VK_ERROR_DEVICE_LOST;
}

VKAPI_ATTR VkResult VKAPI_CALL deviceWaitIdle(VkDevice device) {
    return settle(device);
}

VKAPI_ATTR VkResult VKAPI_CALL queueWaitIdle(VkQueue queue) {
    return settle(queue);
}

/// The loader's word on who comes next, from the chain behind a create info.
template <class LayerInfo, class CreateInfo>
LayerInfo* linkOf(const CreateInfo* info, VkStructureType type) {
    auto* link = const_cast<LayerInfo*>(static_cast<const LayerInfo*>(info->pNext));
    while (link != nullptr && !(link->sType == type && link->function == VK_LAYER_LINK_INFO))
        link = const_cast<LayerInfo*>(static_cast<const LayerInfo*>(link->pNext));
    return link;
}

VKAPI_ATTR VkResult VKAPI_CALL createInstance(const VkInstanceCreateInfo* info,
                                              const VkAllocationCallbacks* allocator, VkInstance* instance) {
    auto* link = linkOf<VkLayerInstanceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_INSTANCE_CREATE_INFO);
    if (link == nullptr)
        return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr next = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    const VkResult result = reinterpret_cast<PFN_vkCreateInstance>(next(VK_NULL_HANDLE, "vkCreateInstance"))(
        info, allocator, instance);
    if (result == VK_SUCCESS) {
        const std::lock_guard lock(mutex);
        instances[keyOf(*instance)] = {*instance, next};
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyInstance(VkInstance instance, const VkAllocationCallbacks* allocator) {
    InstanceTable table;
    {
        const std::lock_guard lock(mutex);
        table = instances.at(keyOf(instance));
        instances.erase(keyOf(instance));
    }
    reinterpret_cast<PFN_vkDestroyInstance>(table.next(instance, "vkDestroyInstance"))(instance, allocator);
}

VKAPI_ATTR VkResult VKAPI_CALL createDevice(VkPhysicalDevice physical, const VkDeviceCreateInfo* info,
                                            const VkAllocationCallbacks* allocator, VkDevice* device) {
    auto* link = linkOf<VkLayerDeviceCreateInfo>(info, VK_STRUCTURE_TYPE_LOADER_DEVICE_CREATE_INFO);
    if (link == nullptr)
        return VK_ERROR_INITIALIZATION_FAILED;
    const PFN_vkGetInstanceProcAddr nextOfInstance = link->u.pLayerInfo->pfnNextGetInstanceProcAddr;
    const PFN_vkGetDeviceProcAddr next = link->u.pLayerInfo->pfnNextGetDeviceProcAddr;
    link->u.pLayerInfo = link->u.pLayerInfo->pNext;
    VkInstance instance = VK_NULL_HANDLE;
    {
        const std::lock_guard lock(mutex);
        if (strikes("create"))
            return VK_ERROR_DEVICE_LOST;
        instance = instances.at(keyOf(physical)).instance;
    }
    const VkResult result = reinterpret_cast<PFN_vkCreateDevice>(nextOfInstance(instance, "vkCreateDevice"))(
        physical, info, allocator, device);
    if (result == VK_SUCCESS) {
        const std::lock_guard lock(mutex);
        devices[keyOf(*device)] = {*device, next, false};
    }
    return result;
}

VKAPI_ATTR void VKAPI_CALL destroyDevice(VkDevice device, const VkAllocationCallbacks* allocator) {
    DeviceTable table;
    {
        const std::lock_guard lock(mutex);
        table = devices.at(keyOf(device));
        devices.erase(keyOf(device));
    }
    table.function<PFN_vkDestroyDevice>("vkDestroyDevice")(device, allocator);
}

PFN_vkVoidFunction own(const char* name);

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getDeviceProcAddr(VkDevice device, const char* name) {
    if (const PFN_vkVoidFunction mine = own(name))
        return mine;
    const std::lock_guard lock(mutex);
    return devices.at(keyOf(device)).next(device, name);
}

VKAPI_ATTR PFN_vkVoidFunction VKAPI_CALL getInstanceProcAddr(VkInstance instance, const char* name) {
    if (const PFN_vkVoidFunction mine = own(name))
        return mine;
    if (instance == VK_NULL_HANDLE)
        return nullptr;
    const std::lock_guard lock(mutex);
    return instances.at(keyOf(instance)).next(instance, name);
}

template <class Function>
PFN_vkVoidFunction plain(Function function) {
    return reinterpret_cast<PFN_vkVoidFunction>(function);
}

PFN_vkVoidFunction own(const char* name) {
    const std::map<std::string, PFN_vkVoidFunction> functions{
        {"vkGetInstanceProcAddr", plain(getInstanceProcAddr)},
        {"vkGetDeviceProcAddr", plain(getDeviceProcAddr)},
        {"vkCreateInstance", plain(createInstance)},
        {"vkDestroyInstance", plain(destroyInstance)},
        {"vkCreateDevice", plain(createDevice)},
        {"vkDestroyDevice", plain(destroyDevice)},
        {"vkQueueSubmit", plain(queueSubmit)},
        {"vkQueueSubmit2", plain(queueSubmit2)},
        {"vkQueuePresentKHR", plain(queuePresent)},
        {"vkAcquireNextImageKHR", plain(acquireNextImage)},
        {"vkWaitForFences", plain(waitForFences)},
        {"vkDeviceWaitIdle", plain(deviceWaitIdle)},
        {"vkQueueWaitIdle", plain(queueWaitIdle)},
    };
    const auto found = functions.find(name);
    return found != functions.end() ? found->second : nullptr;
}

} // namespace

extern "C" VK_LAYER_EXPORT VKAPI_ATTR VkResult VKAPI_CALL
vkNegotiateLoaderLayerInterfaceVersion(VkNegotiateLayerInterface* negotiated) {
    if (negotiated->loaderLayerInterfaceVersion < 2)
        return VK_ERROR_INITIALIZATION_FAILED;
    negotiated->loaderLayerInterfaceVersion = 2;
    negotiated->pfnGetInstanceProcAddr = getInstanceProcAddr;
    negotiated->pfnGetDeviceProcAddr = getDeviceProcAddr;
    negotiated->pfnGetPhysicalDeviceProcAddr = nullptr;
    return VK_SUCCESS;
}
