#include "workbench/figures/texture_figures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>

namespace touchstone {

std::vector<Coverage> coverageOf(const HapticScene& scene, const PersistentTextures* textures) {
    std::vector<Coverage> all;
    if (textures == nullptr)
        return all;
    for (size_t k = 0; k < scene.objects.size() && k < scene.programFromObject.size(); ++k) {
        const PersistentTexture* const texture = textures->at(static_cast<int>(k));
        if (texture == nullptr)
            continue;
        const PersistentTextureSize& size = texture->size();
        const auto minimum = static_cast<double>(size.minimum);
        const double range = std::max(static_cast<double>(size.maximum) - minimum, 1e-12);
        const double side = scene.programFromObject[k].scale;
        all.push_back({.object = static_cast<int>(k),
                       .left = (texture->mean() - minimum) / range,
                       .removed = (static_cast<double>(size.initial) - texture->mean()) / range,
                       .areaM2 = texture->map()->area() * side * side});
    }
    return all;
}

std::string coverageText(const Coverage& coverage) {
    constexpr double kCm2 = 1e4; // of a m^2
    const double removed = std::abs(coverage.removed);
    std::array<char, 128> text{};
    std::snprintf(text.data(), text.size(), "coverage %.1f %%, %.1f %% %s (%.3g cm^2)", 100.0 * coverage.left,
                  100.0 * removed, coverage.removed < 0.0 ? "added" : "removed",
                  kCm2 * removed * coverage.areaM2);
    return text.data();
}

nlohmann::ordered_json texturesJson(const HapticScene& scene, const PersistentTextures* textures) {
    if (textures == nullptr)
        return nullptr;
    nlohmann::ordered_json all = nlohmann::ordered_json::array();
    for (const Coverage& coverage : coverageOf(scene, textures)) {
        const PersistentTexture& texture = *textures->at(coverage.object);
        const auto changed =
            std::ranges::count_if(texture.values(), [&](float v) { return v != texture.size().initial; });
        all.push_back({{"object", scene.objects[static_cast<size_t>(coverage.object)]->name},
                       {"width", texture.size().width},
                       {"height", texture.size().height},
                       {"area_m2", coverage.areaM2},
                       {"mean", texture.mean()},
                       {"left_percent", 100.0 * coverage.left},
                       {"removed_percent", 100.0 * coverage.removed},
                       {"changed_texels", changed}});
    }
    return all;
}

void printCoverage(const HapticScene& scene, const PersistentTextures* textures) {
    for (const Coverage& coverage : coverageOf(scene, textures))
        std::printf("%s: %s\n", scene.objects[static_cast<size_t>(coverage.object)]->name.c_str(),
                    coverageText(coverage).c_str());
}

} // namespace touchstone
