// The parts of a model that are made beside the servo: which are made, and whether touch goes on with them.

#include "tests/support/recorded_servo.h"
#include "workbench/model/felt_part.h"

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <optional>
#include <stdexcept>
#include <thread>

namespace touchstone::test::felt_part_test {
namespace {

/// Parts that hold nothing but their names, and one that cannot be made.
class FeltParts : public ::testing::Test {
  protected:
    FeltParts() { model_.haptic = floorScene(0.0f).haptic; }

    /// One frame after another until the worker is done, a minute of them at most.
    std::optional<FeltPart> made(const ScenePart& part) {
        EXPECT_TRUE(build_.start(model_, part));
        for (int frame = 0; frame < 60'000; ++frame) {
            if (std::optional<FeltPart> done = build_.take())
                return done;
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        return std::nullopt;
    }
    void failAt(const ScenePart& part) {
        fails_ = part;
        EXPECT_THROW((void)made(part), std::runtime_error);
        fails_.reset();
    }

    Model model_;
    std::optional<ScenePart> fails_; // changes only while nothing is made
    std::atomic<bool> holds_{false};
    FeltPartBuild build_{[this](const Model& whole, const ScenePart& part) {
        while (holds_.load())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        if (fails_ == part)
            throw std::runtime_error("no memory");
        FeltPart felt;
        felt.part = part;
        felt.whole = felt.haptic = whole.haptic;
        return felt;
    }};
    const ScenePart first_{.hidden = {0}, .clip = {}}, second_{.hidden = {0, 1}, .clip = {}};
};

/// Failed: the next part was taken up as if its geometry were the one that is felt.
TEST_F(FeltParts, APartThatFailsLeavesOtherGeometryToTheNext) {
    build_.geometryChanged();
    failAt(first_);
    ASSERT_TRUE(made(second_));
    EXPECT_EQ(build_.swap(), SceneSwap::Anew);
    ASSERT_TRUE(made(first_));
    EXPECT_EQ(build_.swap(), SceneSwap::SameGeometry);
}

/// Failed: it was made again in every frame.
TEST_F(FeltParts, APartThatFailsIsMadeAgainOnlyOfSomethingElse) {
    failAt(first_);
    EXPECT_FALSE(build_.start(model_, first_));
    EXPECT_FALSE(build_.start(model_, first_));
    model_.haptic = floorScene(0.0f).haptic;
    EXPECT_TRUE(made(first_)) << "other materials";
    failAt(second_);
    EXPECT_TRUE(made(first_)) << "another part";
    EXPECT_TRUE(made(second_)) << "asked for again";
}

TEST_F(FeltParts, OtherGeometryIsBegunAnewAlsoByThePartThatIsOnItsWay) {
    holds_ = true;
    ASSERT_TRUE(build_.start(model_, first_));
    EXPECT_FALSE(build_.start(model_, second_)) << "one at a time";
    build_.geometryChanged();
    holds_ = false;
    while (!build_.take())
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    EXPECT_EQ(build_.swap(), SceneSwap::Anew);
    ASSERT_TRUE(made(second_));
    EXPECT_EQ(build_.swap(), SceneSwap::Anew);
}

/// Failed: a part of the model before, or its failure, came to the one that is open now; and hiding an object
/// after an edit of the whole's geometry ended the touch.
TEST_F(FeltParts, AnotherWholeModelDropsWhatIsOnItsWay) {
    for (const bool fails : {false, true}) {
        holds_ = true;
        fails_ = fails ? std::optional(first_) : std::nullopt;
        build_.geometryChanged();
        ASSERT_TRUE(build_.start(model_, first_));
        build_.wholeIsFelt();
        holds_ = false;
        while (!build_.start(model_, second_)) {
            EXPECT_FALSE(build_.take());
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
        EXPECT_EQ(build_.swap(), SceneSwap::SameGeometry);
        for (std::optional<FeltPart> done; !done; done = build_.take())
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
    }
}

} // namespace
} // namespace touchstone::test::felt_part_test
