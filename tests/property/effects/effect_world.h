#pragma once
// The bodies that are stroked, compiled with one- and two-sided materials, and the distance from each of
// their objects in long double.

#include "haptics/scene/haptic_scene.h"
#include "study/truth/soup.h"
#include "tests/property/effects/effect_case.h"

#include <memory>
#include <vector>

namespace touchstone::test {

using namespace truth;

/// All lengths in workspace metres.
struct EffectWorld {
    double bodyRadius = 0.0; ///< how deep a hand may go: of the sphere, the tube, half the box
    std::shared_ptr<const HapticScene> bothSides, frontOnly; ///< neighbourhoods and slopes are built
    std::unique_ptr<Soup> whole;                             ///< all objects at rest, frame of the first
    std::vector<std::unique_ptr<Soup>> soups;                ///< each object in its own frame

    static constexpr double kFarthestOff = 2e-3; ///< farther off the surface is measured as this
    struct Place {
        double nearest = INFINITY; ///< from the proxy's centre to any triangle
        double off = kFarthestOff; ///< what that and the radius differ by; with `oneSided` of a triangle that
                                   ///< the proxy is in front of, where they differ least
    };
    /// Of a proxy in the workspace, with the objects where `poses` has them. A point that lies on a triangle
    /// is on no side of it: not `oneSided`.
    [[nodiscard]] Place measure(const glm::dvec3& proxy, ObjectMotions poses, double radius,
                                bool oneSided) const;
};

/// Built once in a process; null for a model that is not there.
[[nodiscard]] const EffectWorld* effectWorld(EffectBody body);

} // namespace touchstone::test
