#pragma once
// The Vulkan device. Create it before the servo thread starts and never on it: Mesa may change the affinity
// of the creating thread (the constructor restores it) and starts worker threads.

#include "engine/core/error.h"

#include <memory>
#include <mutex>
#include <string>
#include <vector>

namespace touchstone {

/// Warnings and errors of the validation layer; may outlive the Gpu, to receive the messages of its
/// destruction. Any thread.
class ValidationLog {
  public:
    void add(std::string message);
    [[nodiscard]] std::vector<std::string> messages() const;

  private:
    mutable std::mutex mutex_;
    std::vector<std::string> messages_;
};

/// The device, or the surface of its window, is lost: thrown from any use. Objects created with it may then
/// only be destroyed, before the Gpu; work may continue with another Gpu.
class DeviceLost : public Error {
  public:
    using Error::Error;
};

struct GpuOptions {
    /// Part of a device's name (case-insensitive) or its index as in `Gpu::listDevices`. Empty: the
    /// environment variable TOUCHSTONE_GPU, else the best one: discrete, integrated, virtual, software, in
    /// this order.
    std::string device;
    /// Enables the validation layer, as does TOUCHSTONE_VALIDATION=1 in the environment.
    bool validation = false;
    /// Receives validation messages in addition to `Gpu::validationMessages`. May be null.
    std::shared_ptr<ValidationLog> log;
    /// Threads of a software device (0: draw in the submitting queue's thread). Default: all cores but the
    /// servo's. The environment variable LP_NUM_THREADS overrides it.
    int softwareThreads = -1;
};

/// One Vulkan 1.3 device with one queue. Owner thread only (the main thread), except validationMessages.
/// Throws Error without a loader, a driver or a suitable device; the remedy names the package.
class Gpu {
  public:
    /// Independent of any window system.
    [[nodiscard]] static std::unique_ptr<Gpu> headless(const GpuOptions& options = {});
    ~Gpu();
    Gpu(const Gpu&) = delete;
    Gpu& operator=(const Gpu&) = delete;

    [[nodiscard]] const std::string& name() const;
    [[nodiscard]] bool isSoftware() const; ///< runs on the CPU: use low quality
    /// "Vulkan 1.3.230, driver llvmpipe Mesa 22.3.6 (LLVM 15.0.6)"
    [[nodiscard]] const std::string& description() const;

    /// Validation was requested and the layer is active.
    [[nodiscard]] bool validationActive() const;
    /// Empty, or why requested validation is not active, with the package to install.
    [[nodiscard]] const std::string& validationNote() const;
    /// Warnings and errors of the validation layer so far. Any thread.
    [[nodiscard]] std::vector<std::string> validationMessages() const;

    /// Waits until the device is idle.
    void waitIdle() const;

    /// Names of the Vulkan devices, with their kind and, for unusable ones, the reason.
    [[nodiscard]] static std::vector<std::string> listDevices();

    struct Impl;
    [[nodiscard]] Impl& impl() const { return *impl_; } ///< for renderer/ only
    explicit Gpu(std::unique_ptr<Impl> impl);

  private:
    std::unique_ptr<Impl> impl_;
};

} // namespace touchstone
