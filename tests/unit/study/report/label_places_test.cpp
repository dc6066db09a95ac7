#include "study/report/plots/label_places.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::study::test {
namespace {

constexpr double kHalfWidth = 8.0, kHalfHeight = 6.0, kWidth = 680.0, kHeight = 540.0;

void expectApart(const std::vector<PlacedLabel>& labels) {
    for (size_t i = 0; i < labels.size(); ++i) {
        EXPECT_GE(labels[i].x, kHalfWidth);
        EXPECT_LE(labels[i].x, kWidth - kHalfWidth);
        EXPECT_GE(labels[i].y, kHalfHeight);
        EXPECT_LE(labels[i].y, kHeight - kHalfHeight);
        for (size_t j = 0; j < i; ++j)
            EXPECT_TRUE(std::abs(labels[i].x - labels[j].x) >= 2.0 * kHalfWidth ||
                        std::abs(labels[i].y - labels[j].y) >= 2.0 * kHalfHeight)
                << i << " lies on " << j;
    }
}

TEST(LabelPlaces, KeepApartWhereverThePointsAre) {
    std::mt19937 random(7);
    for (int trial = 0; trial < 50; ++trial) {
        std::uniform_real_distribution<double> spread(0.0, 1.0);
        const double size = trial % 2 == 0 ? 1.0 : 0.05; // crowded in a corner, too
        std::vector<Obstacle> references;
        for (int i = 0; i < 34; ++i)
            references.push_back({kWidth * size * spread(random), kHeight * size * spread(random)});
        expectApart(placeLabels(references, references, kHalfWidth, kHalfHeight, kWidth, kHeight));
    }
}

TEST(LabelPlaces, OfOnePointGoAroundIt) {
    const std::vector<Obstacle> references(20, Obstacle{300.0, 200.0});
    const auto labels = placeLabels(references, references, kHalfWidth, kHalfHeight, kWidth, kHeight);
    expectApart(labels);
    EXPECT_FALSE(labels.front().leader);
    EXPECT_TRUE(labels.back().leader);
}

} // namespace
} // namespace touchstone::study::test
