#include "workbench/hand/other_hands.h"

#include "devices/choice/device_choice.h"
#include "engine/core/error.h"
#include "session/device_port.h"

namespace touchstone {

OtherHands::OtherHands(const std::vector<std::string>& choices, double zoom) {
    for (const std::string& choice : choices) {
        Hand& hand = *hands_.emplace_back(std::make_unique<Hand>());
        const bool simulated = choice == "hand";
        if (!simulated) {
            hand.device = openDevice(choice, "hand (the simulated one)");
            if (hand.device == nullptr)
                throw Error("--device", choice, "no device is plugged in that may be used", "");
        }
        hand.place.simulate(simulated);
        hand.place.hold(hand.device);
        hand.place.workspace({.zoom = zoom, .clutch = false});
        hand.place.lead(static_cast<double>(hands_.size()) / static_cast<double>(choices.size() + 1));
        states_.push_back({hand.place.name(), {}, {}});
    }
}

std::vector<DevicePort> OtherHands::ports() {
    std::vector<DevicePort> ports;
    for (const auto& hand : hands_)
        ports.push_back(portOf(hand->place));
    return ports;
}

void OtherHands::offerPath(const std::shared_ptr<const StrokePath>& path) {
    for (const auto& hand : hands_)
        hand->place.offerPath(path);
}

void OtherHands::leave() noexcept {
    for (const auto& hand : hands_)
        hand->place.leave();
}

void OtherHands::face(const glm::dquat& deviceFromView) {
    for (const auto& hand : hands_)
        hand->place.face(deviceFromView);
}

void OtherHands::collect() {
    for (const auto& hand : hands_)
        hand->place.collect();
}

void OtherHands::take(const TickRecord& record, const HapticSettings&) {
    if (record.hand > 0 && record.hand <= states_.size())
        states_[record.hand - 1].tick = record;
}

void OtherHands::flush(double) {
    for (size_t i = 0; i < hands_.size(); ++i) {
        if (hands_[i]->device == nullptr)
            continue;
        const LinkReport report = hands_[i]->device->report();
        states_[i].status = report.state == LinkState::Connected ? "at " + report.where : report.problem;
    }
}

} // namespace touchstone
