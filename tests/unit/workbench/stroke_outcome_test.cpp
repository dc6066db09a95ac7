#include "engine/core/error.h"
#include "workbench/commands/stroke_outcome.h"

#include <gtest/gtest.h>

#include <string>

namespace touchstone::stroke_outcome_test {
namespace {

const StrokeRequest kTap{.name = "tap"};

TEST(StrokeOutcome, AStrokeThatNeverTouchesFailsWithItsNameAndARemedy) {
    try {
        requireTouch("sheet.glb", kTap, 2.2, 2.2, 0);
        FAIL();
    } catch (const Error& error) {
        EXPECT_EQ(error.file(), "sheet.glb");
        EXPECT_NE(error.problem().find("'tap' never touches"), std::string::npos) << error.problem();
        EXPECT_NE(error.remedy().find("--stroke"), std::string::npos) << error.remedy();
    }
}

TEST(StrokeOutcome, OneTickInContactIsATouch) {
    testing::internal::CaptureStderr();
    requireTouch("sheet.glb", kTap, 2.2, 10.0, 1);
    EXPECT_EQ(testing::internal::GetCapturedStderr(), "");
}

TEST(StrokeOutcome, ARunThatIsShorterThanTheStrokeGetsANote) {
    testing::internal::CaptureStderr();
    requireTouch("sheet.glb", kTap, 2.2, 0.01, 0);
    EXPECT_NE(testing::internal::GetCapturedStderr().find("has not touched"), std::string::npos);
}

} // namespace
} // namespace touchstone::stroke_outcome_test
