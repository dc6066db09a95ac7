#include "tests/valid_files/recipe.h"

#include "tests/valid_files/draw.h"

#include <array>

namespace touchstone::test {

const char* featureName(Feature feature) {
    static constexpr std::array<const char*, kFeatureCount> kNames = {
#define TOUCHSTONE_FEATURE(name) #name,
        TOUCHSTONE_FEATURES(TOUCHSTONE_FEATURE)
#undef TOUCHSTONE_FEATURE
    };
    return kNames[static_cast<size_t>(feature)];
}

std::string Recipe::text() const {
    std::string text = "seed " + std::to_string(seed) + ":";
    for (size_t f = 0; f < kFeatureCount; ++f)
        if (features[f])
            text += std::string(" ") + featureName(static_cast<Feature>(f));
    return text;
}

Recipe recipeOf(uint64_t seed, uint64_t index) {
    Draw draw(seed * 0x9E3779B97F4A7C15ull + index);
    Recipe recipe;
    recipe.seed = draw.bits() >> 1; // fits into a signed 64-bit number too
    if (index < kFeatureCount) {
        recipe.features.set(index);
        return recipe;
    }
    const double share = draw.pick(std::vector<double>{0.05, 0.15, 0.4, 0.7});
    for (size_t f = 0; f < kFeatureCount; ++f)
        recipe.features[f] = draw.chance(share);
    return recipe;
}

} // namespace touchstone::test
