// The window's hand with a device that a test moves: what the device is sent while hands change.

#include "haptics/tick/haptic_step.h"
#include "tests/support/recorded_servo.h"
#include "workbench/hand/device_multiplexer.h"
#include "workbench/timeline/playback_device.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <memory>
#include <span>

namespace touchstone::test::hand_switch_test {
namespace {

class ToldDevice final : public LinkedDevice {
  public:
    explicit ToldDevice(const DeviceSample& first) : next(first) {}
    std::string name() const override { return "told"; }
    DeviceLimits limits() const override { return own; }
    DeviceSample sample(double) noexcept override { return next; }
    void apply(const DeviceCommand& command) noexcept override {
        LinkedDevice::apply(command);
        force = command.force();
        ++commands;
    }
    /// What its I/O thread would send, N, no time after the last order.
    [[nodiscard]] glm::dvec3 sent() {
        (void)mailbox_.updateOrder();
        return mailbox_.order(0).force;
    }

    DeviceSample next;
    DeviceLimits own{.maxForce = 1.25};
    glm::dvec3 force{0.0};
    int commands = 0;
};

/// A floor at y = 0, a simulated hand that taps it, and a device that is pressed beneath it, elsewhere.
class HandSwitchTest : public testing::Test {
  protected:
    HandSwitchTest() {
        limits_.maxForceRate = 40.0; // N/s: slower than what fades, so that every step shows
        scene_ = floorScene(0.0f);
        constexpr std::array kTap{glm::dvec3(0.0, 0.005, 0.0), glm::dvec3(0.0, -0.001, 0.0)};
        hand_.offerPath(std::make_shared<const StrokePath>(StrokePath::around(kTap, 0.05)));
        hand_.simulate(true);
        while (glm::length(output_.command.force()) < 0.3 && tick_ < 2000)
            run(1);
        EXPECT_LT(tick_, 2000u) << "the simulated hand presses";
        most_ = 0.0;
        balance_ = 0.0;
    }

    /// What the servo does; holds every tick against what always is to be.
    void run(int ticks, const std::function<void(int)>& move = {}) {
        for (int i = 0; i < ticks; ++i, ++tick_) {
            if (move)
                move(i);
            const int commands = device_->commands;
            sample_ = hand_.sample(kTick * static_cast<double>(tick_));
            sample_.limits = limits_;
            hapticStep(*scene_.haptic, {},
                       {.tick = tick_,
                        .time = kTick * static_cast<double>(tick_),
                        .dt = kTick,
                        .hands = std::span(&sample_, 1)},
                       world_, std::span(&state_, 1), std::span(&output_, 1), stopwatch_);
            hand_.apply(output_.command);
            if (device_->commands == commands)
                device_->force = glm::dvec3(0.0); // let go: who lets go sends zero
            else
                expectGentle();
            last_ = device_->force;
            most_ = std::max(most_, glm::length(device_->force));
            touched_ = std::max(touched_, glm::length(output_.force));
            balance_ = std::max(balance_, state_.limiter.passivity.balance);
        }
    }

    /// Lifts the device by 5 cm/s.
    std::function<void(int)> upTo(double height) {
        return [this, height](int) {
            device_->next.position.y = std::min(device_->next.position.y + 5e-5, height);
        };
    }

    void expectGentle() {
        const double force = glm::length(device_->force);
        ASSERT_LE(force, limits_.maxForce);
        ASSERT_LE(glm::distance(device_->force, last_), 1.001 * limits_.maxForceRate * kTick)
            << "at tick " << tick_;
        const glm::dvec3 place = sample_.mapping.workspaceFromDevice.point(device_->next.position);
        if (device_->next.valid && sample_.valid && glm::distance(place, sample_.inWorkspace()) > 1e-9) {
            ASSERT_EQ(force, 0.0) << "it is elsewhere, at tick " << tick_;
        }
    }

    static constexpr double kTick = 1e-3;
    static constexpr int kGlide = static_cast<int>(DeviceMultiplexer::kGlideTime / kTick);
    DeviceLimits limits_;
    TouchedScene scene_;
    DeviceMultiplexer hand_;
    std::shared_ptr<ToldDevice> device_ = std::make_shared<ToldDevice>(at({0.01, -0.006, 0.02}));
    WorldState world_;
    DeviceState state_;
    DeviceSample sample_;
    HapticOutput output_;
    NoStopwatch stopwatch_;
    uint64_t tick_ = 0;
    glm::dvec3 last_{0.0};
    double most_ = 0.0, touched_ = 0.0, balance_ = 0.0; // N, N, J
};

TEST_F(HandSwitchTest, ADeviceThatIsTakenUpFeelsNothingUntilTheHandIsWhereItIs) {
    hand_.hold(device_);
    run(kGlide);
    EXPECT_GT(touched_, 2.0) << "the glide goes through what is touched";
    EXPECT_EQ(most_, 0.0);
    run(500);
    EXPECT_EQ(most_, 0.0) << "touch begins beneath the floor, where the device is";
    run(500, upTo(0.004));
    EXPECT_NEAR(glm::length(last_), glm::length(output_.force), 1e-9);
    EXPECT_LT(last_.y, -2.0) << "the floor's underside";
    EXPECT_LT(balance_, kNoticedEnergy);
}

/// From the tick on in which a device gets the command its limits are those of the tick, through all that
/// stands before it; a device that takes over from another directly, too.
TEST_F(HandSwitchTest, TheLimitsAreThoseOfTheDeviceThatIsDriven) {
    PlaybackDevice playback(hand_);
    const auto limitsNow = [&] {
        return sampleWithLimits(playback, kTick * static_cast<double>(tick_++)).limits;
    };
    EXPECT_EQ(limitsNow(), DeviceLimits{}) << "the simulated hand's";
    hand_.hold(device_);
    EXPECT_EQ(limitsNow(), device_->own);
    const auto other = std::make_shared<ToldDevice>(at({0.0, 0.01, 0.0}));
    other->own.maxForce = 3.5;
    hand_.hold(nullptr);
    hand_.hold(other);
    EXPECT_EQ(limitsNow(), other->own);
    hand_.hold(nullptr);
    EXPECT_EQ(limitsNow(), DeviceLimits{});
}

TEST_F(HandSwitchTest, WhatIsLeftOfTheOtherHandsForceIsNotItsOwn) {
    limits_.maxForceRate = 0.5; // slower than the glide
    scene_ = floorScene(0.0f);
    run(1);
    hand_.hold(device_);
    run(kGlide + 5);
    EXPECT_GT(glm::length(output_.command.force()), 0.0) << "it is still fading";
    EXPECT_EQ(most_, 0.0);
    run(8000, upTo(0.004));
    EXPECT_GT(glm::length(last_), 2.0);
}

TEST_F(HandSwitchTest, IsLetGoAndTakenUpAgainOnTheWay) {
    hand_.hold(device_);
    run(kGlide + 5);
    run(300, upTo(0.004));
    const int commands = device_->commands;
    EXPECT_GT(glm::length(last_), 2.0);
    hand_.hold(nullptr);
    run(150);
    EXPECT_EQ(device_->commands, commands) << "nobody drives it";
    most_ = 0.0;
    hand_.hold(device_);
    run(kGlide);
    run(200);
    EXPECT_EQ(most_, 0.0) << "within reach of the floor it has to leave first";
    run(300, upTo(0.010));
    EXPECT_EQ(most_, 0.0);
    run(500, [&](int) { device_->next.position.y = std::max(device_->next.position.y - 5e-5, -0.006); });
    EXPECT_GT(last_.y, 2.0);
}

/// The servo's last order holds for 20 ms: a device that somebody else is to hold went on pushing that long.
TEST_F(HandSwitchTest, ADeviceThatIsLetGoIsToldZeroBeforeTheServoKnows) {
    hand_.hold(device_);
    run(kGlide + 5);
    run(300, upTo(0.004));
    EXPECT_GT(glm::length(device_->sent()), 2.0);
    hand_.hold(nullptr);
    EXPECT_EQ(device_->sent(), glm::dvec3(0.0));
    run(1);
    EXPECT_EQ(device_->sent(), glm::dvec3(0.0));
    hand_.hold(device_);
    EXPECT_EQ(device_->sent(), glm::dvec3(0.0)) << "what it was told before holds no more";
    run(kGlide);
    EXPECT_EQ(device_->sent(), glm::dvec3(0.0));
    run(200, upTo(0.010));
    run(500, [&](int) { device_->next.position.y = std::max(device_->next.position.y - 5e-5, -0.006); });
    EXPECT_GT(device_->sent().y, 2.0) << "it is driven again";
    const auto other = std::make_shared<ToldDevice>(at({0.0, 0.02, 0.0}));
    hand_.hold(other);
    EXPECT_EQ(device_->sent(), glm::dvec3(0.0)) << "handed over";
}

TEST_F(HandSwitchTest, IsUnpluggedWhileItGlides) {
    hand_.hold(device_);
    run(600, [&](int i) {
        device_->next.valid = (i < 100 || i >= 120) && (i < 200 || i >= 350) && (i < 390 || i >= 550);
        if (i == 550) // it comes back in the air, and not where it was
            device_->next.position = {-0.02, 0.008, 0.0};
    });
    EXPECT_EQ(most_, 0.0);
    run(500, [&](int) { device_->next.position.y = std::max(device_->next.position.y - 5e-5, -0.006); });
    EXPECT_GT(glm::length(last_), 2.0);
    EXPECT_LT(balance_, kNoticedEnergy);
}

TEST_F(HandSwitchTest, ChangesUnderClutchAndZoom) {
    hand_.workspace({.zoom = 0.5});
    run(400);
    hand_.hold(device_); // zoomed about another place: another mapping
    const auto wander = [&](int i) {
        device_->next.position = {0.01, -0.006 + 0.002 * std::sin(0.01 * i), 0.02};
        device_->next.buttons = i > 100 && i < 250 ? kClutchButton : 0;
        hand_.workspace({.zoom = i > 150 ? 2.0 : 0.5});
    };
    run(kGlide, wander);
    EXPECT_EQ(most_, 0.0);
    EXPECT_LT(balance_, kNoticedEnergy);
    hand_.hold(nullptr);
    run(100);
    hand_.hold(device_);
    run(kGlide, [&](int i) { hand_.workspace({.zoom = 1.0, .clutch = i > 300}); });
    run(200);
    EXPECT_EQ(most_, 0.0) << "the clutch is held";
    hand_.workspace({});
    run(300);
    EXPECT_NEAR(glm::length(last_), glm::length(output_.force), 1e-9);
}

TEST_F(HandSwitchTest, IsCentredWithoutAPush) {
    hand_.hold(device_);
    run(kGlide + 300);
    // Clutched elsewhere, so that centring takes the HIP away; once in a glide, once at rest.
    for (const int glided : {0, 1}) {
        SCOPED_TRACE(glided);
        run(200, [&](int i) {
            hand_.workspace({.clutch = i < 190});
            device_->next.position.x -= 1e-4;
        });
        if (glided == 1) {
            hand_.hold(nullptr);
            run(100);
            hand_.hold(device_);
            run(100);
        }
        hand_.centre();
        run(1);
        EXPECT_FALSE(sample_.valid);
        run(kGlide + 200);
        EXPECT_TRUE(sample_.valid);
        EXPECT_LT(glm::distance(sample_.inWorkspace(), device_->next.position), 1e-12);
    }
    EXPECT_LT(balance_, kNoticedEnergy);
}

TEST_F(HandSwitchTest, CentringTheMouseIsNotDoneToTheDeviceAfterIt) {
    hand_.simulate(false);
    run(kGlide + 10);
    hand_.centre();
    run(10);
    hand_.hold(device_);
    int unknown = 0;
    for (int i = 0; i < 100; ++i) {
        run(1);
        unknown += sample_.valid ? 0 : 1;
    }
    EXPECT_LE(unknown, 1);
}

} // namespace
} // namespace touchstone::test::hand_switch_test
