#pragma once
// Strokes with taps over our shapes: the same hand for the invariants and the oracle.

#include "assets/shapes.h"
#include "haptics/settings/haptic_settings.h"

#include <cmath>
#include <random>
#include <string>
#include <vector>

namespace touchstone::test {

struct StrokeCase {
    std::string name;
    assets::Shape shape;
    double tube;   ///< m, radius of the tube for a torus of ring 60 mm; 0: a body around the origin
    double reach;  ///< m, distance of the nominal surface from the centre or the ring
    double depth;  ///< m below the nominal surface
    double speed;  ///< m/s
    double radius; ///< m
    int ticks;
    int oracleTicks; ///< of which the oracle, which is slow, checks the first
};

/// The bare solve: no shading and no friction move the proxy off its rest.
inline HapticSettings strokeSettings(const StrokeCase& c) {
    HapticSettings settings;
    settings.proxyRadius = c.radius;
    settings.forceShading = ShadingMode::Off;
    settings.friction = FrictionMode::Off;
    return settings;
}

inline std::vector<StrokeCase> strokeCases() {
    std::vector<StrokeCase> all;
    for (const double radius : {0.0, 0.5e-3})
        for (const double speed : {0.1, 1.0}) {
            all.push_back(
                {"sphere1800", assets::sphere(0.05, 30, 30), 0.0, 0.05, 1e-3, speed, radius, 1500, 300});
            all.push_back(
                {"box", assets::box({0.08, 0.09, 0.1}, 4), 0.0, 0.05, 8e-3, speed, radius, 1500, 300});
            all.push_back({"torus6480", assets::torus(0.06, 0.025, 72, 45), 0.025, 0.025, 1e-3, speed, radius,
                           800, 200});
            all.push_back({"torus64800", assets::torus(0.06, 0.025, 180, 180), 0.025, 0.025, 1e-3, speed,
                           radius, 120, 60});
        }
    return all;
}

/// A stroke with taps: the hand runs over the shape and lifts off now and then.
inline glm::dvec3 strokeHand(const StrokeCase& c, int tick) {
    const double a = tick * c.speed * 1e-3 / (c.tube > 0.0 ? 0.085 : c.reach);
    const double reach = c.reach - c.depth * (0.4 + 0.6 * std::cos(0.05 * tick));
    if (c.tube > 0.0) {
        const double v = 0.8 * a + 0.5;
        const double ring = 0.06 + reach * std::cos(v);
        return {ring * std::cos(a), ring * std::sin(a), reach * std::sin(v)};
    }
    const double tilt = 0.6 * std::sin(0.37 * a);
    return reach * glm::dvec3(std::cos(a) * std::cos(tilt), std::sin(a) * std::cos(tilt), std::sin(tilt));
}

/// What a device may do at its worst, over the torus of ring 60 mm and tube 25 mm: a stroke 1 mm deep, in
/// every tenth tick a jump by centimetres, now and then no number at all.
class RestlessHand {
  public:
    glm::dvec3 next() {
        const int i = tick_++;
        const double a = 2e-3 * i;
        glm::dvec3 hip(0.084 * std::cos(a), 0.084 * std::sin(a), 0.01 * std::sin(3 * a));
        if (i % 10 == 9)
            hip += glm::dvec3(noise_(random_), noise_(random_), noise_(random_));
        if (i % 501 == 500)
            hip.x = NAN;
        return hip;
    }

  private:
    std::mt19937 random_{5};
    std::normal_distribution<double> noise_{0.0, 0.02};
    int tick_ = 0;
};

} // namespace touchstone::test
