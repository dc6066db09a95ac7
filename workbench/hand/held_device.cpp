#include "workbench/hand/held_device.h"

#include <utility>

namespace touchstone {

bool HeldDevice::choose(std::string& choice) {
    hand_.collect();
    if (choice == menu_.chosen())
        return false;
    hand_.hold(nullptr);
    coming_.reset(); // before another is opened: it may be the same one
    coming_ = menu_.choose(choice);
    choice = menu_.chosen();
    return true;
}

void HeldDevice::limitsHold() {
    if (coming_ != nullptr)
        hand_.hold(std::exchange(coming_, nullptr));
}

void HeldDevice::drop(std::string& choice) {
    coming_.reset();
    menu_.choose("");
    choice.clear();
}

DeviceLimits HeldDevice::limits() const {
    return coming_ != nullptr ? coming_->limits() : hand_.limits();
}

} // namespace touchstone
