#pragma once
// What the tests of surface effects share: a plane with maps, and a watch over the force on it.
//
// What the law allows. With slope g = grad H, F is k d, k [(d - H) n + H m] or k d (n - g) long and wide:
// along a step s it changes by k s for the depth, by k d |change of g| for the turn of m (m(g) is
// 1-Lipschitz, and so is the compression), and by k |change of H| |m - n| for the height.

#include "tests/stability/trial.h"
#include "tests/support/test_shapes.h"

#include <gtest/gtest.h>

namespace touchstone::test {

inline constexpr double kPi = 3.141592653589793;
inline constexpr double kStiffness = 1000.0, kSide = 0.1; // N/m, m
inline constexpr TextureMode kConfigurations[] = {TextureMode::Law, TextureMode::Blinn, TextureMode::Minsky};

/// Shaded, without friction, kStiffness.
[[nodiscard]] HapticSettings felt(TextureMode mode, double radius = 0.0);

/// A plane of kSide with a height map of `scale` m.
[[nodiscard]] Scene reliefPlane(const Image& heights, double scale, int cells = 4);
/// Rises from black to white with u.
[[nodiscard]] Image slopeImage(int texels);
/// Black and white texels in turn.
[[nodiscard]] Image cliffImage(int texels);
/// What cliffImage says at (u, v), 0..1, bilinear and repeated: evaluated without any code of haptics/.
[[nodiscard]] double cliffValue(int texels, double u, double v);
/// (u, v) of a place on the plane.
[[nodiscard]] glm::dvec2 uvOn(const glm::dvec3& place);

/// Follows a hand: finite, no longer than k d (Minsky: its normal part), no steeper than the cap, and the
/// change in a tick against what `allowed` grants for the step.
struct Watch {
    explicit Watch(const TouchBench& on) : bench(on) {}

    const TouchBench& bench;
    double worst = 0.0, largest = 0.0; ///< change over allowed; N
    int ticks = 0, compressed = 0;
    bool first = true;
    HapticOutput last;

    void take(const HapticOutput& out, double allowed);
};

/// The largest change of the force while the hand stands still, N; the velocity's filter has come to rest.
[[nodiscard]] double held(TouchBench& bench);

} // namespace touchstone::test
