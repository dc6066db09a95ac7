#include "workbench/figures/settings_json.h"

#include <nlohmann/json.hpp>

namespace touchstone {

nlohmann::ordered_json settingsJson(const HapticSettings& settings) {
    nlohmann::ordered_json json;
    for (const auto& info : settingFields())
        json[std::string(info.name)] = settingValue(settings, info.name);
    return json;
}

nlohmann::ordered_json plantJson(const Plant& plant) {
    nlohmann::ordered_json json;
    for (const auto& info : plantFields())
        json[std::string(info.name)] = plantParameter(plant.parameters(), info.name);
    json["motor_work_j"] = plant.motorWork();
    json["coulomb_loss_j"] = plant.coulombLoss();
    return json;
}

} // namespace touchstone
