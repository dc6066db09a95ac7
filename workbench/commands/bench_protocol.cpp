#include "workbench/commands/bench_protocol.h"

#include "engine/core/float_mode.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/tick/stepped_hand.h"
#include "study/timing/bench_scene.h"
#include "workbench/figures/settings_json.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdio>
#include <deque>
#include <string>
#include <vector>

namespace touchstone {

namespace {

struct Method {
    const char* name;
    HapticSettings settings;
};

std::array<Method, 2> methods() {
    HapticSettings watch;
    watch.contact = ContactMethod::Neighbourhood;
    return {{{"neighbourhood watch", watch}, {"sweep", HapticSettings{}}}};
}

/// One run: a hand that strokes in a loop that runs as fast as it goes.
struct Run {
    uint64_t ticks = 0, contacts = 0;
    double seconds = 0.0;
    [[nodiscard]] double rate() const { return static_cast<double>(ticks) / seconds; }
};

/// Each tick is a millisecond of the hand's time, whatever it took: the stroke is that of a servo at 1 kHz.
Run strokeFor(const BenchScene& scene, const HapticSettings& settings, double seconds) {
    constexpr double kTick = 1e-3, kSpeed = 0.1, kApproach = 0.02; // s, m/s, m
    constexpr uint64_t kBetweenClocks = 64;
    SteppedHand hand(*scene.haptic);
    NoStopwatch none;
    DeviceSample sample = sampleAt(glm::dvec3(0.0));
    Run run;
    const int64_t begin = monotonicNs();
    const auto end = begin + static_cast<int64_t>(1e9 * seconds);
    int64_t now = begin;
    while (now < end) {
        for (uint64_t i = 0; i < kBetweenClocks; ++i) {
            const double time = kTick * static_cast<double>(run.ticks++);
            sample.position = scene.stroke(kSpeed * time, std::max(0.0, kApproach - kSpeed * time));
            run.contacts += hand.step(settings, sample, kTick, none).contacts > 0 ? 1 : 0;
        }
        now = monotonicNs();
    }
    run.seconds = 1e-9 * static_cast<double>(now - begin);
    return run;
}

/// "812 to 840", kHz.
std::string rateText(const std::vector<Run>& runs) {
    const auto [low, high] = std::minmax_element(
        runs.begin(), runs.end(), [](const Run& a, const Run& b) { return a.rate() < b.rate(); });
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%.0f to %.0f", 1e-3 * low->rate(), 1e-3 * high->rate());
    return text.data();
}

} // namespace

nlohmann::ordered_json benchProtocol(const BenchOptions& options) {
    using Json = nlohmann::ordered_json;
    enterFloatMode();
    constexpr std::array kSeedRates{"12 to 13", "11 to 12", "11 to 12", "9 to 10"};
    std::deque<BenchScene> scenes;
    for (int number = 1; number <= 4; ++number) {
        scenes.push_back(tableOneScene(number));
        scenes.back().haptic->buildNeighbourhoods();
    }
    const auto ways = methods();
    std::vector<std::vector<Run>> runs(ways.size() * scenes.size());
    for (int run = 0; run < options.runs; ++run)
        for (size_t i = 0; i < runs.size(); ++i)
            runs[i].push_back(
                strokeFor(scenes[i % scenes.size()], ways[i / scenes.size()].settings, options.seconds));

    std::printf(
        "Haptic servo rate, kHz: a loop that runs as fast as it goes, %d runs of %g s of each object, "
        "lowest to highest\n\n|  |",
        options.runs, options.seconds);
    for (const BenchScene& scene : scenes)
        std::printf(" %s |", scene.name.c_str());
    std::printf("\n| --- | --- | --- | --- | --- |\n| vertices, lines, polygons |");
    for (const BenchScene& scene : scenes)
        std::printf(" %zu, %zu, %zu |", scene.vertices(), scene.lines(), scene.triangles());
    std::printf("\n| [000 Table I] |");
    for (const char* rate : kSeedRates)
        std::printf(" %s |", rate);
    Json json = Json::array();
    for (size_t i = 0; i < runs.size(); ++i) {
        const BenchScene& scene = scenes[i % scenes.size()];
        const Method& way = ways[i / scenes.size()];
        if (i % scenes.size() == 0)
            std::printf("\n| %s |", way.name);
        std::printf(" %s |", rateText(runs[i]).c_str());
        Json each = Json::array();
        for (const Run& run : runs[i])
            each.push_back({{"seconds", run.seconds},
                            {"ticks", run.ticks},
                            {"ticks_in_contact", run.contacts},
                            {"rate_hz", run.rate()}});
        json.push_back({{"scene", scene.name},
                        {"method", way.name},
                        {"settings", settingsJson(way.settings)},
                        {"vertices", scene.vertices()},
                        {"lines", scene.lines()},
                        {"triangles", scene.triangles()},
                        {"runs", std::move(each)}});
    }
    std::printf("\n\n");
    return json;
}

} // namespace touchstone
