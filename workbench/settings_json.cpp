#include "workbench/settings_json.h"

namespace touchstone {

nlohmann::ordered_json settingsJson(const HapticSettings& settings) {
    nlohmann::ordered_json json;
    for (const SettingInfo& info : settingInfos())
        json[std::string(info.name)] = settingValue(settings, info.name);
    return json;
}

} // namespace touchstone
