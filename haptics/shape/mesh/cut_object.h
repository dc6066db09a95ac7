#pragma once

#include "haptics/shape/mesh/haptic_object.h"

namespace touchstone {

/// As buildHapticObject, of an instance whose mesh is a part of `whole`: in the frame of the object of
/// `whole`, to the last bit, so that a place in the one is the same place in the other.
[[nodiscard]] std::unique_ptr<const HapticObject>
buildCutObject(const Scene& scene, int instance, const Mesh& whole, const Similarity& workspaceFromScene,
               const ObjectUse& use, const Progress& progress = {});

} // namespace touchstone
