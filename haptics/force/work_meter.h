#pragma once
// The work that forces do on the hand, J: positive is given to the hand, negative taken from it.

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// Accumulates the work of one stream of forces over the places where each was felt. A device holds a force
/// until the next tick, so its work is the last force times the displacement since (`given`). The law's own
/// part of it is the trapezium rule over the same displacement (`law`); the rest is due to sampling: k |dx|²
/// / 2 in each tick for a spring of stiffness k that the hand moves along, 5 mJ a metre at 1000 N/m, 1 kHz
/// and 0.01 m/s. One thread.
class WorkMeter {
  public:
    /// Adds the force (N) that this tick sends, and the hand's position in it (m).
    void add(const glm::dvec3& force, const glm::dvec3& hand) noexcept {
        if (begun_) {
            const glm::dvec3 way = hand - hand_;
            given_ += glm::dot(force_, way);
            law_ += 0.5 * glm::dot(force_ + force, way);
            wall_ += 0.5 * glm::dot(way, way);
        }
        begun_ = true;
        force_ = force;
        hand_ = hand;
    }

    /// Marks the motion since the last tick as unknown: the displacement to the next one does no work.
    void gap() noexcept {
        gaps_ += begun_ ? 1 : 0;
        begun_ = false;
    }

    [[nodiscard]] double given() const noexcept { return given_; } ///< J
    [[nodiscard]] double law() const noexcept { return law_; }     ///< J, the integral of F dx
    /// Sum of |dx|² / 2, m²: times a stiffness, the most energy that sampling adds on a spring.
    [[nodiscard]] double samplingBound() const noexcept { return wall_; }
    [[nodiscard]] uint64_t gaps() const noexcept { return gaps_; } ///< displacements left out

  private:
    bool begun_ = false;
    uint64_t gaps_ = 0;
    glm::dvec3 force_{0.0}, hand_{0.0};
    double given_ = 0.0, law_ = 0.0, wall_ = 0.0;
};

} // namespace touchstone
