// The ladders are data: what can be wrong with them is found here, not by who runs a study.

#include "engine/core/error.h"
#include "study/ladder/ladder.h"
#include "study/timing/bench_scene.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <set>

namespace touchstone::study {
namespace {

bool isLadder(std::string_view name) {
    return std::any_of(ladders().begin(), ladders().end(),
                       [&](const Ladder& ladder) { return ladder.name == name; });
}

TEST(Ladders, AreMadeOfSettingsThatThereAre) {
    for (const Ladder& ladder : ladders()) {
        HapticSettings settings;
        EXPECT_NO_THROW(applySettings(settings, ladder.base)) << ladder.name;
        EXPECT_NO_THROW(applySettings(settings, ladder.exact)) << ladder.name;
    }
    std::set<std::pair<std::string_view, std::string_view>> names;
    for (const RungLine& line : rungLines()) {
        HapticSettings settings;
        EXPECT_NO_THROW(applySettings(settings, line.settings)) << line.ladder << ", " << line.name;
        EXPECT_TRUE(isLadder(line.ladder)) << line.ladder;
        EXPECT_TRUE(names.emplace(line.ladder, line.name).second) << line.ladder << ", " << line.name;
    }
    for (const Product& product : products()) {
        EXPECT_TRUE(isLadder(product.ladder));
        for (const std::string_view axis : product.axes)
            EXPECT_TRUE(isLadder(axis)) << axis;
    }
}

TEST(Ladders, RefuseWhatIsNoSetting) {
    HapticSettings settings;
    EXPECT_THROW(applySettings(settings, "contact=sweep nonsense=1"), Error);
    EXPECT_THROW(applySettings(settings, "contact"), Error);
    EXPECT_NO_THROW(applySettings(settings, ""));
}

/// On a scene that asks for everything each ladder is whole, its rungs differ, and one is what the program
/// does.
TEST(Ladders, OnAMaterialWithEverythingAreWhole) {
    const BenchScene scene = torusWithAllEffects(2000);
    for (const Ladder& ladder : ladders()) {
        std::vector<std::string> notes;
        const std::vector<PlannedRung> rungs = planLadder(ladder, *scene.haptic, notes);
        EXPECT_GE(rungs.size(), 2u) << ladder.name;
        EXPECT_EQ(std::count_if(rungs.begin(), rungs.end(), [](const PlannedRung& r) { return r.isDefault; }),
                  1)
            << ladder.name;
        for (size_t i = 0; i < rungs.size(); ++i)
            for (size_t k = 0; k < i; ++k)
                EXPECT_FALSE(inEffect(rungs[i].settings, *scene.haptic) ==
                             inEffect(rungs[k].settings, *scene.haptic))
                    << ladder.name << ": " << rungs[i].name << " and " << rungs[k].name;
    }
}

TEST(Ladders, OfferAtLeastThirtyCombinationsOnTheTorus) {
    const BenchScene torus = torusScene(64800);
    for (const Ladder& ladder : ladders()) {
        std::vector<std::string> notes;
        if (ladder.name == "combination") {
            EXPECT_GE(planLadder(ladder, *torus.haptic, notes).size(), 30u);
        }
    }
}

/// A box has neither smooth normals nor maps: such rungs are left out, and it says so.
TEST(Ladders, LeaveOutWhatMakesNoDifference) {
    const BenchScene box = tableOneScene(1);
    for (const Ladder& ladder : ladders()) {
        std::vector<std::string> notes;
        const std::vector<PlannedRung> rungs = planLadder(ladder, *box.haptic, notes);
        if (ladder.name == "contact" || ladder.name == "budget" || ladder.name == "friction") {
            EXPECT_GE(rungs.size(), 3u) << ladder.name;
        }
        if (ladder.name == "shading" || ladder.name == "texture") {
            EXPECT_TRUE(rungs.empty()) << ladder.name;
            EXPECT_FALSE(notes.empty()) << ladder.name;
        }
    }
}

TEST(Ladders, TakeAwayWhatNothingAsksFor) {
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
} // namespace touchstone::study
