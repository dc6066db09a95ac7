#pragma once
// Surfaces in closed form with the frictionless equilibrium of the virtual proxy's sphere, which a mesh of
// the shape approximates. Shares no code with haptics/.

#include "study/truth/brute_force.h"

#include <memory>

namespace touchstone::truth {

struct SmoothRest {
    LVec3 proxy{0.0L};  ///< the sphere's centre; the HIP itself without contact
    LVec3 normal{0.0L}; ///< unit, of the surface at the contact; zero without contact
    bool contact = false;
};

/// Lengths in m of the workspace; the frame of each shape is that of its mesh in assets/shapes.h.
class SmoothShape {
  public:
    virtual ~SmoothShape() = default;

    /// The equilibrium of a sphere of `radius` that was at `last`, free, and is pulled to `hip`: the local
    /// minimum of the distance continued from there, not a nearer one behind a crest. Exact to 1e-15 m;
    /// closed forms where they exist.
    [[nodiscard]] virtual SmoothRest rest(const LVec3& hip, long double radius, const LVec3& last) const = 0;
};

using SmoothShapePtr = std::shared_ptr<const SmoothShape>;

/// y = 0, free above.
[[nodiscard]] SmoothShapePtr smoothPlane();
/// Centred at the origin.
[[nodiscard]] SmoothShapePtr smoothSphere(double radius);
/// About the y axis, without ends.
[[nodiscard]] SmoothShapePtr smoothCylinder(double radius);
/// About the z axis: `ring` is the radius of the tube's centre line.
[[nodiscard]] SmoothShapePtr smoothTorus(double ring, double tube);
/// y = amplitude cos(2 pi x / length), free above. Newton's method: the foot of a perpendicular on a cosine
/// has no closed form.
[[nodiscard]] SmoothShapePtr smoothWaves(double amplitude, double length);
/// A ridge along the z axis: y = -|x| tan(slope), free above; `slope` in rad, below 45 degrees.
[[nodiscard]] SmoothShapePtr smoothWedge(double slope);

} // namespace touchstone::truth
