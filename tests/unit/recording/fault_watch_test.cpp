#include "haptics/recording/fault_watch.h"
#include "haptics/settings/tick_flags.h"

#include <gtest/gtest.h>

#include <vector>

namespace touchstone {
namespace {

class FaultWatchTest : public testing::Test {
  protected:
    /// `count` ticks of a kind; the names of the faults that began, with the index of their tick.
    std::string ticks(int count, uint32_t flags, uint32_t contacts = 1) {
        std::string faults;
        for (int i = 0; i < count; ++i) {
            RecordedTick tick;
            tick.dt = 1e-3;
            tick.contacts = contacts;
            tick.flags = flags;
            const auto fault = watch_.add(tick);
            if (fault)
                faults += fault->name + "@" + std::to_string(i) + " ";
        }
        return faults;
    }
    FaultWatch watch_;
};

const uint32_t kFault = 0u | TickFlag::ForceFault | TickFlag::SafetyLatched;
const uint32_t kLatched = 0u | TickFlag::SafetyLatched;
const uint32_t kInvalid = 0u | TickFlag::InputInvalid;

TEST_F(FaultWatchTest, TellsAFaultWhenItBegins) {
    EXPECT_EQ(ticks(100, 0), "");
    EXPECT_EQ(ticks(3, kFault), "force-fault@0 ");
    EXPECT_EQ(ticks(100, kLatched), "") << "the latch that stays is the same fault";
    EXPECT_EQ(ticks(10, 0), "");
    EXPECT_EQ(ticks(10, kLatched), "safety-latched@0 ");
    EXPECT_EQ(ticks(1, 0) + ticks(2, kFault), "force-fault@0 ");
}

TEST_F(FaultWatchTest, TellsAHandThatIsLostWhileItTouches) {
    EXPECT_EQ(ticks(2000, 0), "");
    EXPECT_EQ(ticks(99, kInvalid, 0), "");
    EXPECT_EQ(ticks(1000, kInvalid, 0), "input-lost@0 ") << "a tenth of a second, once";
    EXPECT_EQ(ticks(900, 0), "");
    EXPECT_EQ(ticks(200, kInvalid, 0), "") << "not yet well again";
    EXPECT_EQ(ticks(20000, 0), "");
    EXPECT_EQ(ticks(200, kInvalid, 0), "input-lost@99 ");
}

TEST_F(FaultWatchTest, AStormOfBadSamplesCountsTogether) {
    EXPECT_EQ(ticks(2000, 0), "");
    std::string faults;
    for (int i = 0; i < 300; ++i)
        faults += ticks(1, kInvalid, 0) + ticks(1, 0);
    EXPECT_EQ(faults, "input-lost@0 ");
}

TEST_F(FaultWatchTest, AHandThatTouchedNothingMayGo) {
    EXPECT_EQ(ticks(2000, 0, 0) + ticks(5000, kInvalid, 0), "");
    EXPECT_EQ(ticks(2000, 0, 1) + ticks(1500, 0, 0) + ticks(5000, kInvalid, 0), "");
}

TEST_F(FaultWatchTest, ASecondOfGoodInputMakesALossGood) {
    EXPECT_EQ(ticks(2000, 0), "");
    EXPECT_EQ(ticks(300, kInvalid, 0), "input-lost@99 ");
    EXPECT_EQ(ticks(1100, 0), "") << "well again";
    EXPECT_EQ(ticks(300, kInvalid, 0), "input-lost@99 ") << "and lost again, from the beginning";
}

TEST_F(FaultWatchTest, AHandInSightIsNotLost) {
    EXPECT_EQ(ticks(2000, 0), "");
    for (int i = 0; i < 500; ++i) {
        RecordedTick tick;
        tick.dt = 1e-3;
        tick.flags = kInvalid;
        tick.sample.inSight = true;
        EXPECT_FALSE(watch_.add(tick));
    }
}

} // namespace
} // namespace touchstone
