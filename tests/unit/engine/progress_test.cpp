#include "engine/core/parallel.h"
#include "engine/core/progress.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <vector>

namespace touchstone::progress_test {
namespace {

constexpr size_t kMany = 7 * kProgressWork + 123;

TEST(Progress, PartsOfPartsLieInTheWhole) {
    std::vector<double> seen;
    const Progress::Report report = [&](double fraction, const char*) { seen.push_back(fraction); };
    const Progress whole(&report, nullptr);
    whole.part(0.2, 0.6).part(0.5, 1.0).step(0.5, "");
    whole.part(0.2, 0.6).silent().step(0.9, "");
    Progress().step(0.5, "");
    ASSERT_EQ(seen.size(), 1u);
    EXPECT_NEAR(seen[0], 0.5, 1e-12);
}

TEST(Progress, CancelledOnesThrowAndDoNotReport) {
    const std::atomic<bool> cancel{true};
    size_t reports = 0;
    const Progress::Report report = [&](double, const char*) { ++reports; };
    EXPECT_THROW(Progress(&report, &cancel).part(0.0, 0.5).step(0.0, ""), Cancelled);
    EXPECT_EQ(reports, 0u);
}

TEST(EstimatedProgress, MovesWhileNothingIsHeardAndNeverBackOrToTheEnd) {
    std::vector<double> seen;
    const Progress::Report report = [&](double fraction, const char*) { seen.push_back(fraction); };
    {
        EstimatedProgress estimate(Progress(&report, nullptr), "waiting", 0.2);
        std::this_thread::sleep_for(std::chrono::milliseconds(300)); // the library says nothing
        EXPECT_TRUE(estimate.at(0.01));
        for (const double known : {0.3, 0.2, 0.97, 0.9, 1.5})
            EXPECT_TRUE(estimate.at(known));
    }
    ASSERT_GE(seen.size(), 3u);
    EXPECT_TRUE(std::is_sorted(seen.begin(), seen.end()));
    EXPECT_EQ(seen.front(), 0.0);
    EXPECT_EQ(seen.back(), 1.0) << "the library's own word counts";
    EXPECT_GT(seen[1], 0.0);
    EXPECT_LT(seen[1], 0.97) << "an estimate";
}

TEST(EstimatedProgress, TellsTheLibraryToStop) {
    std::atomic<bool> cancel{false};
    EstimatedProgress estimate(Progress(nullptr, &cancel), "waiting", 1.0);
    EXPECT_TRUE(estimate.at(0.1));
    cancel = true;
    EXPECT_FALSE(estimate.at(0.2));
}

TEST(InParallel, VisitsEveryElementOnce) {
    for (const size_t count : {size_t{0}, size_t{1}, kProgressWork, kProgressWork + 1, kMany}) {
        std::vector<uint8_t> visits(count, 0);
        inParallel(count, {}, "", [&](size_t begin, size_t end) {
            EXPECT_EQ(begin % kProgressWork, 0u);
            for (size_t i = begin; i < end; ++i)
                ++visits[i];
        });
        EXPECT_EQ(std::accumulate(visits.begin(), visits.end(), size_t{0}), count);
        EXPECT_TRUE(std::ranges::all_of(visits, [](uint8_t n) { return n == 1; }));
    }
}

TEST(InParallel, BringsOutWhatTheWorkThrowsAndStopsWhenCancelled) {
    std::atomic<size_t> blocks{0};
    EXPECT_THROW(inParallel(kMany, {}, "",
                            [&](size_t begin, size_t) {
                                ++blocks;
                                if (begin == 0)
                                    throw std::runtime_error("no");
                            }),
                 std::runtime_error);
    std::atomic<bool> cancel{false};
    blocks = 0;
    EXPECT_THROW(inParallel(100 * kProgressWork, Progress(nullptr, &cancel), "",
                            [&](size_t, size_t) {
                                ++blocks;
                                cancel = true;
                            }),
                 Cancelled);
    EXPECT_LE(blocks, 2u) << "one for each thread";
}

} // namespace
} // namespace touchstone::progress_test
