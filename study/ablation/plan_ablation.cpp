// Selects the configurations of an ablation that a scene can distinguish (declared in ablation.h).

#include "engine/core/error.h"
#include "haptics/scene/haptic_scene.h"
#include "study/ablation/ablation.h"

#include <algorithm>
#include <map>

namespace touchstone::study {

namespace {

bool isOn(const HapticScene& scene, Effect effect) {
    return std::any_of(scene.plan.effects.begin(), scene.plan.effects.end(),
                       [&](const PlannedEffect& e) { return e.on && e.effect == effect; });
}

bool has(const HapticScene& scene, Need need) {
    switch (need) {
    case Need::SmoothNormals:
        return scene.plan.anyShading;
    case Need::Bump:
        return isOn(scene, Effect::NormalMap) || isOn(scene, Effect::HeightMap);
    case Need::HeightMap:
        return isOn(scene, Effect::HeightMap);
    case Need::Program:
        return scene.plan.programs;
    case Need::Nothing:
        break;
    }
    return true;
}

bool hasFactorMaps(const HapticScene& scene) {
    return std::any_of(scene.materials.begin(), scene.materials.end(), [](const HapticMaterialData& m) {
        return !m.friction.map.empty() || !m.stiffnessMap.map.empty() || !m.dampingMap.map.empty();
    });
}

const char* wordFor(Need need) {
    switch (need) {
    case Need::SmoothNormals:
        return "smooth normals";
    case Need::Bump:
        return "a normal or height map";
    case Need::HeightMap:
        return "a height map";
    case Need::Program:
        return "a haptic program";
    case Need::Nothing:
        break;
    }
    return "";
}

struct Choice {
    std::string name, settings;
    Need need = Need::Nothing;
};

std::vector<Choice> linesOf(std::string_view ablation) {
    std::vector<Choice> choices;
    for (const ConfigurationLine& line : configurationLines())
        if (line.ablation == ablation)
            choices.push_back({std::string(line.name), std::string(line.settings), line.need});
    return choices;
}

std::vector<Choice> choicesOf(std::string_view ablation) {
    std::vector<Choice> choices = linesOf(ablation);
    for (const Product& product : products()) {
        if (product.ablation != ablation)
            continue;
        choices.assign(1, {});
        for (const std::string_view axis : product.axes) {
            std::vector<Choice> longer;
            for (const Choice& choice : choices)
                for (const Choice& more : linesOf(axis))
                    longer.push_back({choice.name + (choice.name.empty() ? "" : ", ") +
                                          (more.name == "off" ? std::string(axis) + " off" : more.name),
                                      choice.settings + (choice.settings.empty() ? "" : " ") + more.settings,
                                      std::max(choice.need, more.need)});
            choices = std::move(longer);
        }
    }
    return choices;
}

PlannedConfiguration planned(const Ablation& ablation, const Choice& choice, const HapticScene& scene) {
    PlannedConfiguration configuration;
    configuration.ablation = &ablation;
    configuration.name = choice.name;
    configuration.text = std::string(ablation.base) + " " + choice.settings;
    applySettings(configuration.settings, configuration.text);
    applySettings(configuration.exact, ablation.base);
    applySettings(configuration.exact, ablation.exact);
    configuration.exact.proxyRadius = feltRadius(configuration.settings);
    HapticSettings untouched;
    applySettings(untouched, ablation.base);
    configuration.isDefault = inEffect(configuration.settings, scene) == inEffect(untouched, scene);
    return configuration;
}

} // namespace

void applySettings(HapticSettings& settings, std::string_view assignments) {
    while (!assignments.empty()) {
        const size_t end = std::min(assignments.find(' '), assignments.size());
        const std::string_view one = assignments.substr(0, end);
        assignments.remove_prefix(std::min(end + 1, assignments.size()));
        if (one.empty())
            continue;
        const size_t equals = one.find('=');
        if (equals == std::string_view::npos)
            throw Error("settings", std::string(one), "is not of the form NAME=VALUE", "");
        const std::string problem = setSetting(settings, one.substr(0, equals), one.substr(equals + 1));
        if (!problem.empty())
            throw Error("settings", std::string(one), problem, "");
    }
}

HapticSettings inEffect(HapticSettings settings, const HapticScene& scene) {
    const HapticSettings defaults;
    if (settings.contact != ContactMethod::Sweep)
        settings.proxyRadius = 0.0;
    if (settings.contact != ContactMethod::Rays)
        settings.precision = defaults.precision;
    if (!scene.plan.anyShading)
        settings.forceShading = ShadingMode::Off;
    else if (settings.forceShading == ShadingMode::Material && !scene.plan.oneFacetShading)
        settings.forceShading = ShadingMode::TwoPass; // both select two-pass shading
    if (settings.forceShading == ShadingMode::Off)
        settings.shadingTiltLimit = defaults.shadingTiltLimit;
    if (!has(scene, Need::Bump))
        settings.texture = TextureMode::Off;
    if (settings.texture == TextureMode::Off) {
        settings.textureTiltLimit = defaults.textureTiltLimit;
        settings.textureStrength = defaults.textureStrength;
    }
    if (settings.texture == TextureMode::Off || !has(scene, Need::HeightMap))
        settings.textureGradient = defaults.textureGradient;
    if (settings.texture == TextureMode::Off && !hasFactorMaps(scene))
        settings.textureFilter = defaults.textureFilter;
    if (!has(scene, Need::Program))
        settings.programs = defaults.programs;
    const bool rough = settings.staticFriction > 0.0 ||
                       (settings.staticFriction < 0.0 &&
                        (isOn(scene, Effect::Friction) || isOn(scene, Effect::ViscousFriction)));
    if (!rough)
        settings.friction = FrictionMode::Off;
    if (settings.friction != FrictionMode::VelocityThreshold) {
        settings.frictionThreshold = defaults.frictionThreshold;
        settings.frictionViscosity = defaults.frictionViscosity;
    }
    if (settings.friction != FrictionMode::Kim)
        settings.frictionDepth = defaults.frictionDepth;
    if (settings.contact != ContactMethod::VirtualPoint && settings.contact != ContactMethod::Potential)
        settings.forceThreshold = defaults.forceThreshold;
    return settings;
}

std::vector<PlannedConfiguration> planAblation(const Ablation& ablation, const HapticScene& scene,
                                               std::vector<std::string>& notes) {
    std::vector<PlannedConfiguration> configurations;
    const auto leaveOut = [&](const std::string& name, const std::string& why) {
        notes.push_back(std::string(ablation.name) + ", " + name + ": left out, " + why);
    };
    size_t same = 0;
    std::map<Need, std::pair<size_t, std::string>> missing; ///< number of configurations, and the first
    for (const Choice& choice : choicesOf(ablation.name)) {
        if (!has(scene, choice.need)) {
            auto& [count, first] = missing[choice.need];
            if (count++ == 0)
                first = choice.name;
            continue;
        }
        PlannedConfiguration configuration = planned(ablation, choice, scene);
        const auto alike = std::find_if(
            configurations.begin(), configurations.end(), [&](const PlannedConfiguration& other) {
                return inEffect(other.settings, scene) == inEffect(configuration.settings, scene);
            });
        if (alike == configurations.end())
            configurations.push_back(std::move(configuration));
        else
            ++same;
    }
    for (const auto& [need, rest] : missing)
        leaveOut(rest.second + (rest.first > 1 ? " and " + std::to_string(rest.first - 1) + " more" : ""),
                 std::string("nothing there has ") + wordFor(need));
    if (same > 0)
        leaveOut(std::to_string(same) + " configurations", "each feels the same as another one");
    if (configurations.size() == 1 && linesOf(ablation.name).size() > 1) {
        leaveOut("the whole ablation", "a single configuration has nothing to be compared with");
        configurations.clear();
    }
    return configurations;
}

} // namespace touchstone::study
