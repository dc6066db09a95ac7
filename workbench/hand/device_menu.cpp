#include "workbench/hand/device_menu.h"

#include "engine/core/error.h"

#include <chrono>
#include <cstdio>
#include <thread>

namespace touchstone {

void DeviceMenu::renew(double now) {
    if (now - renewed_ < kRenewal)
        return;
    renewed_ = now;
    try {
        offers_ = deviceOffers(listHidNodes(), deviceFiles());
        std::erase_if(offers_, [](const DeviceOffer& offer) { return offer.doubtful; });
    } catch (const Error& error) { // an invalid device file
        offers_.clear();
        problem_ = error.what();
    }
}

std::shared_ptr<LinkedDevice> DeviceMenu::choose(const std::string& choice) {
    device_.reset();
    problem_.clear();
    chosen_ = choice;
    if (choice.empty())
        return nullptr;
    try {
        device_ = openDevice(choice);
        if (device_ == nullptr)
            problem_ = "no device is plugged in that may be used";
    } catch (const Error& error) {
        problem_ = error.what();
    }
    if (device_ == nullptr)
        chosen_.clear();
    return device_;
}

std::string DeviceMenu::status() const {
    if (device_ == nullptr)
        return problem_;
    const LinkReport report = device_->report();
    return report.state == LinkState::Connected ? device_->name() + " at " + report.where : report.problem;
}

std::unique_ptr<LinkedDevice> openDeviceOrHand(const std::string& choice) {
    if (choice == "hand")
        return nullptr;
    std::unique_ptr<LinkedDevice> device = openDevice(choice, "hand (the simulated one)");
    if (device == nullptr) {
        std::fprintf(stderr,
                     "touchstone: no device is plugged in that may be used: the simulated hand strokes\n");
        return nullptr;
    }
    constexpr auto kPatience = std::chrono::seconds(1);
    const auto start = std::chrono::steady_clock::now();
    const auto undecided = [](const LinkReport& report) {
        return report.state == LinkState::Searching && report.problem.empty();
    };
    while (undecided(device->report()) && std::chrono::steady_clock::now() - start < kPatience)
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    const LinkReport report = device->report();
    if (report.state == LinkState::Refused)
        throw Error("--device", choice, report.problem, "");
    if (report.state == LinkState::Searching)
        std::fprintf(stderr, "touchstone: %s\n", report.problem.c_str());
    return device;
}

} // namespace touchstone
