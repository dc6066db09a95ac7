// The ablations are data: what can be wrong with them is found here, not by who runs a study.

#include "engine/core/error.h"
#include "study/ablation/ablation.h"
#include "study/timing/bench_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace touchstone::study::ablation_test {
namespace {

bool isAblation(std::string_view name) {
    return std::any_of(ablations().begin(), ablations().end(),
                       [&](const Ablation& ablation) { return ablation.name == name; });
}

TEST(Ablations, AreMadeOfSettingsThatThereAre) {
    for (const Ablation& ablation : ablations()) {
        HapticSettings settings;
        EXPECT_NO_THROW(applySettings(settings, ablation.base)) << ablation.name;
        EXPECT_NO_THROW(applySettings(settings, ablation.exact)) << ablation.name;
    }
    std::set<std::pair<std::string_view, std::string_view>> names;
    for (const ConfigurationLine& line : configurationLines()) {
        HapticSettings settings;
        EXPECT_NO_THROW(applySettings(settings, line.settings)) << line.ablation << ", " << line.name;
        EXPECT_TRUE(isAblation(line.ablation)) << line.ablation;
        EXPECT_TRUE(names.emplace(line.ablation, line.name).second) << line.ablation << ", " << line.name;
    }
    for (const Product& product : products()) {
        EXPECT_TRUE(isAblation(product.ablation));
        for (const std::string_view axis : product.axes)
            EXPECT_TRUE(isAblation(axis)) << axis;
    }
}

TEST(Ablations, RefuseWhatIsNoSetting) {
    HapticSettings settings;
    EXPECT_THROW(applySettings(settings, "contact=sweep nonsense=1"), Error);
    EXPECT_THROW(applySettings(settings, "contact"), Error);
    EXPECT_NO_THROW(applySettings(settings, ""));
}

/// On a scene that asks for everything each ablation is whole, its configurations differ, and one is what the
/// program does.
TEST(Ablations, OnAMaterialWithEverythingAreWhole) {
    const BenchScene scene = torusWithAllEffects(2000);
    for (const Ablation& ablation : ablations()) {
        if (ablation.name == "program")
            continue; // the torus has none
        std::vector<std::string> notes;
        const std::vector<PlannedConfiguration> configurations = planAblation(ablation, *scene.haptic, notes);
        EXPECT_GE(configurations.size(), 2u) << ablation.name;
        EXPECT_EQ(std::count_if(configurations.begin(), configurations.end(),
                                [](const PlannedConfiguration& r) { return r.isDefault; }),
                  1)
            << ablation.name;
        for (size_t i = 0; i < configurations.size(); ++i)
            for (size_t k = 0; k < i; ++k)
                EXPECT_FALSE(inEffect(configurations[i].settings, *scene.haptic) ==
                             inEffect(configurations[k].settings, *scene.haptic))
                    << ablation.name << ": " << configurations[i].name << " and " << configurations[k].name;
    }
}

TEST(Ablations, OfAProgramAreWhereItsSlopeComesFrom) {
    const BenchScene scene = torusScene(2000);
    const std::shared_ptr<HapticScene> programmed = copyOf(*scene.haptic);
    const auto found = std::ranges::find(ablations(), std::string_view("program"), &Ablation::name);
    ASSERT_NE(found, ablations().end());
    std::vector<std::string> notes;
    EXPECT_TRUE(planAblation(*found, *programmed, notes).empty());
    EXPECT_FALSE(notes.empty());
    programmed->plan.programs = true;
    const std::vector<PlannedConfiguration> configurations = planAblation(*found, *programmed, notes);
    ASSERT_EQ(configurations.size(), 4u);
    for (const PlannedConfiguration& configuration : configurations)
        EXPECT_EQ(configuration.isDefault, configuration.name == "dual numbers") << configuration.name;
}

TEST(Ablations, OfferAtLeastThirtyCombinationsOnTheTorus) {
    const BenchScene torus = torusScene(64800);
    for (const Ablation& ablation : ablations()) {
        std::vector<std::string> notes;
        if (ablation.name == "combination") {
            EXPECT_GE(planAblation(ablation, *torus.haptic, notes).size(), 30u);
        }
    }
}

/// A box has neither smooth normals nor maps: such configurations are left out, and it says so.
TEST(Ablations, LeaveOutWhatMakesNoDifference) {
    const BenchScene box = tableOneScene(1);
    for (const Ablation& ablation : ablations()) {
        std::vector<std::string> notes;
        const std::vector<PlannedConfiguration> configurations = planAblation(ablation, *box.haptic, notes);
        if (ablation.name == "contact" || ablation.name == "budget" || ablation.name == "friction") {
            EXPECT_GE(configurations.size(), 3u) << ablation.name;
        }
        if (ablation.name == "shading" || ablation.name == "texture") {
            EXPECT_TRUE(configurations.empty()) << ablation.name;
            EXPECT_FALSE(notes.empty()) << ablation.name;
        }
    }
}

TEST(Ablations, TakeAwayWhatNothingAsksFor) {
    const BenchScene box = tableOneScene(1);
    HapticSettings watch, plain;
    watch.contact = ContactMethod::Neighbourhood;
    watch.proxyRadius = 1e-3;
    EXPECT_EQ(inEffect(watch, *box.haptic).proxyRadius, 0.0);
    HapticSettings other;
    other.texture = TextureMode::Blinn;
    other.forceShading = ShadingMode::Projected;
    other.friction = FrictionMode::Ho;
    EXPECT_EQ(inEffect(other, *box.haptic), inEffect(plain, *box.haptic));
    other.staticFriction = 0.4; // now there is friction to be had
    EXPECT_FALSE(inEffect(other, *box.haptic) == inEffect(plain, *box.haptic));
}

} // namespace
} // namespace touchstone::study::ablation_test
