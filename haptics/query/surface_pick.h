#pragma once

#include "engine/math/object_motion.h"

#include <glm/glm.hpp>

#include <optional>

namespace touchstone {

class HapticScene;

/// The first intersection of a line with a scene.
struct SurfacePick {
    glm::dvec3 point{0.0};  ///< workspace, m
    glm::dvec3 normal{0.0}; ///< unit, of the flat triangle, facing the line's origin
    int object = -1;        ///< HapticScene::objects
    int material = -1;      ///< of the Scene
};

/// The first surface from `from` along `direction` (workspace, unit), one-sided surfaces from their front
/// only. `motions`: the objects' poses, empty: at rest. Any thread.
[[nodiscard]] std::optional<SurfacePick> pickSurface(const HapticScene& scene, ObjectMotions motions,
                                                     const glm::dvec3& from,
                                                     const glm::dvec3& direction) noexcept;

} // namespace touchstone
