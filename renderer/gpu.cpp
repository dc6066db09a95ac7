#include "renderer/gpu.h"

#include "engine/core/error.h"
#include "renderer/device_choice.h"
#include "renderer/gpu_impl.h"

#include <sched.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <exception>
#include <thread>

namespace touchstone {

namespace {

constexpr const char* kVulkan = "Vulkan";
constexpr const char* kValidationLayer = "VK_LAYER_KHRONOS_validation";
constexpr const char* kDriverRemedy =
    "install a driver for your graphics card, or the software one: apt install mesa-vulkan-drivers";

/// Mesa pins the thread that creates a screen to one cache's cores; this restores the caller's mask.
class AffinityGuard {
  public:
    AffinityGuard() { known_ = sched_getaffinity(0, sizeof mask_, &mask_) == 0; }
    ~AffinityGuard() {
        if (known_)
            sched_setaffinity(0, sizeof mask_, &mask_);
    }
    AffinityGuard(const AffinityGuard&) = delete;
    AffinityGuard& operator=(const AffinityGuard&) = delete;

  private:
    cpu_set_t mask_;
    bool known_ = false;
};

vk::DebugUtilsMessengerCreateInfoEXT messengerInfo(ValidationLog& log) {
    using Severity = vk::DebugUtilsMessageSeverityFlagBitsEXT;
    using Type = vk::DebugUtilsMessageTypeFlagBitsEXT;
    return {
        .messageSeverity = Severity::eWarning | Severity::eError,
        .messageType = Type::eValidation | Type::ePerformance,
        .pfnUserCallback = [](auto, auto, const auto* data, void* user) -> VkBool32 { // C's types, or C++'s
            static_cast<ValidationLog*>(user)->add(data->pMessage != nullptr ? data->pMessage : "(no text)");
            return VK_FALSE;
        },
        .pUserData = &log};
}

bool environmentAsks(const char* name) {
    const char* value = std::getenv(name);
    return value != nullptr && *value != '\0' && std::string_view(value) != "0";
}

bool layerPresent(const vk::raii::Context& context) {
    for (const vk::LayerProperties& layer : context.enumerateInstanceLayerProperties())
        if (std::string_view(layer.layerName) == kValidationLayer)
            return true;
    return false;
}

std::unique_ptr<Gpu::Impl> loadVulkan() {
    try {
        return std::make_unique<Gpu::Impl>();
    } catch (const std::exception& error) {
        throw Error(kVulkan, "", std::string("the Vulkan loader cannot be opened: ") + error.what(),
                    "apt install libvulkan1 mesa-vulkan-drivers");
    }
}

void createInstance(Gpu::Impl& gpu, const GpuOptions& options, const SurfaceRequest* surface) {
    if (gpu.context.enumerateInstanceVersion() < VK_API_VERSION_1_3)
        throw Error(kVulkan, "", "the Vulkan loader is older than 1.3",
                    "apt install libvulkan1 of Debian 12 or newer");
    std::vector<const char*> layers, extensions;
    if (surface != nullptr)
        for (const std::string& extension : surface->instanceExtensions)
            extensions.push_back(extension.c_str());
    if (options.validation || environmentAsks("TOUCHSTONE_VALIDATION")) {
        gpu.validation = layerPresent(gpu.context);
        if (gpu.validation) {
            layers.push_back(kValidationLayer);
            extensions.push_back(VK_EXT_DEBUG_UTILS_EXTENSION_NAME);
        } else {
            gpu.validationNote =
                "the Vulkan validation layer is not installed: apt install vulkan-validationlayers";
        }
    }
    const vk::ApplicationInfo application{.pApplicationName = "touchstone",
                                          .applicationVersion = 1,
                                          .pEngineName = "touchstone",
                                          .engineVersion = 1,
                                          .apiVersion = VK_API_VERSION_1_3};
    const vk::DebugUtilsMessengerCreateInfoEXT messenger = messengerInfo(*gpu.log);
    const vk::InstanceCreateInfo info{.pNext = gpu.validation ? &messenger : nullptr,
                                      .pApplicationInfo = &application,
                                      .enabledLayerCount = static_cast<uint32_t>(layers.size()),
                                      .ppEnabledLayerNames = layers.data(),
                                      .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                      .ppEnabledExtensionNames = extensions.data()};
    try {
        gpu.instance = vk::raii::Instance(gpu.context, info);
    } catch (const vk::IncompatibleDriverError&) {
        throw Error(kVulkan, "", "there is no Vulkan driver", kDriverRemedy);
    } catch (const vk::SystemError& error) {
        throw Error(kVulkan, "", std::string("no Vulkan instance can be made: ") + error.what(),
                    kDriverRemedy);
    }
    if (gpu.validation)
        gpu.messenger = vk::raii::DebugUtilsMessengerEXT(gpu.instance, messenger);
}

DeviceKind kindOf(vk::PhysicalDeviceType type) {
    switch (type) {
    case vk::PhysicalDeviceType::eDiscreteGpu:
        return DeviceKind::Discrete;
    case vk::PhysicalDeviceType::eIntegratedGpu:
        return DeviceKind::Integrated;
    case vk::PhysicalDeviceType::eVirtualGpu:
        return DeviceKind::Virtual;
    case vk::PhysicalDeviceType::eCpu:
        return DeviceKind::Software;
    case vk::PhysicalDeviceType::eOther:
        break;
    }
    return DeviceKind::Other;
}

/// A queue family for graphics, transfer and (with a surface) presentation; VK_QUEUE_FAMILY_IGNORED if there
/// is none.
uint32_t queueFamilyOf(const vk::raii::PhysicalDevice& device, const vk::raii::SurfaceKHR& surface) {
    const std::vector<vk::QueueFamilyProperties> families = device.getQueueFamilyProperties();
    for (uint32_t i = 0; i < families.size(); ++i) {
        if (!(families[i].queueFlags & vk::QueueFlagBits::eGraphics))
            continue;
        if (*surface && !device.getSurfaceSupportKHR(i, *surface))
            continue;
        return i;
    }
    return VK_QUEUE_FAMILY_IGNORED;
}

bool hasExtension(const vk::raii::PhysicalDevice& device, std::string_view name) {
    const std::vector<vk::ExtensionProperties> all = device.enumerateDeviceExtensionProperties();
    return std::any_of(all.begin(), all.end(), [&](const vk::ExtensionProperties& extension) {
        return std::string_view(extension.extensionName) == name;
    });
}

std::string whyUnfit(const vk::raii::PhysicalDevice& device, const vk::raii::SurfaceKHR& surface) {
    const vk::PhysicalDeviceProperties properties = device.getProperties();
    if (properties.apiVersion < VK_API_VERSION_1_3)
        return "Vulkan " + std::to_string(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
               std::to_string(VK_API_VERSION_MINOR(properties.apiVersion)) + " only, 1.3 is needed";
    const auto features =
        device.getFeatures2<vk::PhysicalDeviceFeatures2, vk::PhysicalDeviceVulkan13Features>()
            .get<vk::PhysicalDeviceVulkan13Features>();
    if (!features.dynamicRendering || !features.synchronization2)
        return "no dynamic rendering";
    if (queueFamilyOf(device, surface) == VK_QUEUE_FAMILY_IGNORED)
        return *surface ? "it cannot present to this window" : "no graphics queue";
    if (*surface && !hasExtension(device, VK_KHR_SWAPCHAIN_EXTENSION_NAME))
        return "no swapchain";
    const vk::FormatProperties depth = device.getFormatProperties(vk::Format::eD32Sfloat);
    if (!(depth.optimalTilingFeatures & vk::FormatFeatureFlagBits::eDepthStencilAttachment))
        return "no 32 bit float depth";
    return {};
}

std::vector<DeviceCandidate> candidatesOf(const vk::raii::PhysicalDevices& devices,
                                          const vk::raii::SurfaceKHR& surface) {
    std::vector<DeviceCandidate> candidates;
    for (const vk::raii::PhysicalDevice& device : devices) {
        const vk::PhysicalDeviceProperties properties = device.getProperties();
        candidates.push_back(
            {properties.deviceName, kindOf(properties.deviceType), whyUnfit(device, surface)});
    }
    return candidates;
}

/// An instance without any device throws here instead of returning an empty list.
vk::raii::PhysicalDevices physicalDevices(const vk::raii::Instance& instance) {
    try {
        return vk::raii::PhysicalDevices(instance);
    } catch (const vk::SystemError&) {
        throw Error(kVulkan, "", "no device was found", kDriverRemedy);
    }
}

/// What a software device draws with are threads of this process; on few cores those that compute what is
/// felt (edits of fields, contacts of bodies, deforming vertices) go before them.
constexpr int kDrawingNiceness = 3;

/// Calls `open` on a thread of lower priority, which those that the driver starts meanwhile inherit: this one
/// could not take its own priority back. Rethrows.
template <class Open>
void withThreadsBehind(const Open& open) {
    std::exception_ptr failure;
    std::thread opening([&] {
        const int now = ::getpriority(PRIO_PROCESS, 0);
        if (now < kDrawingNiceness) // if refused, drawing competes with the rest
            (void)::setpriority(PRIO_PROCESS, 0, kDrawingNiceness);
        try {
            open();
        } catch (...) {
            failure = std::current_exception();
        }
    });
    opening.join();
    if (failure)
        std::rethrow_exception(failure);
}

void createDevice(Gpu::Impl& gpu, const GpuOptions& options) {
    const vk::raii::PhysicalDevices devices = physicalDevices(gpu.instance);
    std::string wanted = options.device;
    if (const char* fromEnvironment = std::getenv("TOUCHSTONE_GPU");
        wanted.empty() && fromEnvironment != nullptr)
        wanted = fromEnvironment;
    gpu.physical = devices[chooseDevice(candidatesOf(devices, gpu.surface), wanted)];
    gpu.queueFamily = queueFamilyOf(gpu.physical, gpu.surface);

    const float priority = 1.0f;
    const vk::DeviceQueueCreateInfo queue{
        .queueFamilyIndex = gpu.queueFamily, .queueCount = 1, .pQueuePriorities = &priority};
    vk::PhysicalDeviceVulkan13Features features;
    features.dynamicRendering = true;
    features.synchronization2 = true;
    features.shaderTerminateInvocation = true; // for `discard`; every Vulkan 1.3 device has it
    gpu.dualSourceBlending = gpu.physical.getFeatures().dualSrcBlend;
    gpu.lineTriangles = gpu.physical.getFeatures().fillModeNonSolid;
    const vk::PhysicalDeviceFeatures core{.dualSrcBlend = gpu.dualSourceBlending,
                                          .fillModeNonSolid = gpu.lineTriangles};
    std::vector<const char*> extensions;
    if (*gpu.surface)
        extensions.push_back(VK_KHR_SWAPCHAIN_EXTENSION_NAME);
    const vk::DeviceCreateInfo info{.pNext = &features,
                                    .queueCreateInfoCount = 1,
                                    .pQueueCreateInfos = &queue,
                                    .enabledExtensionCount = static_cast<uint32_t>(extensions.size()),
                                    .ppEnabledExtensionNames = extensions.data(),
                                    .pEnabledFeatures = &core};
    gpu.software = gpu.physical.getProperties().deviceType == vk::PhysicalDeviceType::eCpu;
    const auto open = [&] { gpu.device = vk::raii::Device(gpu.physical, info); };
    try {
        if (gpu.software)
            withThreadsBehind(open);
        else
            open();
    } catch (const vk::SystemError& error) {
        throwVulkanError(error, "opening the device");
    }
    gpu.queue = gpu.device.getQueue(gpu.queueFamily, 0);
    gpu.commandPool = vk::raii::CommandPool(
        gpu.device, vk::CommandPoolCreateInfo{.flags = vk::CommandPoolCreateFlagBits::eResetCommandBuffer,
                                              .queueFamilyIndex = gpu.queueFamily});
}

void describe(Gpu::Impl& gpu) {
    const auto chain =
        gpu.physical.getProperties2<vk::PhysicalDeviceProperties2, vk::PhysicalDeviceDriverProperties>();
    const vk::PhysicalDeviceProperties& properties = chain.get<vk::PhysicalDeviceProperties2>().properties;
    const auto& driver = chain.get<vk::PhysicalDeviceDriverProperties>();
    gpu.memory = gpu.physical.getMemoryProperties();
    gpu.limits = properties.limits;
    gpu.timestampBits = gpu.physical.getQueueFamilyProperties()[gpu.queueFamily].timestampValidBits;
    gpu.name = properties.deviceName.data();
    const auto number = [](uint32_t n) { return std::to_string(n); };
    gpu.description = "Vulkan " + number(VK_API_VERSION_MAJOR(properties.apiVersion)) + "." +
                      number(VK_API_VERSION_MINOR(properties.apiVersion)) + "." +
                      number(VK_API_VERSION_PATCH(properties.apiVersion)) + ", driver " +
                      driver.driverName.data() + " " + driver.driverInfo.data();
}

/// lavapipe reads its thread count from the environment when the instance is created.
void limitSoftwareThreads(int threads) {
    if (threads < 0)
        threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()) - 1);
    ::setenv("LP_NUM_THREADS", std::to_string(threads).c_str(), 0);
}

} // namespace

void ValidationLog::add(std::string message) {
    const std::lock_guard lock(mutex_);
    messages_.push_back(std::move(message));
}

std::vector<std::string> ValidationLog::messages() const {
    const std::lock_guard lock(mutex_);
    return messages_;
}

void throwVulkanError(const vk::SystemError& error, const char* whileDoing) {
    const int code = error.code().value();
    const auto is = [code](vk::Result result) { return code == static_cast<int>(result); };
    if (is(vk::Result::eErrorDeviceLost) || is(vk::Result::eErrorSurfaceLostKHR))
        throw DeviceLost(kVulkan, whileDoing, error.what(),
                         "update the graphics driver, or draw on the CPU: TOUCHSTONE_GPU=llvmpipe");
    std::string remedy = "update the graphics driver, or choose another device with TOUCHSTONE_GPU";
    if (is(vk::Result::eErrorOutOfDeviceMemory) || is(vk::Result::eErrorOutOfHostMemory))
        remedy = "close other programs, or load a smaller model";
    throw Error(kVulkan, whileDoing, error.what(), remedy);
}

std::unique_ptr<Gpu> createGpu(const GpuOptions& options, const SurfaceRequest* surface) {
    const AffinityGuard affinity;
    limitSoftwareThreads(options.softwareThreads);
    std::unique_ptr<Gpu::Impl> gpu = loadVulkan();
    gpu->log = options.log ? options.log : std::make_shared<ValidationLog>();
    createInstance(*gpu, options, surface);
    if (surface != nullptr)
        gpu->surface = vk::raii::SurfaceKHR(gpu->instance, surface->create(*gpu->instance));
    createDevice(*gpu, options);
    describe(*gpu);
    return std::make_unique<Gpu>(std::move(gpu));
}

std::unique_ptr<Gpu> Gpu::headless(const GpuOptions& options) {
    return createGpu(options, nullptr);
}

Gpu::Gpu(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Gpu::~Gpu() {
    // Waiting for a lost device fails, and it no longer uses any resource.
    try {
        waitIdle();
    } catch (const std::exception&) {
    }
}

const std::string& Gpu::name() const {
    return impl_->name;
}
bool Gpu::isSoftware() const {
    return impl_->software;
}
const std::string& Gpu::description() const {
    return impl_->description;
}
bool Gpu::validationActive() const {
    return impl_->validation;
}
const std::string& Gpu::validationNote() const {
    return impl_->validationNote;
}
std::vector<std::string> Gpu::validationMessages() const {
    return impl_->log->messages();
}
void Gpu::waitIdle() const {
    translatingErrors("waiting for the device", [&] { impl_->device.waitIdle(); });
}

std::vector<std::string> Gpu::listDevices() {
    const AffinityGuard affinity;
    const std::unique_ptr<Impl> gpu = loadVulkan();
    gpu->log = std::make_shared<ValidationLog>();
    createInstance(*gpu, {}, nullptr);
    const std::vector<DeviceCandidate> candidates =
        candidatesOf(physicalDevices(gpu->instance), gpu->surface);
    std::vector<std::string> lines;
    for (size_t i = 0; i < candidates.size(); ++i)
        lines.push_back(describeCandidate(i, candidates[i]));
    return lines;
}

} // namespace touchstone
