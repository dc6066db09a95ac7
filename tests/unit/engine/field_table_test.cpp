#include "engine/core/field_table.h"
#include "engine/core/member_count.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <random>

namespace touchstone::field_table_test {
namespace {

enum class Shape : uint8_t { Ball, Box };
struct Thing {
    Shape shape = Shape::Ball;
    double angle = 0.5; // rad
    int count = 3;
    bool on = false;
};

constexpr std::string_view kShapes[]{"ball", "box"}, kSwitch[]{"off", "on"};
constexpr double kDegree = 0.017453292519943295;
constexpr std::array kFields{
    fieldOf<&Thing::shape, Thing>({"shape", "", kShapes, 0, 1, 1.0, true, "what it is"}),
    fieldOf<&Thing::angle, Thing>({"angle", "deg", {}, 0, 90, kDegree, false, "how it lies"}),
    fieldOf<&Thing::count, Thing>({"count", "", {}, -2, 100000, 1.0, true, "how many"}),
    fieldOf<&Thing::on, Thing>({"on", "", kSwitch, 0, 1, 1.0, true, "whether"}),
};
static_assert(kFields.size() == memberCount<Thing>());

const StructField<Thing>& field(std::string_view name) {
    return *findField<Thing>(kFields, name);
}

bool set(Thing& thing, std::string_view name, std::string_view text) {
    double value = 0.0;
    if (!readValue(field(name), text, value))
        return false;
    field(name).set(thing, value);
    return true;
}

TEST(FieldTable, ReadsWhatItWrites) {
    std::mt19937 random(3);
    std::uniform_real_distribution<double> degrees(0.0, 90.0);
    for (int i = 0; i < 2000; ++i) {
        Thing thing{.angle = degrees(random) * kDegree};
        const double before = thing.angle;
        ASSERT_TRUE(set(thing, "angle", writtenValue(field("angle"), thing.angle)));
        ASSERT_EQ(thing.angle, before);
    }
    Thing thing;
    EXPECT_TRUE(set(thing, "shape", "box") && set(thing, "on", "on") && set(thing, "count", "-2"));
    EXPECT_TRUE(thing.shape == Shape::Box && thing.on && thing.count == -2);
    for (const auto& each : kFields)
        EXPECT_TRUE(set(thing, each.name, writtenValue(each, each.get(thing)))) << each.name;
}

TEST(FieldTable, WritesAnAngleAsAPersonGivesIt) {
    Thing thing;
    ASSERT_TRUE(set(thing, "angle", "25"));
    EXPECT_DOUBLE_EQ(thing.angle, 25.0 * kDegree);
    EXPECT_EQ(writtenValue(field("angle"), thing.angle), "25");
}

TEST(FieldTable, RefusesWhatIsNoValueAndSaysWhatIs) {
    Thing thing;
    for (const char* text : {"90.1", "-0.1", "nan", "inf", "", " 1", "1 ", "1x"})
        EXPECT_FALSE(set(thing, "angle", text)) << text;
    EXPECT_FALSE(set(thing, "count", "1.5"));
    EXPECT_FALSE(set(thing, "shape", "0"));
    EXPECT_EQ(thing.angle, Thing{}.angle);
    EXPECT_EQ(refusedValue(field("angle"), "91"), "'91' is not a value of angle; allowed: 0 .. 90 deg");
    EXPECT_EQ(allowedValues(field("shape")), "ball, box");
    EXPECT_EQ(allowedValues(field("count")), "-2 .. 100000");
    EXPECT_EQ(fieldNames<Thing>(kFields), "shape, angle, count, on");
    EXPECT_EQ(findField<Thing>(kFields, "weight"), nullptr);
}

} // namespace
} // namespace touchstone::field_table_test
