#pragma once

#include "haptics/haptic_scene.h"
#include "haptics/object_motion.h"
#include "haptics/proxy/mesh_proxy.h"

#include <glm/glm.hpp>

namespace touchstone {

/// The object whose bounding sphere is nearest to `hip` (workspace); the first anchor.
[[nodiscard]] int nearestObject(const HapticScene& scene, ObjectMotions motions,
                                const glm::dvec3& hip) noexcept;

/// True where `hip` (workspace) is inside a closed object.
[[nodiscard]] bool isInsideAny(const HapticScene& scene, ObjectMotions motions,
                               const glm::dvec3& hip) noexcept;

/// Starts touch: the proxy may be placed only in free space. False while the HIP is inside a closed object or
/// within the proxy's radius of a surface: it feels nothing until it has left (DESIGN §4). True from then on.
[[nodiscard]] bool placeProxy(const HapticScene& scene, ObjectMotions motions, const glm::dvec3& hip,
                              MeshProxy& proxy, DeviceState& state) noexcept;

} // namespace touchstone
