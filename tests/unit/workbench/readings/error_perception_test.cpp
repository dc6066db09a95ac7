#include "workbench/panels/error_panel.h"

#include <gtest/gtest.h>

namespace touchstone::error_perception_test {
namespace {

study::LiveErrorFigures errors(double force, double share, double direction) {
    study::LiveErrorFigures error;
    error.force.p99 = force;
    error.forceShare.p99 = share;
    error.direction.p99 = direction;
    error.inContact = 1000;
    return error;
}

// Thresholds: 0.04 N or 8 %, 28.4 degrees (study/errors/noticeable.cpp).
TEST(ErrorPerception, ForceIsBelowWhereEitherOfItsThresholdsHolds) {
    const ErrorPerception large = errorPerception(errors(0.1, 0.05, 0.01));
    EXPECT_TRUE(large.below());
    EXPECT_EQ(large.force, Perception::Undecided) << "not amber above a green verdict";
    EXPECT_EQ(large.forceShare, Perception::Below);
    const ErrorPerception small = errorPerception(errors(0.01, 0.5, 0.01));
    EXPECT_TRUE(small.below());
    EXPECT_EQ(small.force, Perception::Below);
    EXPECT_EQ(small.forceShare, Perception::Undecided);
}

TEST(ErrorPerception, WhatMayBeFeltIsAboveInEveryFigureThatMakesItSo) {
    const ErrorPerception force = errorPerception(errors(0.1, 0.5, 0.01));
    EXPECT_FALSE(force.below());
    EXPECT_EQ(force.force, Perception::Above);
    EXPECT_EQ(force.forceShare, Perception::Above);
    EXPECT_EQ(force.direction, Perception::Below);
    const ErrorPerception direction = errorPerception(errors(0.0, 0.0, 0.6));
    EXPECT_FALSE(direction.below());
    EXPECT_EQ(direction.direction, Perception::Above);
    EXPECT_EQ(direction.force, Perception::Below);
    study::LiveErrorFigures lost = errors(0.0, 0.0, 0.0);
    lost.lost = 1;
    EXPECT_FALSE(errorPerception(lost).below());
    EXPECT_EQ(errorPerception(lost).contact, Perception::Above);
    EXPECT_TRUE(errorPerception({}).below()) << "without contact";
}

} // namespace
} // namespace touchstone::error_perception_test
