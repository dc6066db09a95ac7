#pragma once

#include "engine/import/geometry/gltf_nodes.h"

#include <vector>

namespace touchstone {

/// Node animations: times finite, not negative and strictly increasing, values finite and as many as the
/// interpolation needs, rotations of unit length. Morph weights and unknown paths are left out with a
/// warning.
[[nodiscard]] std::vector<Animation> readAnimations(ImportContext& context, const GltfDocument& document,
                                                    const NodeForest& forest, const std::vector<Node>& nodes);

} // namespace touchstone
