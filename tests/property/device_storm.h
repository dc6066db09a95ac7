#pragma once
// Everything that a device may say, and everything that it never should, through the whole step.

#include "engine/device_io/device_io.h"

#include <cstdint>
#include <random>
#include <string>

namespace touchstone::test {

/// A hand that feels its way over a model of `size` m, interrupted by all that goes wrong on a cable.
class StormyDevice {
  public:
    StormyDevice(uint64_t seed, double size) : random_(seed), size_(size) {}
    DeviceSample next();
    /// s: mostly near a tick, at times anything from a nanosecond to ten seconds.
    double nextDt();
    [[nodiscard]] bool chance(double share) { return unit_(random_) < share; }
    [[nodiscard]] double number() { return 2.0 * unit_(random_) - 1.0; } ///< -1..1
    [[nodiscard]] uint64_t integer() { return random_(); }

  private:
    [[nodiscard]] glm::dvec3 vector() { return {number(), number(), number()}; }
    [[nodiscard]] double strange();

    std::mt19937_64 random_;
    std::uniform_real_distribution<double> unit_{0.0, 1.0};
    double size_;
    glm::dvec3 place_{0.0}, velocity_{0.0};
};

struct StormFigures {
    uint64_t ticks = 0, contacts = 0, invalid = 0, faults = 0, limited = 0, forces = 0;
};

/// Ticks of the whole step on one of our scenes with settings that change now and then. Fails the running
/// test where an output is not finite, or a command is larger or steps more than the device's limits allow.
StormFigures storm(const std::string& sceneFile, uint64_t seed, uint64_t ticks);

} // namespace touchstone::test
