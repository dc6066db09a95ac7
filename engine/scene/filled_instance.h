#pragma once

#include "engine/scene/scene.h"

namespace touchstone {

/// True for an instance that is felt as a distance field: a clipping plane leaves a flat face on it. A mesh
/// is open where it is cut.
[[nodiscard]] bool isFilled(const Scene& scene, const Instance& instance);

} // namespace touchstone
