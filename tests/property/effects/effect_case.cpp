#include "tests/property/effects/effect_case.h"

#include <cstdio>
#include <random>
#include <set>
#include <tuple>

namespace touchstone::test {

namespace {

constexpr std::array kShading{ShadingMode::Off, ShadingMode::TwoPass, ShadingMode::Projected,
                              ShadingMode::Direction, ShadingMode::SingleRound};
constexpr std::array kFriction{FrictionMode::Off, FrictionMode::Zilles, FrictionMode::Ho,
                               FrictionMode::Elastoplastic, FrictionMode::VelocityThreshold};
constexpr std::array kTexture{TextureMode::Off, TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky,
                              TextureMode::BlinnMagnitude};
constexpr std::array kRadius{0.0, 0.5e-3, 3e-3};
constexpr size_t kFactors = 6;

using Levels = std::array<size_t, kFactors>;

constexpr Levels kCounts{kShading.size(), kFriction.size(), kTexture.size(), kRadius.size(), 2, 2};

EffectCase caseOf(EffectBody body, EffectStroke stroke, const Levels& level) {
    return {.body = body,
            .stroke = stroke,
            .shading = kShading[level[0]],
            .friction = kFriction[level[1]],
            .texture = kTexture[level[2]],
            .radius = kRadius[level[3]],
            .oneSided = level[4] == 1,
            .moving = level[5] == 1};
}

/// Two factors and a level of each.
using Pair = std::tuple<size_t, size_t, size_t, size_t>;

size_t covers(const Levels& level, const std::set<Pair>& open) {
    size_t count = 0;
    for (size_t a = 0; a < kFactors; ++a)
        for (size_t b = a + 1; b < kFactors; ++b)
            count += open.count({a, level[a], b, level[b]});
    return count;
}

} // namespace

std::string bodyName(EffectBody body, bool identifier) {
    constexpr std::array kBodies{"sphere", "fine-sphere", "torus", "box", "room", "Suzanne", "ToyCar"};
    std::string name = kBodies[static_cast<size_t>(body)];
    if (identifier)
        std::erase(name, '-');
    return name;
}

std::string strokeName(EffectBody body, EffectStroke stroke) {
    constexpr std::array kStrokes{"shallow", "deep", "fast"};
    return bodyName(body) + " " + kStrokes[static_cast<size_t>(stroke)];
}

std::string EffectCase::name() const {
    const HapticSettings s = settings(0);
    char text[160];
    std::snprintf(text, sizeof text, "%s %s %s %s r%g %s%s", strokeName(body, stroke).c_str(),
                  settingValue(s, "forceShading").c_str(), settingValue(s, "friction").c_str(),
                  settingValue(s, "texture").c_str(), 1e3 * radius, oneSided ? "front" : "both",
                  moving ? " moving" : "");
    return text;
}

HapticSettings EffectCase::settings(unsigned seed) const {
    HapticSettings s;
    s.forceShading = shading;
    s.friction = friction;
    s.texture = texture;
    s.proxyRadius = radius;
    s.staticFriction = friction == FrictionMode::Off ? -1.0 : seed % 2 == 0 ? 0.45 : 1.2;
    s.dynamicFriction = friction == FrictionMode::Off ? -1.0 : seed % 2 == 0 ? 0.36 : 0.8;
    return s;
}

std::vector<EffectCase> effectProduct(EffectBody body, EffectStroke stroke) {
    std::vector<EffectCase> all;
    Levels level{};
    for (size_t factor = 0; factor < kFactors;) {
        all.push_back(caseOf(body, stroke, level));
        for (factor = 0; factor < kFactors && ++level[factor] == kCounts[factor]; ++factor)
            level[factor] = 0;
    }
    return all;
}

std::vector<EffectCase> effectPairs(EffectBody body, EffectStroke stroke, unsigned seed) {
    std::set<Pair> open;
    for (size_t a = 0; a < kFactors; ++a)
        for (size_t b = a + 1; b < kFactors; ++b)
            for (size_t i = 0; i < kCounts[a]; ++i)
                for (size_t k = 0; k < kCounts[b]; ++k)
                    open.insert({a, i, b, k});
    std::mt19937 random(seed);
    std::vector<EffectCase> cases;
    while (!open.empty()) {
        // Of many rows that hold one pair which is still open, the one that covers most.
        Levels best{};
        size_t most = 0;
        for (int attempt = 0; attempt < 100; ++attempt) {
            Levels trial{};
            for (size_t f = 0; f < kFactors; ++f)
                trial[f] = random() % kCounts[f];
            const auto& [a, i, b, k] = *open.begin();
            trial[a] = i;
            trial[b] = k;
            if (const size_t count = covers(trial, open); count > most) {
                most = count;
                best = trial;
            }
        }
        for (size_t a = 0; a < kFactors; ++a)
            for (size_t b = a + 1; b < kFactors; ++b)
                open.erase({a, best[a], b, best[b]});
        cases.push_back(caseOf(body, stroke, best));
    }
    return cases;
}

} // namespace touchstone::test
