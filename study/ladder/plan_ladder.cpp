// Which rungs of a ladder a scene can tell apart (declared in ladder.h).

#include "engine/core/error.h"
#include "haptics/scene/haptic_scene.h"
#include "study/ladder/ladder.h"

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
    case Need::Relief:
        return isOn(scene, Effect::NormalMap) || isOn(scene, Effect::HeightMap);
    case Need::HeightMap:
        return isOn(scene, Effect::HeightMap);
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
    case Need::Relief:
        return "a normal or height map";
    case Need::HeightMap:
        return "a height map";
    case Need::Nothing:
        break;
    }
    return "";
}

struct Choice {
    std::string name, settings;
    Need need = Need::Nothing;
};

std::vector<Choice> linesOf(std::string_view ladder) {
    std::vector<Choice> choices;
    for (const RungLine& line : rungLines())
        if (line.ladder == ladder)
            choices.push_back({std::string(line.name), std::string(line.settings), line.need});
    return choices;
}

std::vector<Choice> choicesOf(std::string_view ladder) {
    std::vector<Choice> choices = linesOf(ladder);
    for (const Product& product : products()) {
        if (product.ladder != ladder)
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

PlannedRung planned(const Ladder& ladder, const Choice& choice, const HapticScene& scene) {
    PlannedRung rung;
    rung.ladder = &ladder;
    rung.name = choice.name;
    rung.text = std::string(ladder.base) + " " + choice.settings;
    applySettings(rung.settings, rung.text);
    applySettings(rung.exact, ladder.base);
    applySettings(rung.exact, ladder.exact);
    rung.exact.proxyRadius = feltRadius(rung.settings);
    HapticSettings untouched;
    applySettings(untouched, ladder.base);
    rung.isDefault = inEffect(rung.settings, scene) == inEffect(untouched, scene);
    return rung;
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
        settings.forceShading = ShadingMode::TwoPass; // what each of them says
    if (settings.forceShading == ShadingMode::Off)
        settings.shadingTiltLimit = defaults.shadingTiltLimit;
    if (!has(scene, Need::Relief))
        settings.texture = TextureMode::Off;
    if (settings.texture == TextureMode::Off) {
        settings.textureTiltLimit = defaults.textureTiltLimit;
        settings.textureStrength = defaults.textureStrength;
    }
    if (settings.texture == TextureMode::Off || !has(scene, Need::HeightMap))
        settings.textureGradient = defaults.textureGradient;
    if (settings.texture == TextureMode::Off && !hasFactorMaps(scene))
        settings.textureFilter = defaults.textureFilter;
    const bool rough = settings.staticFriction > 0.0 ||
                       (settings.staticFriction < 0.0 &&
                        (isOn(scene, Effect::Friction) || isOn(scene, Effect::ViscousFriction)));
    if (!rough)
        settings.friction = FrictionMode::Off;
    return settings;
}

std::vector<PlannedRung> planLadder(const Ladder& ladder, const HapticScene& scene,
                                    std::vector<std::string>& notes) {
    std::vector<PlannedRung> rungs;
    const auto leaveOut = [&](const std::string& name, const std::string& why) {
        notes.push_back(std::string(ladder.name) + ", " + name + ": left out, " + why);
    };
    size_t same = 0;
    std::map<Need, std::pair<size_t, std::string>> missing; ///< how many rungs, and the first
    for (const Choice& choice : choicesOf(ladder.name)) {
        if (!has(scene, choice.need)) {
            auto& [count, first] = missing[choice.need];
            if (count++ == 0)
                first = choice.name;
            continue;
        }
        PlannedRung rung = planned(ladder, choice, scene);
        const auto alike = std::find_if(rungs.begin(), rungs.end(), [&](const PlannedRung& other) {
            return inEffect(other.settings, scene) == inEffect(rung.settings, scene);
        });
        if (alike == rungs.end())
            rungs.push_back(std::move(rung));
        else
            ++same;
    }
    for (const auto& [need, rest] : missing)
        leaveOut(rest.second + (rest.first > 1 ? " and " + std::to_string(rest.first - 1) + " more" : ""),
                 std::string("nothing there has ") + wordFor(need));
    if (same > 0)
        leaveOut(std::to_string(same) + " rungs", "they would be felt like another one");
    if (rungs.size() == 1 && linesOf(ladder.name).size() > 1) {
        leaveOut("the whole ladder", "one rung alone tells nothing");
        rungs.clear();
    }
    return rungs;
}

} // namespace touchstone::study
