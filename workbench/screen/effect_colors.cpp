#include "workbench/screen/effect_colors.h"

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace touchstone {

namespace {

/// Okabe and Ito's colours ("Color universal design", 2008), distinguishable for colour-blind users; sRGB.
constexpr std::array<glm::vec3, 8> kPalette{glm::vec3(0.60f, 0.60f, 0.60f), glm::vec3(0.34f, 0.71f, 0.91f),
                                            glm::vec3(0.90f, 0.62f, 0.00f), glm::vec3(0.00f, 0.62f, 0.45f),
                                            glm::vec3(0.94f, 0.89f, 0.26f), glm::vec3(0.80f, 0.47f, 0.65f),
                                            glm::vec3(0.00f, 0.45f, 0.70f), glm::vec3(0.84f, 0.37f, 0.00f)};

std::string named(const std::set<Effect>& effects) {
    std::string names;
    for (const Effect effect : effects)
        names += (names.empty() ? "" : ", ") + std::string(effectName(effect));
    return names.empty() ? "no effect: contact alone" : names;
}

} // namespace

EffectColors effectColors(const EffectPlan& plan, size_t materials) {
    std::vector<std::set<Effect>> on(materials);
    for (const PlannedEffect& planned : plan.effects)
        if (planned.on && static_cast<size_t>(planned.material) < materials)
            on[static_cast<size_t>(planned.material)].insert(planned.effect);
    std::vector<std::set<Effect>> kinds(on.begin(), on.end());
    std::sort(kinds.begin(), kinds.end(), [](const std::set<Effect>& a, const std::set<Effect>& b) {
        return a.size() != b.size() ? a.size() < b.size() : a < b;
    });
    kinds.erase(std::unique(kinds.begin(), kinds.end()), kinds.end());
    EffectColors colors;
    // Grey is reserved for materials without effects.
    const size_t first = !kinds.empty() && kinds.front().empty() ? 0 : 1;
    std::map<std::set<Effect>, glm::vec3> colorOf;
    for (size_t k = 0; k < kinds.size(); ++k) {
        const glm::vec3 color = kPalette[std::min(first + k, kPalette.size() - 1)];
        colors.kinds.push_back({named(kinds[k]), color});
        colorOf[kinds[k]] = color;
    }
    for (const std::set<Effect>& effects : on)
        colors.materials.push_back(colorOf[effects]);
    return colors;
}

} // namespace touchstone
