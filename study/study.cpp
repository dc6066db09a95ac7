#include "study/study.h"

#include "haptics/scene/built_for.h"
#include "study/ablation/ablation.h"
#include "study/errors/compare.h"
#include "study/errors/feel.h"
#include "study/pareto.h"
#include "study/timing/clock_cost.h"
#include "study/timing/configurations.h"
#include "study/timing/step_figures.h"

#include <algorithm>
#include <future>
#include <iterator>
#include <map>

namespace touchstone::study {

namespace {

constexpr double kTick = 1e-3; // s
/// As kUntextured of the ablations, and Coulomb's ablation of friction.
constexpr double kStiffness = 600.0, kSliding = 0.3; // N/m, 1

/// Effective settings: equal ones are measured once.
struct Measurement {
    HapticSettings settings; ///< in effect
    FeltPath felt;
    ConfigurationTimes times;
};

/// A configuration of the plan and its measurement.
struct Entry {
    PlannedConfiguration configuration;
    size_t measured = 0;
    Truth truth = Truth::Oracle;
};

/// State of the study of one subject.
class Run {
  public:
    Run(const Subject& subject, const StudyOptions& options, const StudyProgress& progress)
        : subject_(subject), options_(options), progress_(progress), bare_(subject.bench) {
        bare_.haptic = bareScene(subject.bench.haptic);
        for (size_t i = 0; i < options.errorTicks; ++i)
            hips_.push_back(subject.hand(kTick * static_cast<double>(i)));
    }

    void plan(bool tessellation, std::vector<std::string>& notes) {
        for (const Ablation& ablation : ablations()) {
            const bool wanted =
                options_.ablations.empty() || std::find(options_.ablations.begin(), options_.ablations.end(),
                                                        ablation.name) != options_.ablations.end();
            if (!wanted || (ablation.name == "tessellation") != tessellation)
                continue;
            for (PlannedConfiguration& configuration : planAblation(ablation, *bare_.haptic, notes)) {
                const size_t at = measurementOf(configuration.settings);
                entries_.push_back({std::move(configuration), at, truthOf(ablation)});
            }
        }
    }

    void feelAll() {
        findRests();
        for (size_t i = 0; i < measurements_.size(); ++i) {
            progress_("errors",
                      0.3 + 0.2 * static_cast<double>(i) / static_cast<double>(measurements_.size()));
            Measurement& c = measurements_[i];
            c.felt = feel(*bare_.haptic, c.settings, hips_);
        }
    }

    void time() {
        std::vector<TimedConfiguration> configurations;
        for (const Measurement& c : measurements_)
            configurations.push_back({subject_.bench.name, &bare_, c.settings, subject_.speed});
        const BenchPlan plan{.rounds = options_.rounds,
                             .ticksPerRound = options_.ticksPerRound,
                             .stages = true,
                             .ahead = static_cast<uint64_t>(options_.ticksPerRound) / 2 + 1};
        std::vector<ConfigurationTimes> times = timeConfigurations(
            configurations, plan, [&](double share) { progress_("timing", 0.5 + 0.5 * share); });
        for (size_t i = 0; i < times.size(); ++i)
            measurements_[i].times = std::move(times[i]);
    }

    void report(std::vector<ConfigurationResult>& results) {
        const double clock = static_cast<double>(clockCostNs());
        for (const Entry& entry : entries_)
            results.push_back(resultOf(entry, clock));
    }

  private:
    /// The scene without whatever varies the spring constant over the surface.
    static std::shared_ptr<const HapticScene> bareScene(const std::shared_ptr<const HapticScene>& scene) {
        std::shared_ptr<HapticScene> bare;
        for (const PlannedEffect& effect : scene->plan.effects)
            if (effect.on &&
                (effect.effect == Effect::VaryingStiffness || effect.effect == Effect::Damping ||
                 effect.effect == Effect::Friction || effect.effect == Effect::ViscousFriction)) {
                if (bare == nullptr)
                    bare = copyOf(*scene);
                removeEffect(*bare, effect.material, effect.effect);
            }
        if (bare == nullptr)
            return scene;
        return bare;
    }

    [[nodiscard]] Truth truthOf(const Ablation& ablation) const {
        if (ablation.against == Against::Coulomb)
            return Truth::Coulomb;
        if (ablation.against == Against::Exact ||
            (ablation.against == Against::Smooth && subject_.smooth == nullptr) ||
            (ablation.against == Against::Bump && !subject_.bump))
            return Truth::Reference;
        return subject_.smooth != nullptr ? Truth::Analytic : Truth::Oracle;
    }

    size_t measurementOf(const HapticSettings& settings) {
        const HapticSettings felt = inEffect(settings, *bare_.haptic);
        buildFor(*bare_.haptic, felt);
        for (size_t i = 0; i < measurements_.size(); ++i)
            if (measurements_[i].settings == felt)
                return i;
        measurements_.emplace_back().settings = felt;
        return measurements_.size() - 1;
    }

    /// One path of solve results for each radius; the oracle's run in parallel.
    void findRests() {
        std::map<double, std::future<truth::RestPath>> pending;
        const int frame = bare_.haptic->objects.size() > 1 ? feel(*bare_.haptic, {}, hips_).object : 0;
        for (const Entry& entry : entries_) {
            const double radius = feltRadius(entry.configuration.settings);
            const bool rests = entry.truth == Truth::Analytic || entry.truth == Truth::Oracle;
            if (!rests || pending.contains(radius))
                continue;
            pending[radius] = std::async(std::launch::async, [this, radius, frame] {
                return subject_.smooth != nullptr
                           ? truth::smoothPath(*subject_.smooth, hips_, radius)
                           : truth::oraclePath(*bare_.haptic, frame, hips_, radius, options_.oracleWork);
            });
        }
        size_t done = 0;
        for (auto& [radius, rests] : pending) {
            progress_("truth", 0.3 * static_cast<double>(done++) / static_cast<double>(pending.size()));
            rests_[radius] = rests.get();
        }
        compareTheSameTicks();
    }

    /// Where the oracle failed for one radius, the others are not compared either: the configurations of one
    /// ablation share the same ticks.
    void compareTheSameTicks() {
        for (const auto& [one, from] : rests_)
            for (auto& [other, to] : rests_)
                for (size_t i = 0; i < from.failed.size(); ++i)
                    if (from.failed[i])
                        to.failed[i] = true;
    }

    std::vector<truth::FeltTick> truthFor(const Entry& entry) {
        const Against against = entry.configuration.ablation->against;
        if (against == Against::Coulomb)
            return truth::springForces(restsOf(referenceFor(entry.configuration.exact)), hips_, kStiffness,
                                       kSliding);
        if (entry.truth == Truth::Reference)
            return referenceFor(entry.configuration.exact);
        const double radius = feltRadius(entry.configuration.settings);
        if (against == Against::Bump)
            return truth::reliefForces(rests_.at(radius), hips_, radius, kStiffness, subject_.bump);
        return truth::springForces(rests_.at(radius), hips_, kStiffness, 0.0);
    }

    /// The frictionless result as solve results.
    static truth::RestPath restsOf(const std::vector<truth::FeltTick>& felt) {
        truth::RestPath path;
        for (const truth::FeltTick& tick : felt) {
            path.proxies.push_back(tick.proxy);
            const double force = glm::length(tick.force);
            path.normals.push_back(tick.contact && force > 0.0 ? tick.force / force : glm::dvec3(0.0));
            path.failed.push_back(false);
        }
        return path;
    }

    const std::vector<truth::FeltTick>& referenceFor(const HapticSettings& settings) {
        const HapticSettings exact = inEffect(settings, *bare_.haptic);
        for (const auto& [known, ticks] : references_)
            if (known == exact)
                return ticks;
        references_.emplace_back(exact, feel(*bare_.haptic, exact, hips_).ticks);
        return references_.back().second;
    }

    ConfigurationResult resultOf(const Entry& entry, double clock) {
        const Measurement& c = measurements_[entry.measured];
        ConfigurationResult result;
        result.scene = subject_.bench.name;
        result.shape = subject_.shape;
        result.triangles = subject_.bench.triangles();
        result.facetAngle = subject_.smooth != nullptr ? c.felt.facetAngle : 0.0;
        result.path = subject_.path;
        result.ablation = entry.configuration.ablation->name;
        result.configuration = entry.configuration.name;
        result.settings = entry.configuration.text;
        result.rateHz = 1.0 / kTick;
        result.truth = entry.truth;
        result.isDefault = entry.configuration.isDefault;
        result.errors = compareWithTruth(hips_, truthFor(entry), c.felt.ticks);
        addTimes(c.times, clock, result);
        return result;
    }

    static void addTimes(const ConfigurationTimes& times, double clock, ConfigurationResult& result) {
        const StepFigures figures = figuresOf(times.rounds, clock);
        result.step = figures.median;
        result.stepMean = figures.mean;
        result.stages = figures.stages;
        if (times.step.empty())
            return;
        result.stepP99 = times.p99() - clock;
        result.rayFloor = times.rayMedian() - clock;
    }

    const Subject& subject_;
    const StudyOptions& options_;
    const StudyProgress& progress_;
    BenchScene bare_;
    std::vector<glm::dvec3> hips_;
    std::vector<Entry> entries_;
    std::vector<Measurement> measurements_;
    std::map<double, truth::RestPath> rests_; ///< by radius
    std::vector<std::pair<HapticSettings, std::vector<truth::FeltTick>>> references_;
};

void studyAblations(const Subject& subject, const StudyOptions& options, bool tessellation,
                    StudyResult& result, const StudyProgress& progress) {
    Run run(subject, options, progress);
    std::vector<std::string> notes = subject.notes;
    run.plan(tessellation, notes);
    for (const std::string& note : notes)
        result.notes.push_back(subject.bench.name + ": " + note);
    run.feelAll();
    run.time();
    std::vector<ConfigurationResult> configurations;
    run.report(configurations);
    markPareto(configurations);
    uint64_t failed = 0;
    for (const ConfigurationResult& configuration : configurations)
        failed = std::max(failed, configuration.errors.truthFailed);
    if (failed > 0)
        result.notes.push_back(subject.bench.name + ": the oracle found no rest in " +
                               std::to_string(failed) + " ticks, which are not compared");
    if (!configurations.empty() && std::all_of(configurations.begin(), configurations.end(),
                                               [](const ConfigurationResult& configuration) {
                                                   return configuration.errors.compared == 0;
                                               }))
        result.problems.push_back(subject.bench.name + (failed > 0
                                                            ? ": nothing could be compared with the oracle"
                                                            : ": the stroke touched nothing"));
    std::move(configurations.begin(), configurations.end(), std::back_inserter(result.configurations));
}

} // namespace

void studySubject(const Subject& subject, const StudyOptions& options, StudyResult& result,
                  const StudyProgress& progress) {
    studyAblations(subject, options, false, result, progress);
}

void studyTessellation(const ShapeKind& kind, const StudyOptions& options, StudyResult& result,
                       const StudyProgress& progress) {
    constexpr size_t kCoarsest = 512;
    size_t scenes = 0, done = 0;
    for (size_t n = kCoarsest; n <= options.largestTriangles; n *= 2)
        ++scenes;
    for (size_t n = kCoarsest; n <= options.largestTriangles; n *= 2) {
        const auto share = [&](const std::string& what, double fraction) {
            progress(what, (static_cast<double>(done) + fraction) / static_cast<double>(scenes));
        };
        const Subject subject = kind.make(n);
        studyAblations(subject, options, true, result, share);
        ++done;
    }
}

} // namespace touchstone::study
