#include "engine/time/samples.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <random>
#include <vector>

namespace touchstone {
namespace {

TEST(Samples, NothingAddedIsZero) {
    const Samples samples;
    EXPECT_EQ(samples.percentile(0.5), 0);
    EXPECT_EQ(samples.most(), 0);
    EXPECT_EQ(samples.mean(), 0.0);
}

TEST(Samples, PercentilesAreExactByNearestRank) {
    Samples samples;
    for (int i = 100; i >= 1; --i)
        samples.add(i);
    EXPECT_EQ(samples.percentile(0.0), 1);
    EXPECT_EQ(samples.percentile(0.5), 50);
    EXPECT_EQ(samples.percentile(0.99), 99);
    EXPECT_EQ(samples.percentile(0.999), 100);
    EXPECT_EQ(samples.percentile(1.0), 100);
    EXPECT_EQ(samples.most(), 100);
    EXPECT_DOUBLE_EQ(samples.mean(), 50.5);
}

TEST(Samples, AgreesWithSortingOnRandomValues) {
    std::mt19937_64 random(7);
    for (int round = 0; round < 50; ++round) {
        Samples samples;
        std::vector<int64_t> all(1 + random() % 500);
        for (int64_t& value : all) {
            value = static_cast<int64_t>(random() % 1000) - 500;
            samples.add(value);
        }
        std::sort(all.begin(), all.end());
        for (const double share : {0.1, 0.5, 0.9, 0.99}) {
            const int64_t value = samples.percentile(share);
            const auto notAbove = std::upper_bound(all.begin(), all.end(), value) - all.begin();
            const auto below = std::lower_bound(all.begin(), all.end(), value) - all.begin();
            EXPECT_GE(static_cast<double>(notAbove), share * static_cast<double>(all.size()));
            EXPECT_LT(static_cast<double>(below), share * static_cast<double>(all.size()) + 1e-9);
        }
    }
}

TEST(Samples, AHistogramCountsEachValueOnce) {
    Samples samples;
    for (const int value : {-5, 0, 10, 11, 20, 21, 1000})
        samples.add(value);
    const std::array<int64_t, 2> ends{10, 20};
    EXPECT_EQ(samples.histogram(ends), (std::vector<uint64_t>{3, 2, 2})) << "an end belongs to its own bin";
    EXPECT_EQ(samples.histogram({}), std::vector<uint64_t>{7});
}

TEST(Samples, AWindowForgetsTheOldest) {
    Samples samples(3);
    for (const int value : {100, 1, 2, 3})
        samples.add(value);
    EXPECT_EQ(samples.count(), 3u);
    EXPECT_EQ(samples.most(), 3);
    samples.add(50);
    EXPECT_EQ(samples.percentile(0.0), 2);
}

} // namespace
} // namespace touchstone
