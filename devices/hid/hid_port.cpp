#include "devices/hid/hid_port.h"

#include "devices/hid/hid_text.h"
#include "devices/hid/hidapi_lock.h"

#include <hidapi/hidapi.h>

namespace touchstone {

namespace {

std::set<std::string>& openNodes() { // under hidapiMutex
    static std::set<std::string> nodes;
    return nodes;
}

} // namespace

std::mutex& hidapiMutex() {
    static std::mutex mutex;
    return mutex;
}

std::string HidPort::open(const std::string& path) {
    close();
    const std::lock_guard lock(hidapiMutex());
    if (openNodes().contains(path))
        return path + " is already in use by this program";
    device_ = hid_open_path(path.c_str());
    if (device_ == nullptr)
        return utf8(hid_error(nullptr));
    path_ = path;
    openNodes().insert(path);
    return {};
}

void HidPort::close() noexcept {
    if (device_ == nullptr)
        return;
    const std::lock_guard lock(hidapiMutex());
    hid_close(device_);
    device_ = nullptr;
    openNodes().erase(path_);
}

int HidPort::read(std::span<uint8_t> report, int timeoutMs) noexcept {
    return hid_read_timeout(device_, report.data(), report.size(), timeoutMs);
}

bool HidPort::write(std::span<const uint8_t> report) noexcept {
    return hid_write(device_, report.data(), report.size()) == static_cast<int>(report.size());
}

std::set<std::string> HidPort::nodesInUse() {
    const std::lock_guard lock(hidapiMutex());
    return openNodes();
}

} // namespace touchstone
