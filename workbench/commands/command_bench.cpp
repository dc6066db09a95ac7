// The cost of a tick relative to Embree's floor: the bounds that the solver promises, and growth with the
// number of triangles, in the form of [000 Table I].

#include "engine/core/output_file.h"
#include "engine/core/realtime_guard.h"
#include "study/result/provenance.h"
#include "study/timing/clock_cost.h"
#include "study/timing/configurations.h"
#include "workbench/commands/bench_fields.h"
#include "workbench/commands/bench_protocol.h"
#include "workbench/figures/settings_json.h"
#include "workbench/options/commands.h"

#include <nlohmann/json.hpp>
#include <unistd.h>

#include <array>
#include <cstdio>
#include <deque>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

HapticSettings bare(double proxyRadius) {
    HapticSettings settings;
    settings.proxyRadius = proxyRadius;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    settings.texture = TextureMode::Off;
    return settings;
}

std::string number(const char* format, double value) {
    char text[48];
    std::snprintf(text, sizeof text, format, value);
    return text;
}
std::string microseconds(double ns) {
    return number("%.2f", 1e-3 * ns);
}
/// Ticks per second, in kHz.
std::string kilohertz(double ns) {
    return number("%.0f", 1e6 / ns);
}
/// 64800 as "64,800".
std::string grouped(size_t value) {
    std::string text = std::to_string(value);
    for (size_t at = text.size(); at > 3; at -= 3)
        text.insert(at - 3, ",");
    return text;
}

class PercentLine {
  public:
    explicit PercentLine(const char* what) : what_(what), shown_(isatty(STDERR_FILENO) != 0) {}
    void operator()(double fraction) const {
        if (shown_)
            std::fprintf(stderr, fraction < 1.0 ? "\r%s %3.0f %%" : "\r\033[K", what_, 100.0 * fraction);
    }

  private:
    const char* what_;
    bool shown_;
};

Json rungJson(const TimedConfiguration& configuration, const ConfigurationTimes& times) {
    return {{"name", configuration.name},
            {"scene", configuration.scene->name},
            {"triangles", configuration.scene->triangles()},
            {"objects", configuration.scene->haptic->objects.size()},
            {"settings", settingsJson(configuration.settings)},
            {"speed_m_s", configuration.speed},
            {"ticks", times.ticks},
            {"ticks_in_contact", times.contactTicks},
            {"step_p50_ns", times.median()},
            {"step_p99_ns", times.p99()},
            {"step_p50_ns_by_round", times.medians},
            {"ray_p50_ns", times.rayMedian()},
            {"ray_p99_ns", times.ray.percentile(0.99)},
            {"step_in_rays", times.inRays()},
            {"mean_iterations", times.meanIterations()},
            {"flagged_ticks", times.flaggedTicks},
            {"allocations_in_tick", times.allocations}};
}

/// Figures against their bounds.
struct Verdicts {
    size_t missed = 0;
    const char* word(bool met) {
        missed += met ? 0 : 1;
        return met ? "met" : "MISSED";
    }
};

/// A stroke on the torus with measurements of CHAI3D and a promised bound.
struct FastCase {
    size_t triangles;
    double radius, speed; // m, m/s
    double raysBound;     // of the median; 0: none, the figure is only reported
    double tailBound;     // of the 99th percentile, rays; 0: none
    const char* peer;     // median / p99 in µs and rays of CHAI3D 3.3.0, full solve
};
constexpr FastCase kFastCases[] = {
    {64'800, 0.0, 0.1, 6.0, 8.0, "2.2 / 5.5, 18 rays"},
    {64'800, 0.5e-3, 0.1, 12.0, 10.0, "9.3 / 20.5, 78 rays"},
    {1'000'000, 0.0, 0.1, 8.0, 10.0, "3.1 / 8.8, 29 rays"},
    {1'000'000, 0.5e-3, 0.1, 20.0, 18.0, "30 / 78, 285 rays"},
    {64'800, 0.0, 1.0, 0.0, 0.0, ""},
    {64'800, 0.5e-3, 1.0, 0.0, 0.0, ""},
    {1'000'000, 0.0, 1.0, 10.0, 0.0, ""},
    {1'000'000, 0.5e-3, 1.0, 16.0, 0.0, "54 / 626"},
};
constexpr double kObjectsBound = 2.0; // a thousand objects over one
constexpr size_t kObjects = 1000;
constexpr size_t kEffectTriangles = 64'800;
/// Proxy radius (m), and the bound on the cost of all effects together beyond a bare tick, in rays.
constexpr std::array<std::pair<double, double>, 2> kEffectBounds{{{0.0, 4.0}, {0.5e-3, 8.0}}};

void printFast(const FastCase& fast, const ConfigurationTimes& times, Verdicts& verdicts) {
    const auto beside = [&](double rays, double bound) {
        return number("%.1f", rays) +
               (bound > 0.0 ? number(" of %.0f, ", bound) + verdicts.word(rays <= bound) : "");
    };
    const std::string rays = beside(times.inRays(), fast.raysBound),
                      tail = beside(times.p99() / times.rayMedian(), fast.tailBound);
    std::printf("| torus %s, r = %.1f mm, %.1f m/s | %s / %s | %.0f | %s | %s | %s |\n",
                grouped(fast.triangles).c_str(), 1e3 * fast.radius, fast.speed,
                microseconds(times.median()).c_str(), microseconds(times.p99()).c_str(), times.rayMedian(),
                rays.c_str(), tail.c_str(), fast.peer);
}

void printObjects(const TimedConfiguration& configuration, const ConfigurationTimes& times,
                  const char* peer) {
    std::printf("| %s, r = %.1f mm, 0.1 m/s | %s / %s | %.0f | %.1f | %.1f | %s |\n",
                configuration.name.c_str(), 1e3 * configuration.settings.proxyRadius,
                microseconds(times.median()).c_str(), microseconds(times.p99()).c_str(), times.rayMedian(),
                times.inRays(), times.p99() / times.rayMedian(), peer);
}

/// Cost of all effects at once, minus the same ticks without any, in rays.
void printEffects(const TimedConfiguration& configuration, const ConfigurationTimes& with,
                  const ConfigurationTimes& without, double bound, Verdicts& verdicts) {
    const double above = (with.median() - without.median()) / without.rayMedian();
    std::printf(
        "all effects on, torus 64,800, r = %.1f mm: %s / %s µs, without %s; on top %.1f rays of %.0f: "
        "%s\n",
        1e3 * configuration.settings.proxyRadius, microseconds(with.median()).c_str(),
        microseconds(with.p99()).c_str(), microseconds(without.median()).c_str(), above, bound,
        verdicts.word(above <= bound));
}

/// What benchFast times: cases of tori, then one object and many, then pairs without and with all effects.
struct FastBench {
    std::deque<BenchScene> scenes;
    std::vector<TimedConfiguration> configurations;
    std::vector<const FastCase*> cases; ///< of the first configurations
    size_t objects = 0, effects = 0;    ///< first configurations of objects and effects
};

FastBench fastBench(const BenchOptions& options) {
    FastBench bench;
    auto& [scenes, configurations, cases, objects, effects] = bench;
    for (const FastCase& fast : kFastCases) {
        if (fast.triangles > options.largestTriangles)
            continue;
        const BenchScene* scene = nullptr;
        for (const BenchScene& made : scenes)
            if (made.name == "torus " + grouped(fast.triangles))
                scene = &made;
        if (scene == nullptr) {
            scenes.push_back(torusScene(fast.triangles));
            scenes.back().name = "torus " + grouped(fast.triangles);
            scene = &scenes.back();
        }
        cases.push_back(&fast);
        configurations.push_back({scene->name, scene, bare(fast.radius), fast.speed});
    }
    objects = configurations.size();
    for (const size_t count : {size_t{1}, kObjects})
        scenes.push_back(sphereGridScene(count));
    const BenchScene *one = &scenes[scenes.size() - 2], *many = &scenes.back();
    for (const double radius : {0.0, 0.5e-3})
        for (const BenchScene* scene : {one, many})
            configurations.push_back({scene->name, scene, bare(radius), 0.1});

    effects = configurations.size();
    // The bare scene has no effect at all, not even a stiffness map, which no setting disables.
    scenes.push_back(torusScene(kEffectTriangles));
    scenes.push_back(torusWithAllEffects(kEffectTriangles));
    for (const auto& [radius, bound] : kEffectBounds) {
        HapticSettings all;
        all.proxyRadius = radius;
        configurations.push_back({"no effects", &scenes[scenes.size() - 2], bare(radius), 0.1});
        configurations.push_back({"all effects", &scenes.back(), all, 0.1});
    }
    return bench;
}

/// Their figures as JSON; prints whether a tick allocates.
Json fastJson(const FastBench& bench, const std::vector<ConfigurationTimes>& times, Verdicts& verdicts) {
    const auto& cases = bench.cases;
    Json json = Json::array();
    uint64_t allocations = 0;
    for (size_t i = 0; i < bench.configurations.size(); ++i) {
        allocations += times[i].allocations;
        json.push_back(rungJson(bench.configurations[i], times[i]));
        if (i < cases.size() && cases[i]->raysBound > 0.0)
            json.back()["bound_in_rays"] = cases[i]->raysBound;
        if (i < cases.size() && cases[i]->tailBound > 0.0)
            json.back()["bound_of_p99_in_rays"] = cases[i]->tailBound;
    }
    std::printf("allocations and frees in ticks: %llu, %s\n\n", static_cast<unsigned long long>(allocations),
                realtime::allocationsAreCounted() ? verdicts.word(allocations == 0) : "not counted");
    return json;
}

Json benchFast(const BenchOptions& options, Verdicts& verdicts) {
    const FastBench bench = fastBench(options);
    const std::vector<TimedConfiguration>& configurations = bench.configurations;
    const std::vector<ConfigurationTimes> times = timeConfigurations(
        configurations, {.rounds = options.rounds, .ticksPerRound = 1000}, PercentLine("fast"));
    std::printf("| stroke 1 mm deep | step, median / p99, µs | ray, ns | in rays | p99 in rays | CHAI3D "
                "3.3.0, µs |\n"
                "|---|---|---|---|---|---|\n");
    for (size_t i = 0; i < bench.cases.size(); ++i)
        printFast(*bench.cases[i], times[i], verdicts);
    std::string verdict;
    for (size_t i = bench.objects; i < bench.effects; i += 2) {
        printObjects(configurations[i], times[i], "");
        printObjects(configurations[i + 1], times[i + 1], "204");
        const double ratio = medianRatio(times[i + 1], times[i]);
        verdict += grouped(kObjects) + " objects take " + number("%.2f", ratio) + " times as long as one" +
                   number(" (r = %.1f mm), of ", 1e3 * configurations[i].settings.proxyRadius) +
                   number("%.0f", kObjectsBound) + ": " + verdicts.word(ratio <= kObjectsBound) +
                   number("; their p99 is %.0f times as long\n", times[i + 1].p99() / times[i].p99());
    }
    std::printf("\n%s", verdict.c_str());
    for (size_t i = 0; i < kEffectBounds.size(); ++i) {
        const size_t at = bench.effects + 2 * i;
        printEffects(configurations[at], times[at + 1], times[at], kEffectBounds[i].second, verdicts);
    }
    return fastJson(bench, times, verdicts);
}

/// A column of [000 Table I], or an additional one.
struct GrowthColumn {
    BenchScene scene;
    const char* seedRate; ///< kHz on a Dual Pentium II, 300 MHz
};

std::deque<GrowthColumn> growthColumns(size_t largest) {
    constexpr const char* kSeedRates[] = {"12 to 13", "11 to 12", "11 to 12", "9 to 10"};
    std::deque<GrowthColumn> columns;
    for (int i = 1; i <= 4; ++i)
        columns.push_back({tableOneScene(i), kSeedRates[i - 1]});
    for (const size_t triangles : {size_t{1'000'000}, size_t{10'000'000}})
        if (triangles <= largest) {
            columns.push_back({torusScene(triangles), ""});
            columns.back().scene.name = "torus " + std::to_string(triangles / 1'000'000) + "M";
        }
    return columns;
}

struct GrowthMethod {
    const char* name;
    HapticSettings settings;
};

HapticSettings walking(HapticSettings settings) {
    settings.contact = ContactMethod::Neighbourhood;
    return settings;
}

HapticSettings byRays(HapticSettings settings, Precision precision) {
    settings.contact = ContactMethod::Rays;
    settings.precision = precision;
    return settings;
}

std::vector<GrowthMethod> growthAblation() {
    return {{"sweep, r = 0", bare(0.0)},
            {"sweep, r = 0.5 mm", bare(0.5e-3)},
            {"neighbourhood watch", walking(bare(0.0))},
            {"rays", byRays(bare(0.0), Precision::Double)},
            {"rays, single precision", byRays(bare(0.0), Precision::Single)},
            {"sweep, r = 0, all effects", HapticSettings{}},
            {"neighbourhood watch, all effects", walking(HapticSettings{})}};
}

Json benchGrowth(const BenchOptions& options) {
    const std::deque<GrowthColumn> columns = growthColumns(options.largestTriangles);
    const std::vector<GrowthMethod> ablation = growthAblation();
    std::vector<TimedConfiguration> configurations;
    for (const GrowthColumn& column : columns)
        column.scene.haptic->buildNeighbourhoods();
    for (const GrowthColumn& column : columns)
        for (const GrowthMethod& method : ablation)
            configurations.push_back({method.name, &column.scene, method.settings, 0.1});
    const std::vector<ConfigurationTimes> times = timeConfigurations(
        configurations, {.rounds = options.rounds, .ticksPerRound = 1000}, PercentLine("growth"));

    const auto row = [&](const std::string& title, const auto& cell) {
        std::printf("| %s |", title.c_str());
        for (size_t c = 0; c < columns.size(); ++c)
            std::printf(" %s |", std::string(cell(c)).c_str());
        std::printf("\n");
    };
    const auto at = [&](size_t column, size_t method) -> const ConfigurationTimes& {
        return times[column * ablation.size() + method];
    };
    row("", [&](size_t c) { return columns[c].scene.name; });
    row("---", [](size_t) { return "---"; });
    row("Number of vertices", [&](size_t c) { return grouped(columns[c].scene.vertices()); });
    row("Number of lines", [&](size_t c) { return grouped(columns[c].scene.lines()); });
    row("Number of polygons", [&](size_t c) { return grouped(columns[c].scene.triangles()); });
    row("Haptic servo rate [000 Table I], kHz", [&](size_t c) { return columns[c].seedRate; });
    for (size_t m = 0; m < ablation.size(); ++m) {
        row(std::string(ablation[m].name) + ", kHz by median (p99)",
            [&](size_t c) { return kilohertz(at(c, m).median()) + " (" + kilohertz(at(c, m).p99()) + ")"; });
        row("its step, median / p99, µs (mean moves)", [&](size_t c) {
            return microseconds(at(c, m).median()) + " / " + microseconds(at(c, m).p99()) +
                   number(" (%.1f)", at(c, m).meanIterations());
        });
    }
    row("ray floor, ns", [&](size_t c) { return number("%.0f", at(c, 0).rayMedian()); });
    std::printf("\n");

    Json json = Json::array();
    for (size_t i = 0; i < configurations.size(); ++i)
        json.push_back(rungJson(configurations[i], times[i]));
    return json;
}

/// The worst tick: the median over the rounds of the longest tick, so that a tick that lost the processor
/// does not count.
double worst(const ConfigurationTimes& times) {
    return static_cast<double>(times.longest.percentile(0.5));
}

Json benchMoving(const BenchOptions& options) {
    std::deque<BenchScene> scenes;
    scenes.push_back(sphereGridScene(kObjects));
    scenes.push_back(movingGridScene(kObjects));
    constexpr size_t kJawTriangles = 64'800;
    if (kJawTriangles <= options.largestTriangles)
        for (const Jaws jaws : {Jaws::Boxes, Jaws::Balls})
            scenes.push_back(jawsScene(jaws, kJawTriangles));
    std::vector<TimedConfiguration> configurations;
    for (const double radius : {0.0, 0.5e-3})
        for (const BenchScene& scene : scenes)
            configurations.push_back(
                {scene.name, &scene, bare(radius), scene.haptic->objects.size() == 2 ? 0.01 : 0.1});
    const std::vector<ConfigurationTimes> times = timeConfigurations(
        configurations, {.rounds = options.rounds, .ticksPerRound = 1000}, PercentLine("moving"));
    std::printf("| objects that move | step, median / p99 / worst, µs | their poses, median, µs | ray, ns | "
                "in rays | pinched ticks |\n|---|---|---|---|---|---|\n");
    Json json = Json::array();
    for (size_t i = 0; i < configurations.size(); ++i) {
        const bool moves = !times[i].poses.empty();
        std::printf("| %s, r = %.1f mm | %s / %s / %s | %s | %.0f | %.1f | %s |\n",
                    configurations[i].name.c_str(), 1e3 * configurations[i].settings.proxyRadius,
                    microseconds(times[i].median()).c_str(), microseconds(times[i].p99()).c_str(),
                    microseconds(worst(times[i])).c_str(),
                    moves ? microseconds(static_cast<double>(times[i].poses.percentile(0.5))).c_str() : "",
                    times[i].rayMedian(), times[i].inRays(), grouped(times[i].pinchedTicks).c_str());
        json.push_back(rungJson(configurations[i], times[i]));
        json.back()["step_worst_ns"] = worst(times[i]);
        json.back()["pinched_ticks"] = times[i].pinchedTicks;
        if (moves)
            json.back()["poses_p50_ns"] = times[i].poses.percentile(0.5);
    }
    std::printf("\n");
    return json;
}

} // namespace

int benchCommand(const BenchOptions& options) {
    Verdicts verdicts;
    Json json{{"command", "bench"},
              {"version", TOUCHSTONE_VERSION},
              {"processor", study::processorName()},
              {"compiler", __VERSION__},
              {"clock_ns", clockCostNs()}};
    const auto wanted = [&](const char* what) { return options.what.empty() || options.what == what; };
    if (wanted("fast"))
        json["fast"] = benchFast(options, verdicts);
    if (wanted("growth"))
        json["growth"] = benchGrowth(options);
    if (wanted("moving"))
        json["moving"] = benchMoving(options);
    if (wanted("fields"))
        json["fields"] = benchFields(options, verdicts.missed);
    if (options.what == "protocol")
        json["protocol"] = benchProtocol(options);
    std::printf("Ticks in contact; reading the clock, %s ns, is part of every time. %s\n",
                json["clock_ns"].dump().c_str(), study::processorName().c_str());
    json["missed_bounds"] = verdicts.missed;
    if (!options.json.empty())
        writeFile(options.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return options.check && verdicts.missed > 0 ? 1 : 0;
}

} // namespace touchstone
