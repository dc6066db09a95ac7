// stable_region: the largest stable wall, measured through the whole haptic step, beside theory. Two tables
// on stdout, one block a servo rate, apart by two empty lines as gnuplot's `index` wants them.
// tools/figure_stable_region draws them.
//
// Blocks 0..3: rate, b of a bare device of 75 g, largest K measured, exact eigenvalue limit, 2 b / T.
// Blocks 4..7: rate, B of the wall, largest K at which a Phantom Premium 1.5 in a light grip comes to rest,
// the eigenvalue limit of the same without Coulomb friction and sensor steps.

#include "haptics/sample/hip_sample.h"
#include "tests/stability/closed_loop/loop_bench.h"
#include "tests/stability/closed_loop/sampled_loop.h"

#include <cmath>
#include <cstdio>

namespace {

using namespace touchstone;
using namespace touchstone::test;

constexpr double kBuzz = 1e-4; ///< m, three steps of the sensor
constexpr double kRates[]{500.0, 1000.0, 2000.0, 4000.0};

void bareDevices(double rate) {
    const double mass = PlantParameters{}.mass;
    for (double b = 0.05; b < 20.0; b *= 2.0) {
        const double exact = bareLimit(mass, b, 1.0 / rate, 0);
        const double measured = largestStable(0.7 * exact, 1.4 * exact, [&](double stiffness) {
            return pressedWallSettles(bareDevice(mass, b), plainWall(stiffness), rate, 12000);
        });
        std::printf("%g %g %.6g %.6g %.6g\n", rate, b, measured, exact, 2.0 * b * rate);
    }
}

void phantomInAGrip(double rate) {
    const PlantParameters phantom;
    const LinearLoop linear{.mass = phantom.mass,
                            .viscous = phantom.viscousFriction,
                            .handMass = phantom.handMass,
                            .handDamping = phantom.handDamping,
                            .handStiffness = phantom.handStiffness,
                            .period = 1.0 / rate,
                            .velocityCutoff = kVelocityCutoff};
    for (const double damping : {0.0, 1.0, 2.0, 4.0, 7.0, 10.0, 15.0, 20.0, 25.0, 30.0}) {
        // From below: beyond the first that fails, single ones may do.
        const auto upTo = [&](auto&& good) {
            double reached = 0.0;
            for (double stiffness = 200.0; stiffness < 1e5 && good(stiffness); stiffness *= 1.06)
                reached = stiffness;
            return reached;
        };
        const auto everyStart = [&](double stiffness, auto&& good) {
            for (const Start& start : kWallStarts)
                if (!good(meetWall(phantom, plainWall(stiffness, damping), rate, start, 2.0)))
                    return false;
            return true;
        };
        const double rests =
            upTo([&](double k) { return everyStart(k, [](const Aftermath& a) { return a.rests; }); });
        const double calm =
            upTo([&](double k) { return everyStart(k, [](const Aftermath& a) { return a.swing < kBuzz; }); });
        std::printf("%g %g %.6g %.6g %.6g\n", rate, damping, rests, calm, eigenvalueLimit(linear, damping));
    }
}

} // namespace

int main() {
    for (const double rate : kRates) {
        bareDevices(rate);
        std::printf("\n\n");
    }
    for (const double rate : kRates) {
        phantomInAGrip(rate);
        std::printf("\n\n");
    }
}
