// Google Benchmark cases by stage. Each tells its time in rays too: multiples of Embree's floor (one
// rtcIntersect1 from proxy to HIP on the same scene), measured in this process just before.
// tools/bench-compare compares two commits.
//
//   stage_bench --benchmark_filter=proxy --benchmark_repetitions=5

#include "engine/core/float_mode.h"
#include "haptics/force/spring_damper.h"
#include "haptics/proxy/proxy_solver.h"
#include "haptics/query/ray_floor.h"
#include "haptics/shading/force_shading.h"
#include "haptics/surface/surface_sample.h"
#include "haptics/tick/haptic_step.h"
#include "study/timing/bench_scene.h"

#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <functional>
#include <initializer_list>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::test {
namespace {

constexpr double kTick = 1e-3; // s
constexpr double kStep = 1e-4; // m a tick: 0.1 m/s
constexpr size_t kTriangles = 64'800;
constexpr size_t kPlaces = 2000;     // of a path, there and back
constexpr double kSteepest = 0.5236; // rad, tilt of an interpolated normal

using Assignments = std::initializer_list<std::pair<const char*, const char*>>;

/// Bare, then what is assigned.
HapticSettings settingsOf(Assignments assignments) {
    HapticSettings settings;
    settings.forceShading = ShadingMode::Off;
    settings.texture = TextureMode::Off;
    settings.friction = FrictionMode::Off;
    for (const auto& [name, value] : assignments)
        if (const std::string problem = setSetting(settings, name, value); !problem.empty())
            throw std::invalid_argument(std::string(name) + ": " + problem);
    return settings;
}

const BenchScene& torus() {
    static const BenchScene scene = [] {
        BenchScene made = torusScene(kTriangles);
        made.haptic->buildNeighbourhoods();
        return made;
    }();
    return scene;
}
const BenchScene& richTorus() {
    static const BenchScene scene = torusWithAllEffects(kTriangles);
    return scene;
}

/// A hand on a path that ends where it began, tick after tick.
class Hand {
  public:
    Hand(const BenchScene& scene, const HapticSettings& settings) : scene_(scene), settings_(settings) {
        for (double lift = 0.02; lift > 0.0; lift -= kStep)
            (void)stepTo(scene.stroke(0.0, lift));
        stroke(0.0);
    }

    /// There and back along the stroke, `lift` above its depth.
    void stroke(double lift) {
        path_.clear();
        for (size_t i = 0; i < 2 * kPlaces; ++i)
            path_.push_back(scene_.stroke(kStep * static_cast<double>(std::min(i, 2 * kPlaces - i)), lift));
    }
    /// To and fro between two places, `from` and `to` metres of the stroke.
    void alternate(double from, double to) {
        path_ = {scene_.stroke(from, 0.0), scene_.stroke(to, 0.0)};
        while (at_ < from) // not in one leap
            (void)stepTo(scene_.stroke(at_ += kStep, 0.0));
    }
    /// Metres of the stroke at which the proxy has just come to another triangle.
    double nextEdge() {
        (void)stepTo(scene_.stroke(at_ += kStep, 0.0));
        const int last = output.triangle;
        while (output.triangle == last)
            (void)stepTo(scene_.stroke(at_ += kStep, 0.0));
        return at_;
    }
    [[nodiscard]] const glm::dvec3& next() { return path_[place_ = (place_ + 1) % path_.size()]; }
    const HapticOutput& tick() { return stepTo(next()); }
    [[nodiscard]] size_t places() const { return path_.size(); }

    const HapticOutput& stepTo(const glm::dvec3& hip) {
        DeviceSample sample;
        sample.position = hip;
        sample.valid = true;
        TickInput input;
        input.tick = ticks_++;
        input.time = kTick * static_cast<double>(input.tick);
        input.dt = kTick;
        input.hands = {&sample, 1};
        NoStopwatch none;
        hapticStep(*scene_.haptic, settings_, input, world_, {&state, 1}, {&output, 1}, none);
        return output;
    }

    DeviceState state;
    HapticOutput output;
    [[nodiscard]] const HapticScene& scene() const { return *scene_.haptic; }
    [[nodiscard]] ObjectMotions motions() const { return scene_.haptic->restMotions; }
    [[nodiscard]] Similarity workspaceFromReference() const {
        return motions()[static_cast<size_t>(state.reference)].workspaceFromObject;
    }
    [[nodiscard]] const HapticSettings& settings() const { return settings_; }

  private:
    const BenchScene& scene_;
    HapticSettings settings_;
    WorldState world_;
    std::vector<glm::dvec3> path_;
    size_t place_ = 0;
    uint64_t ticks_ = 0;
    double at_ = 0.0;
};

/// From where to where rays go, and what the surface is like there.
struct Touched {
    glm::dvec3 proxy, hip;
    SolveResult rest;
    glm::dvec3 normal;
    double depth;
};
std::vector<Touched> touches(Hand& hand, size_t count = 256) {
    std::vector<Touched> all;
    for (size_t i = 0; i < 8 * count && all.size() < count; ++i)
        if (const HapticOutput& o = hand.tick(); o.contacts > 0)
            all.push_back(
                {o.proxy, o.hip, hand.state.rest,
                 glm::normalize(glm::conjugate(hand.workspaceFromReference().rotation) * (o.proxy - o.hip)),
                 o.penetration});
    if (all.size() < count)
        throw std::logic_error("the hand does not touch");
    return all;
}

/// s of this thread: what other programs take does not count.
double processorTime() {
    timespec now{};
    clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
    return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

/// s a ray, the median of 15 rounds on the torus: the floor of this process, now.
double rayFloor() {
    static const std::vector<Touched> rays = [] {
        Hand hand(torus(), settingsOf({}));
        return touches(hand);
    }();
    std::vector<double> rounds;
    float sum = 0.0f;
    for (int round = 0; round < 15; ++round) {
        const double begin = processorTime();
        for (const Touched& t : rays)
            sum += castFloorRay(*torus().haptic, 0, t.proxy, t.hip);
        rounds.push_back((processorTime() - begin) / static_cast<double>(rays.size()));
    }
    benchmark::DoNotOptimize(sum);
    std::nth_element(rounds.begin(), rounds.begin() + 7, rounds.end());
    return rounds[7];
}

/// Runs `body` as a case's loop and tells its time in rays.
void loop(benchmark::State& state, const auto& body) {
    const double floor = rayFloor(), begin = processorTime();
    for (auto _ : state) // NOLINT: this is how it is spelled
        body();
    state.counters["rays"] = (processorTime() - begin) / static_cast<double>(state.iterations()) / floor;
}

/// All of hapticStep; fails where the hand does not touch, for then it is another case that is measured.
void ticks(benchmark::State& state, Hand& hand, bool touching = true) {
    uint64_t contacts = 0, count = 0;
    loop(state, [&] {
        contacts += hand.tick().contacts > 0 ? 1 : 0;
        ++count;
    });
    if (touching ? 10 * contacts < 9 * count : contacts > 0)
        state.SkipWithError("the hand touches where it should not, or not where it should");
}

void addTicks(const std::string& name, const BenchScene& (*scene)(), Assignments assignments) {
    benchmark::RegisterBenchmark(name.c_str(),
                                 [scene, settings = settingsOf(assignments)](benchmark::State& state) {
                                     Hand hand(scene(), settings);
                                     ticks(state, hand);
                                 });
}

/// Stage 3 alone: the proxy goes to the next place of the path.
void solves(benchmark::State& state, Hand& hand) {
    for (size_t i = 0; i < hand.places(); ++i)
        (void)hand.tick(); // so that candidates and margin are those of this path
    const Similarity frame = hand.workspaceFromReference();
    uint64_t iterations = 0;
    loop(state, [&] {
        const glm::dvec3& hip = hand.next();
        hand.state.travel = hip - hand.state.hip;
        hand.state.hip = hip;
        ProxySolver proxy(hand.scene(), hand.motions(), hand.settings(), hand.state, hand.state.rest);
        proxy.moveTowards(frame.inversePoint(hip));
        iterations += hand.state.rest.iterations;
    });
    state.counters["moves"] =
        benchmark::Counter(static_cast<double>(iterations), benchmark::Counter::kAvgIterations);
}

void addSolves() {
    for (const char* radius : {"0", "0.0005"})
        for (const std::string kind : {"free", "facet", "edge"})
            benchmark::RegisterBenchmark(("proxy/" + kind + (radius[1] == '\0' ? "" : "_r0.5mm")).c_str(),
                                         [radius, kind](benchmark::State& state) {
                                             Hand hand(torus(), settingsOf({{"proxyRadius", radius}}));
                                             if (kind == "free") {
                                                 hand.stroke(0.004);
                                             } else {
                                                 // Facets are 2 to 3 mm long: 0.3 mm behind an edge is not
                                                 // yet the next one's.
                                                 const double edge = hand.nextEdge() - 0.5 * kStep;
                                                 const double middle = kind == "edge" ? edge : edge + 3e-4;
                                                 hand.alternate(middle - 0.7 * kStep, middle + 0.7 * kStep);
                                             }
                                             solves(state, hand);
                                         });
}

void addContact() {
    benchmark::RegisterBenchmark("ray_floor", [](benchmark::State& state) {
        Hand hand(torus(), settingsOf({}));
        const std::vector<Touched> rays = touches(hand);
        size_t at = 0;
        loop(state, [&] {
            const Touched& t = rays[at = (at + 1) % rays.size()];
            benchmark::DoNotOptimize(castFloorRay(hand.scene(), 0, t.proxy, t.hip));
        });
    });
    benchmark::RegisterBenchmark("contact/gather", [](benchmark::State& state) {
        Hand hand(torus(), settingsOf({}));
        const std::vector<Touched> places = touches(hand);
        const Similarity frame = hand.workspaceFromReference();
        size_t at = 0;
        hand.state.candidates.expect(glm::dvec3(0.0), 0.0); // these places follow no way
        loop(state, [&] {
            const Touched& t = places[at = (at + 1) % places.size()];
            benchmark::DoNotOptimize(hand.state.candidates.gather(
                hand.scene().objects, hand.motions(), hand.scene().boundingRadii, hand.state.reference,
                frame.inversePoint(t.proxy), hand.state.gatherMargin));
        });
        state.counters["triangles"] = static_cast<double>(hand.state.candidates.count());
    });
    benchmark::RegisterBenchmark("contact/query", [](benchmark::State& state) {
        Hand hand(torus(), settingsOf({}));
        (void)touches(hand);
        const glm::dvec3 place = hand.state.proxy;
        double least = INFINITY;
        loop(state, [&] {
            hand.state.candidates.moved();
            hand.state.candidates.eachNear(place, 1e-3, [&](size_t i) {
                least = std::min(least, hand.state.candidates.measure(i, place).distance);
            });
        });
        benchmark::DoNotOptimize(least);
        if (!(least < 1e-3))
            state.SkipWithError("nothing is near");
    });
}

void addSurface() {
    benchmark::RegisterBenchmark("shading/interpolated_normal", [](benchmark::State& state) {
        Hand hand(torus(), settingsOf({}));
        const std::vector<Touched> places = touches(hand);
        size_t at = 0;
        loop(state, [&] {
            const Touched& t = places[at = (at + 1) % places.size()];
            benchmark::DoNotOptimize(interpolatedNormal(hand.scene(), hand.motions(), hand.state.reference,
                                                        t.rest.contacts[0], kSteepest));
        });
    });
    for (const std::string law : {"law", "blinn", "minsky", "blinnMagnitude"})
        benchmark::RegisterBenchmark(("texture/" + law).c_str(), [law](benchmark::State& state) {
            const HapticSettings settings = settingsOf({{"texture", law.c_str()}});
            Hand hand(richTorus(), settings);
            const std::vector<Touched> places = touches(hand);
            size_t at = 0;
            loop(state, [&] {
                const Touched& t = places[at = (at + 1) % places.size()];
                benchmark::DoNotOptimize(readSurface(hand.scene(), hand.motions(), settings, DeviceLimits{},
                                                     hand.state.reference, t.rest.contacts[0], t.normal,
                                                     t.depth, kStep / kTick, kTick));
            });
        });
    benchmark::RegisterBenchmark("force", [](benchmark::State& state) {
        const HapticSettings settings = settingsOf({{"texture", "law"}});
        Hand hand(richTorus(), settings);
        std::vector<SurfaceSample> feels;
        for (const Touched& t : touches(hand))
            feels.push_back(readSurface(hand.scene(), hand.motions(), settings, DeviceLimits{},
                                        hand.state.reference, t.rest.contacts[0], t.normal, t.depth,
                                        kStep / kTick, kTick));
        size_t at = 0;
        loop(state, [&] {
            benchmark::DoNotOptimize(springDamperForce(feels[at = (at + 1) % feels.size()],
                                                       glm::dvec3(1e-5, 0, 0), glm::dvec3(0.0),
                                                       glm::dvec3(0.1, 0.01, 0)));
        });
    });
}

void addSafety() {
    for (const auto& [name, mode] :
         {std::pair{"safety/off", PassivityMode::Off}, std::pair{"safety/observe", PassivityMode::Observe},
          std::pair{"safety/control", PassivityMode::Control}})
        benchmark::RegisterBenchmark(name, [mode = mode](benchmark::State& state) {
            Hand hand(torus(), settingsOf({}));
            std::vector<std::pair<glm::dvec3, SafetyInputs>> inputs;
            for (const Touched& t : touches(hand)) {
                SafetyInputs in;
                in.inputValid = true;
                in.passivity = mode;
                in.position = t.hip;
                in.springLength = t.depth;
                inputs.emplace_back(600.0 * t.depth * t.normal, in);
            }
            ForceLimiterState limiter;
            uint32_t flags = 0;
            size_t at = 0;
            loop(state, [&] {
                const auto& [force, in] = inputs[at = (at + 1) % inputs.size()];
                benchmark::DoNotOptimize(ForceLimiter::limit(force, glm::dvec3(0.0), in, {}, limiter, flags));
            });
        });
}

void addWholeTicks() {
    benchmark::RegisterBenchmark("tick/free", [](benchmark::State& state) {
        Hand hand(torus(), settingsOf({}));
        hand.stroke(0.004);
        (void)hand.tick();
        ticks(state, hand, false);
    });
    addTicks("tick/sweep", torus, {});
    addTicks("tick/sweep_r0.5mm", torus, {{"proxyRadius", "0.0005"}});
    addTicks("tick/neighbourhood", torus, {{"contact", "neighbourhood"}});
    for (const char* mode : {"direction", "projected", "twoPass", "bezier", "singleRound"})
        addTicks(std::string("tick/shading_") + mode, torus, {{"forceShading", mode}});
    // On the material that asks for everything: what no setting switches off (maps of stiffness, damping)
    // stays.
    addTicks("tick/rich_bare", richTorus, {});
    for (const char* mode : {"law", "blinn", "minsky", "blinnMagnitude"})
        addTicks(std::string("tick/texture_") + mode, richTorus, {{"texture", mode}});
    for (const char* mode : {"zilles", "ho", "elastoplastic", "velocityThreshold"})
        addTicks(std::string("tick/friction_") + mode, richTorus, {{"friction", mode}});
    benchmark::RegisterBenchmark("tick/all_effects", [](benchmark::State& state) {
        Hand hand(richTorus(), HapticSettings{});
        ticks(state, hand);
    });
}

} // namespace
} // namespace touchstone::test

int main(int count, char** arguments) {
    using namespace touchstone::test;
    touchstone::enterFloatMode();
    addContact();
    addSolves();
    addSurface();
    addSafety();
    addWholeTicks();
    benchmark::Initialize(&count, arguments);
    if (benchmark::ReportUnrecognizedArguments(count, arguments))
        return 2;
    benchmark::RunSpecifiedBenchmarks();
    return 0;
}
