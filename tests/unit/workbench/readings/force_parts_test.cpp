#include "workbench/readings/force_history.h"
#include "workbench/readings/force_parts.h"

#include <gtest/gtest.h>

#include <cmath>
#include <initializer_list>

namespace touchstone::force_parts_test {
namespace {

HapticOutput touching(const glm::dvec3& force, std::initializer_list<glm::dvec3> planes,
                      const glm::dvec3& felt) {
    HapticOutput tick;
    tick.contacts = 1;
    tick.force = force;
    tick.normal = felt;
    for (const glm::dvec3& plane : planes)
        tick.planes[tick.planeCount++] = plane;
    return tick;
}

TEST(ForceParts, AreAlongAndAcrossTheFacetWhateverNormalIsFelt) {
    const glm::dvec3 felt = glm::normalize(glm::dvec3(0.3, 0.0, 1.0));
    const ForceParts parts = forceParts(touching(0.6 * felt, {{0.0, 0.0, 1.0}}, felt));
    EXPECT_DOUBLE_EQ(parts.normal, 0.6 * felt.z);
    EXPECT_NEAR(parts.tangential, 0.6 * felt.x, 1e-15) << "what a bump adds is across the mesh";
}

TEST(ForceParts, OfAnEdgeAreAboutTheMeanOfItsPlanes) {
    const HapticOutput tick = touching({1.0, 0.0, 1.0}, {{1.0, 0.0, 0.0}, {0.0, 0.0, 1.0}}, {0.0, 0.0, 1.0});
    EXPECT_NEAR(forceParts(tick).normal, std::sqrt(2.0), 1e-15);
    EXPECT_NEAR(forceParts(tick).tangential, 0.0, 1e-15);
}

TEST(ForceParts, FallBackToTheFeltNormalAndToNothing) {
    const glm::dvec3 up{0.0, 1.0, 0.0};
    EXPECT_EQ(surfaceNormal(touching(up, {}, up)), up) << "no plane is active";
    EXPECT_EQ(surfaceNormal(touching(up, {{1.0, 0.0, 0.0}, {-1.0, 0.0, 0.0}}, up)), up) << "they cancel";
    EXPECT_EQ(forceParts(touching(up, {}, glm::dvec3(0.0))).tangential, 0.0) << "not recorded";
    HapticOutput air = touching(up, {up}, up);
    air.contacts = 0;
    EXPECT_EQ(surfaceNormal(air), glm::dvec3(0.0));
    EXPECT_EQ(forceParts(air).normal, 0.0);
}

TEST(ForceParts, AForceIsNotSentWhileItIsOffOrSafetyHoldsItOff) {
    HapticSettings settings;
    HapticOutput tick;
    EXPECT_TRUE(forceSent(tick, settings));
    for (const TickFlag flag : {TickFlag::SafetyLatched, TickFlag::ForceFault}) {
        tick.flags = static_cast<uint32_t>(flag);
        EXPECT_FALSE(forceSent(tick, settings));
    }
    tick.flags = static_cast<uint32_t>(TickFlag::ForceLimited);
    EXPECT_TRUE(forceSent(tick, settings)) << "less of it is";
    settings.forceEnabled = false;
    EXPECT_FALSE(forceSent(tick, settings));
}

TEST(ForceHistory, KeepsBothPairsOfPartsAndTheComponents) {
    ForceHistory history(2);
    TickRecord record;
    const glm::dvec3 felt = glm::normalize(glm::dvec3(0.0, 0.5, 1.0));
    record.output = touching({0.1, 0.2, 0.6}, {{0.0, 0.0, 1.0}}, felt);
    history.add(record, false);
    const ForceHistory::Entry& entry = history.at(0);
    EXPECT_FLOAT_EQ(entry.normal, 0.6f);
    EXPECT_FLOAT_EQ(entry.surfaceTangential, std::sqrt(0.05f));
    EXPECT_FLOAT_EQ(entry.x, 0.1f);
    EXPECT_FLOAT_EQ(entry.y, 0.2f);
    EXPECT_FLOAT_EQ(entry.z, 0.6f);
    const double along = glm::dot(record.output.force, felt);
    EXPECT_NEAR(entry.tangential, glm::length(record.output.force - along * felt), 1e-7);
    EXPECT_NE(entry.tangential, entry.surfaceTangential);
}

} // namespace
} // namespace touchstone::force_parts_test
