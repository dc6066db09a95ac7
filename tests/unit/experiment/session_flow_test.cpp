// Forwards alone: from key to key, what is felt next.

#include "experiment/people/session_flow.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

namespace touchstone::experiment {
namespace {

using Key = SessionFlow::Key;
using Page = SessionFlow::Page;

constexpr const char* kTwoConditions = R"json({
  "touchstoneStudy": 1, "name": "n", "question": "q?", "order": "given", "conditions": [
    {"name": "A", "reference": {"arc": {"radius": 0.1, "angle": 0.9}},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.9, "segments": 3}}, "vary": "nothing", "trials": 2},
    {"name": "B", "reference": {"arc": {"radius": 0.1, "angle": 0.9}},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.9, "segments": 5}}, "vary": "nothing", "trials": 1}]})json";

class SessionFlowTest : public testing::Test {
  protected:
    PersonSession session_{
        folder_ / "a.session", parseStudy(kTwoConditions, "study"), {.seed = 3, .synchronise = false}};
    SessionFlow flow_{session_};

  private:
    static inline const test::ScratchFolder folder_{};
    void SetUp() override {}
    void TearDown() override { std::filesystem::remove(folder_ / "a.session"); }
};

TEST_F(SessionFlowTest, LeadsFromInstructionsToTheEnd) {
    EXPECT_EQ(flow_.page(), Page::Welcome);
    EXPECT_FALSE(flow_.shown().has_value());
    flow_.press(Key::Enter, 0.0);
    EXPECT_EQ(flow_.page(), Page::Training);
    EXPECT_TRUE(flow_.shown()->reference);
    flow_.press(Key::Enter, 1.0);
    for (int i = 0; i < 2; ++i) {
        EXPECT_EQ(flow_.page(), Page::First);
        const bool firstIsReference = flow_.shown()->reference;
        flow_.press(Key::Enter, 2.0);
        EXPECT_EQ(flow_.page(), Page::Second);
        EXPECT_NE(flow_.shown()->reference, firstIsReference) << "one of the two";
        flow_.press(Key::One, 3.0);
        flow_.press(Key::Enter, 5.0);
        EXPECT_EQ(session_.trials().back().right, firstIsReference);
    }
    EXPECT_EQ(flow_.page(), Page::Training) << "of the next condition";
    EXPECT_EQ(flow_.part(), 1u);
    EXPECT_EQ(flow_.parts(), 2u);
    flow_.press(Key::Enter, 6.0);
    flow_.press(Key::Enter, 7.0);
    flow_.press(Key::Two, 8.0);
    flow_.press(Key::Enter, 9.0);
    EXPECT_EQ(flow_.page(), Page::Finished);
    EXPECT_FALSE(flow_.shown().has_value());
    EXPECT_TRUE(session_.finished());
    flow_.press(Key::Enter, 10.0);
    EXPECT_EQ(session_.trials().size(), 3u);
}

TEST_F(SessionFlowTest, HasNoWayBackAndNoAnswerWithoutAChoice) {
    flow_.press(Key::One, 0.0);
    EXPECT_EQ(flow_.page(), Page::Welcome);
    flow_.press(Key::Enter, 0.0);
    flow_.press(Key::Enter, 0.0);
    flow_.press(Key::One, 0.0);
    flow_.press(Key::Two, 0.0);
    EXPECT_EQ(flow_.page(), Page::First) << "an answer before the second object";
    EXPECT_EQ(flow_.chosen(), 0);
    flow_.press(Key::Enter, 4.0);
    flow_.press(Key::Enter, 5.0);
    EXPECT_EQ(flow_.page(), Page::Second) << "nothing was chosen";
    EXPECT_TRUE(session_.trials().empty());
    flow_.press(Key::One, 5.5);
    flow_.press(Key::Two, 6.0);
    EXPECT_EQ(flow_.chosen(), 2) << "may be changed until it is confirmed";
    const uint32_t cues = flow_.cues();
    flow_.press(Key::Enter, 7.0);
    EXPECT_EQ(flow_.cues(), cues + 1);
    ASSERT_EQ(session_.trials().size(), 1u);
    EXPECT_EQ(session_.trials()[0].answer, 2);
    EXPECT_DOUBLE_EQ(session_.trials()[0].firstSeconds, 4.0);
    EXPECT_DOUBLE_EQ(session_.trials()[0].secondSeconds, 3.0);
}

} // namespace
} // namespace touchstone::experiment
