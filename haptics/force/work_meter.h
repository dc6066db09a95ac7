#pragma once
// The work that forces do on the hand, in joules: positive is given to the hand, negative taken from it.

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

/// Adds up one stream of forces over the places where each was felt. A device holds a force until the next
/// tick, so what it does is the last force times the way since (`given`). The law's own part of that is the
/// trapezium rule over the same way (`law`); the rest is what sampling gives: k |dx|² / 2 in each tick for a
/// spring of stiffness k that the hand moves along, 5 mJ a metre at 1000 N/m, 1 kHz and 0.01 m/s. One thread.
class WorkMeter {
  public:
    /// The force (N) that this tick sends, and where the hand was in it (m).
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

    /// What happened since the last tick is not known: the way to the next one counts for nothing.
    void gap() noexcept {
        gaps_ += begun_ ? 1 : 0;
        begun_ = false;
    }

    [[nodiscard]] double given() const noexcept { return given_; } ///< J
    [[nodiscard]] double law() const noexcept { return law_; }     ///< J, the integral of F dx
    /// Sum of |dx|² / 2, m²: times a stiffness, the most that sampling gives on a spring.
    [[nodiscard]] double samplingBound() const noexcept { return wall_; }
    [[nodiscard]] uint64_t gaps() const noexcept { return gaps_; } ///< ways that count for nothing

  private:
    bool begun_ = false;
    uint64_t gaps_ = 0;
    glm::dvec3 force_{0.0}, hand_{0.0};
    double given_ = 0.0, law_ = 0.0, wall_ = 0.0;
};

} // namespace touchstone
