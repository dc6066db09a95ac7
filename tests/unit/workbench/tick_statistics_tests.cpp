// What a stream of records amounts to when some of it was lost.

#include "workbench/figures/stolen_time.h"
#include "workbench/figures/tick_statistics.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>

namespace touchstone::tick_statistics_tests {
namespace {

/// A hand that runs to and fro through a field of force.
TickRecord recordOf(uint64_t step) {
    TickRecord record;
    record.tick = record.step = step;
    record.time = 1e-3 * static_cast<double>(step);
    const double x = 0.01 * std::sin(0.05 * static_cast<double>(step));
    record.output.hip = {x, 0.0, 0.0};
    record.output.force = record.output.commandInWorkspace = {1.0 + 100.0 * x, 0.0, 0.0};
    return record;
}

double joules(const TickStatistics& statistics, const char* name) {
    return statistics.energyJson()[name].get<double>();
}

TEST(TickStatistics, WorkAndPeriodsStopWhereRecordsWereDropped) {
    TickStatistics gapped, before, after;
    for (uint64_t step = 0; step < 200; ++step) {
        if (step >= 70 && step < 130)
            continue;
        gapped.addLive(recordOf(step));
        (step < 100 ? before : after).addLive(recordOf(step));
    }
    EXPECT_EQ(gapped.energyJson()["gaps"], 1u);
    EXPECT_EQ(before.energyJson()["gaps"], 0u);
    EXPECT_EQ(after.energyJson()["gaps"], 0u) << "a reader may begin anywhere";
    for (const char* name : {"given_j", "law_j", "sampling_j", "command_given_j"}) {
        EXPECT_NEAR(joules(gapped, name), joules(before, name) + joules(after, name), 1e-15) << name;
        EXPECT_NE(joules(gapped, name), 0.0);
    }
    EXPECT_NEAR(gapped.wakeJson()["period_p50_us"].get<double>(), 1000.0, 1e-6);
}

TEST(TickStatistics, DeadlinesThatWereSleptThroughAreNoGap) {
    // The force was held all the while: what it did is known.
    TickStatistics late;
    TickRecord record = recordOf(0);
    late.addLive(record);
    record = recordOf(40);
    record.step = 1;
    late.addLive(record);
    const double way = recordOf(40).output.hip.x;
    EXPECT_EQ(late.energyJson()["gaps"], 0u);
    EXPECT_NEAR(joules(late, "given_j"), way, 1e-15);
}

TEST(TickStatistics, ALoopThatStartsAgainHasDoneNothingMeanwhile) {
    TickStatistics statistics;
    statistics.addLive(recordOf(0));
    TickRecord again = recordOf(40);
    again.tick = 0;
    again.step = 1;
    statistics.addLive(again);
    EXPECT_EQ(joules(statistics, "given_j"), 0.0);
    EXPECT_EQ(statistics.energyJson()["gaps"], 1u);
}

TEST(TickStatistics, StagesAreOfTheTicksInContact) {
    TickStatistics statistics;
    for (uint64_t step = 0; step < 10; ++step) {
        TickRecord record = recordOf(step);
        record.output.contacts = step < 4 ? 1 : 0;
        record.stageNs[static_cast<size_t>(Stage::Proxy)] = step < 4 ? 100 * static_cast<int>(step) : 9999;
        statistics.addLive(record);
    }
    const auto json = statistics.stagesJson();
    ASSERT_EQ(json.size(), kStageCount);
    EXPECT_EQ(json["proxy"]["mean_ns"], 150.0);
    EXPECT_EQ(json["proxy"]["p50_ns"], 100);
    EXPECT_EQ(json["proxy"]["p99_ns"], 300);
    EXPECT_EQ(json["safety"]["p99_ns"], 0);
}

TEST(TickStatistics, AHistogramTellsEveryTick) {
    Samples nanoseconds;
    for (const int64_t time : {300, 1000, 1001, 49'999, 999'999'999})
        nanoseconds.add(time);
    const std::vector<uint64_t> bins = histogramOf(nanoseconds);
    ASSERT_EQ(bins.size(), kHistogramEndsUs.size() + 1);
    EXPECT_EQ(bins[0], 2u) << "up to and with 1 us";
    EXPECT_EQ(bins[1], 1u);
    EXPECT_EQ(bins[5], 1u) << "20 to 50 us";
    EXPECT_EQ(bins.back(), 1u) << "over 10 ms";
    const auto json = histogramJson(nanoseconds);
    EXPECT_EQ(json["to_us"].size(), json["ticks"].size());
    EXPECT_TRUE(json["to_us"].back().is_null());
}

TEST(StolenTime, IsTheEighthFigureOfTheFirstLine) {
    EXPECT_EQ(StolenTime::parse("cpu  1 2 3 4 5 6 7 88 9 10\ncpu0 1 2 3 4 5 6 7 8 9 10\n"), 88u);
    for (const char* text : {"", "cpu 1 2 3", "intr 1 2 3 4 5 6 7 8", "cpu0 1 2 3 4 5 6 7 8", "cpu a b"})
        EXPECT_EQ(StolenTime::parse(text), std::nullopt) << text;
    const StolenTime here;
    EXPECT_GE(here.seconds().value_or(0.0), 0.0);
}

} // namespace
} // namespace touchstone::tick_statistics_tests
