#pragma once
// An ideal observer of the study's curves and models: it knows both stimuli and is limited by the noise that
// published just noticeable differences of force and contact location imply, and by nothing else
// (docs/experiment.md).

#include "experiment/plan/study_plan.h"
#include "experiment/stimulus/model_stroke.h"
#include "experiment/stimulus/planar_stimulus.h"

#include <cstdint>
#include <vector>

namespace touchstone::experiment {

/// No value is fitted to [004].
struct ObserverNoise {
    /// Standard deviation of one look at a force, as a share of the normal force: the JND of 7 % at d' = 1 in
    /// a one-interval task (Pang, Tan and Durlach 1991, 2.5 to 10 N).
    double force = 0.07;
    /// m, of one look at the contact location: a shift of a point on the index finger of 0.17 mm is told left
    /// from right 75 % of the time (Loomis and Collins 1978), 0.17 mm / Phi^-1(0.75).
    double location = 0.17e-3 / 0.67448975;
    /// s, of one look: 5 to 30 mm at 25 to 160 mm/s, in the middle (Pang, Tan and Durlach 1991).
    double look = 0.19;
    /// s for which each stimulus is felt: ten minutes for 42 trials of two intervals [004 §5].
    double exposure = 600.0 / 42.0 / 2.0;
};

/// What the observer uses.
enum class Attention : uint8_t {
    Everything, ///< all three differences: ideal
    /// Where the display moves, the direction of the force is not used: [004 §7] concludes that people rely
    /// on the tactile sensation then. No number in it.
    TactileFirst
};

/// d' between comparison and reference in one interval, of a person whose noise is `acuity` times the
/// observer's and who presses with `stroke.force`: differences in white noise, so that d'^2 = exposure / look
/// (sum over channels of the difference's variance / variance of a look).
[[nodiscard]] double sensitivity(const Condition& condition, const StrokeDifference& difference, double force,
                                 double acuity, const ObserverNoise& noise = {},
                                 Attention attention = Attention::Everything);
/// Share of right answers in two intervals: Phi(d' / sqrt 2), with 1 % lapses.
[[nodiscard]] double shareRight(double dPrime);

/// The differences of a condition at every level, computed once each. One thread.
class DifferenceTable {
  public:
    explicit DifferenceTable(const Condition& condition, const Stroke& stroke = {});
    [[nodiscard]] const StrokeDifference& at(double level);
    [[nodiscard]] const Condition& condition() const { return condition_; }
    [[nodiscard]] size_t rendered() const { return rendered_; } ///< ticks of both stimuli

  private:
    const Condition& condition_;
    Stroke stroke_;
    ModelStore models_;
    std::vector<std::pair<long, StrokeDifference>> known_; // sorted by level
    size_t rendered_ = 0;
};

/// How people differ: logarithms are normal with these standard deviations. An assumption, for planning
/// alone.
struct PeopleSpread {
    double acuity = 0.3; ///< of the noise
    double force = 0.3;  ///< of how hard they press
};

struct SimulatedPerson {
    double acuity = 1.0, force = 0.49;
};
/// The person of a seed: the same on every machine.
[[nodiscard]] SimulatedPerson personOf(uint64_t seed, size_t person, const PeopleSpread& spread = {},
                                       const Stroke& stroke = {});

/// The level at which the observer is right in kStaircaseShare of the trials, between the condition's levels;
/// its ends where there is none between.
[[nodiscard]] double thresholdOf(DifferenceTable& table, const SimulatedPerson& person,
                                 const ObserverNoise& noise = {},
                                 Attention attention = Attention::Everything);

/// Uniform numbers of one stream of a seed, the same on every machine.
class Draw {
  public:
    explicit Draw(uint64_t seed) : state_(seed) {}
    [[nodiscard]] double uniform() noexcept; ///< [0, 1)
    [[nodiscard]] double normal() noexcept;  ///< standard normal (Box and Muller)

  private:
    uint64_t state_;
};

} // namespace touchstone::experiment
