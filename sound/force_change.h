#pragma once
// How fast the force changes, taken apart into pressing and dragging (docs/sound.md). No texture is looked up
// and nothing is made up: what is not in the force is not heard.

#include "sound/sound_tick.h"

#include <glm/glm.hpp>

namespace touchstone {

/// N/s of one tick.
struct ForceRates {
    float press = 0.0f; ///< along the force as it is in the mean
    float drag = 0.0f;  ///< across it, along the stroke; fades out where the hand stands still
};

/// Any one thread; no allocation.
class ForceChange {
  public:
    /// Hz: slower changes are the hand's own pressing and moving, not the surface, and not to be heard.
    static constexpr double kLowest = 20.0;
    /// s: what the mean force and the direction of the stroke are means over.
    static constexpr double kMeanTime = 0.05;
    /// m/s: at this speed of the stroke half of the dragging part is heard.
    static constexpr double kSlow = 0.005;
    /// N: the direction of a mean force that is not well above it is none.
    static constexpr double kFaint = 1e-4;

    [[nodiscard]] ForceRates add(const SoundTick& tick) noexcept;
    /// As if nothing had been felt before.
    void reset() noexcept { *this = ForceChange{}; }

  private:
    glm::dvec3 highPass(const glm::dvec3& force, double dt) noexcept;

    bool begun_ = false, handKnown_ = false;
    glm::dvec3 position_{0.0}, meanForce_{0.0}, meanVelocity_{0.0};
    glm::dvec3 band_{0.0}, low_{0.0}; // of the high-pass
    glm::dvec3 quick_{0.0};           // force above kLowest, of the tick before
    double filterDt_ = 0.0, filterGain_ = 0.0, meanShare_ = 0.0;
};

} // namespace touchstone
