#include "workbench/commands/run_hands.h"

#include "session/device_port.h"
#include "workbench/commands/device_test.h"
#include "workbench/figures/settings_json.h"
#include "workbench/hand/device_menu.h"

#include <nlohmann/json.hpp>

namespace touchstone {

RunHands::RunHands(const RunOptions& options) : options_(options) {
    for (const std::string& choice : options.devices)
        hands_.emplace_back().device = openDeviceOrHand(choice);
}

std::vector<DevicePort> RunHands::connect(const Model& model) {
    std::shared_ptr<const StrokePath> stroke;
    size_t simulated = 0;
    for (const Hand& hand : hands_)
        simulated += hand.device == nullptr ? 1 : 0;
    if (simulated > 0)
        stroke = std::make_shared<StrokePath>(
            layStroke(*sceneOf(model.scene, model.part), model.workspaceFromScene, options_.stroke));
    std::vector<DevicePort> ports;
    size_t before = 0; // simulated hands
    for (Hand& hand : hands_) {
        Device* device = hand.device.get();
        glm::dvec3 place(0.0);
        if (device == nullptr) {
            hand.wait = stroke->period() * static_cast<double>(before++) / static_cast<double>(simulated);
            hand.path = std::make_unique<SimulatedHand>(stroke, hand.wait);
            hand.yielding = std::make_unique<HandImpedance>(*hand.path, options_.plant);
            device = options_.openLoop ? static_cast<Device*>(hand.path.get()) : hand.yielding.get();
            place = stroke->place();
        }
        hand.mapped = std::make_unique<MappedDevice>(*device, options_.zoom, place);
        ports.push_back(portOf(*hand.mapped));
    }
    return ports;
}

nlohmann::ordered_json RunHands::json(size_t hand) const {
    const Hand& own = hands_[hand];
    const bool real = own.device != nullptr;
    return {{"device", own.mapped->name()},
            {"link", real ? linkJson(own.device->report()) : nlohmann::ordered_json()},
            {"stroke", real ? nlohmann::ordered_json() : nlohmann::ordered_json(options_.stroke.name)},
            {"workspace_scale", options_.zoom},
            {"loop",
             options_.openLoop || real ? nlohmann::ordered_json("open") : plantJson(own.yielding->plant())}};
}

} // namespace touchstone
