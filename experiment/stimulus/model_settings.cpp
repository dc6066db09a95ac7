#include "experiment/stimulus/model_settings.h"

#include "engine/core/error.h"

#include <array>
#include <cstdio>

namespace touchstone::experiment {

HapticSettings settingsOf(const Condition& condition, bool reference, double level) {
    HapticSettings settings;
    const auto set = [&](const std::string& name, const std::string& value) {
        if (const std::string problem = setSetting(settings, name, value); !problem.empty())
            throw Error("study", condition.name, problem, "see touchstone --help");
    };
    const auto& stimulus = std::get<ModelStimulus>(reference ? condition.reference : condition.comparison);
    for (const auto& [name, value] : stimulus.settings)
        set(name, value);
    if (!reference && condition.varied == Varied::Setting) {
        std::array<char, 40> text{};
        std::snprintf(text.data(), text.size(), "%.17g", condition.settingAt(level));
        set(condition.setting, text.data());
    }
    return settings;
}

} // namespace touchstone::experiment
