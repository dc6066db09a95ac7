#pragma once
// A surface that gives way under the hand [000]: the vertices near a contact follow it by a polynomial of
// their distance.

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

/// Numbers of a material. At distance r from its centre a dent of depth d lies d phi(r / radius) below the
/// surface, phi(s) = 1 + linear s + quadratic s^2 - (1 + linear + quadratic) s^3, limited to 0..1, 0 beyond
/// the radius. The start values are the smoothest cubic, 1 - 3 s^2 + 2 s^3.
struct LocalDeformation {
    double radius = 0.0; ///< model m; 0: the surface does not give way
    /// N/m, of the ground under the surface; NaN: as stiff as the contact.
    double stiffness = std::numeric_limits<double>::quiet_NaN();
    double linear = 0.0, quadratic = -3.0;
    double time = 0.0; ///< s, in which a dent that nothing presses falls to 1/e

    [[nodiscard]] bool on() const noexcept { return radius > 0.0; }
    /// phi. `s` >= 0.
    [[nodiscard]] double shape(double s) const noexcept {
        return s < 1.0 ? std::clamp(polynomial(s), 0.0, 1.0) : 0.0;
    }
    /// d phi / d s; 0 where phi is limited.
    [[nodiscard]] double slope(double s) const noexcept {
        if (!(s < 1.0) || polynomial(s) < 0.0 || polynomial(s) > 1.0)
            return 0.0;
        return linear + s * (2.0 * quadratic - 3.0 * (1.0 + linear + quadratic) * s);
    }

    bool operator==(const LocalDeformation&) const = default;

  private:
    [[nodiscard]] double polynomial(double s) const noexcept {
        return 1.0 + s * (linear + s * (quadratic - (1.0 + linear + quadratic) * s));
    }
};

} // namespace touchstone
