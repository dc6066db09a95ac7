// What an interrupt comes to while the main loop hangs. Each in a process of its own, whose signals it
// changes.

#include "haptics/servo/force_switch.h"
#include "workbench/guards/interrupt.h"

#include <gtest/gtest.h>

#include <chrono>
#include <csignal>
#include <cstdlib>
#include <thread>

namespace touchstone::interrupt_test {
namespace {

/// A main loop that never looks up. It ends at last, should nothing end it.
[[noreturn]] void hang() {
    for (int i = 0; i < 60; ++i)
        std::this_thread::sleep_for(std::chrono::seconds(1));
    std::_Exit(99);
}

[[noreturn]] void end(bool asExpected) {
    std::_Exit(asExpected ? 0 : 1);
}

class Interrupt : public testing::Test {
  protected:
    Interrupt() { GTEST_FLAG_SET(death_test_style, "threadsafe"); }
};

TEST_F(Interrupt, TakesTheForceAwayWhateverTheMainLoopDoes) {
    EXPECT_EXIT(
        {
            catchInterrupts();
            ForceSwitch force;
            const InterruptedForce guard(force);
            if (force.off() || interrupted())
                end(false);
            std::raise(SIGINT);
            end(force.off() && interrupted() && force.state().presses() == 0);
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(Interrupt, ThatCameBeforeThereWasAForceTakesItAwayToo) {
    EXPECT_EXIT(
        {
            catchInterrupts();
            std::raise(SIGTERM);
            ForceSwitch force;
            const InterruptedForce guard(force);
            end(force.off());
        },
        testing::ExitedWithCode(0), "");
}

TEST_F(Interrupt, TheSecondEndsAProgramThatHangsAndTheFirstDoesNot) {
    EXPECT_EXIT(
        {
            catchInterrupts();
            ForceSwitch force;
            const InterruptedForce guard(force);
            std::raise(SIGINT);
            // Longer than the second would give it.
            std::this_thread::sleep_for(std::chrono::seconds(InterruptedForce::kLastSeconds + 1));
            std::raise(SIGINT);
            hang();
        },
        testing::KilledBySignal(SIGALRM), "");
}

TEST_F(Interrupt, TheThirdEndsItAtOnceWhereverThereIsNoForce) {
    EXPECT_EXIT(
        {
            catchInterrupts();
            std::raise(SIGINT);
            std::raise(SIGINT);
            std::raise(SIGINT);
            hang();
        },
        testing::KilledBySignal(SIGINT), "");
}

} // namespace
} // namespace touchstone::interrupt_test
