#pragma once
// Rate of change of the force, split into pressing and dragging (docs/sound.md). Only the force is rendered:
// no texture lookup, no synthetic sound.

#include "sound/sound_tick.h"

#include <glm/glm.hpp>

namespace touchstone {

/// N/s of one tick.
struct ForceRates {
    float press = 0.0f; ///< along the mean force
    float drag = 0.0f;  ///< perpendicular to it, along the stroke; fades out for a hand at rest
};

/// Any one thread; no allocation.
class ForceChange {
  public:
    /// Hz: slower changes come from the motion of the hand, not from the surface, and are filtered out.
    static constexpr double kLowest = 20.0;
    /// s: time constant of the mean force and of the direction of the stroke.
    static constexpr double kMeanTime = 0.05;
    /// m/s: the speed of the stroke at which the dragging part is halved.
    static constexpr double kSlow = 0.005;
    /// N: a mean force not well above it has no direction.
    static constexpr double kFaint = 1e-4;
    /// N s: a weaker impact is what bodies that rest do to each other from tick to tick.
    static constexpr double kResting = 2e-4;

    [[nodiscard]] ForceRates add(const SoundTick& tick) noexcept;
    /// Discards the history.
    void reset() noexcept { *this = ForceChange{}; }

  private:
    glm::dvec3 highPass(const glm::dvec3& force, double dt) noexcept;

    bool begun_ = false, handKnown_ = false;
    glm::dvec3 position_{0.0}, meanForce_{0.0}, meanVelocity_{0.0};
    glm::dvec3 band_{0.0}, low_{0.0}; // of the high-pass
    glm::dvec3 quick_{0.0};           // force above kLowest, of the previous tick
    double meeting_ = 0.0;            // N, of bodies in the previous tick
    double filterDt_ = 0.0, filterGain_ = 0.0, meanShare_ = 0.0;
};

} // namespace touchstone
