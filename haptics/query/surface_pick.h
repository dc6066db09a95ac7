#pragma once

#include "engine/math/object_motion.h"

#include <glm/glm.hpp>

#include <optional>

namespace touchstone {

class HapticScene;

/// Where a line first meets a scene.
struct SurfacePick {
    glm::dvec3 point{0.0};  ///< workspace, m
    glm::dvec3 normal{0.0}; ///< unit, of the flat triangle, against the line
    int object = -1;        ///< HapticScene::objects
    int material = -1;      ///< of the Scene
};

/// The surface that `from` sees along `direction` (workspace, unit), one-sided ones from their front only.
/// `motions`: the objects' poses, empty: at rest. Any thread.
[[nodiscard]] std::optional<SurfacePick> pickSurface(const HapticScene& scene, ObjectMotions motions,
                                                     const glm::dvec3& from,
                                                     const glm::dvec3& direction) noexcept;

} // namespace touchstone
