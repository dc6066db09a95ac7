#pragma once

#include "engine/import/geometry/gltf_nodes.h"

#include <vector>

namespace touchstone {

/// Node animations: times finite, not negative and strictly increasing, values finite and as many as the
/// interpolation needs, rotations of unit length, weights of meshes that have morph targets. Unknown paths
/// are left out with a warning.
[[nodiscard]] std::vector<Animation> readAnimations(ImportContext& context, const GltfDocument& document,
                                                    const NodeForest& forest, const std::vector<Node>& nodes);

/// LoadOptions::animation as an index into `animations`: the first of that name, else the number; -1 without
/// the option. Throws Error, which names the animations, where there is none.
[[nodiscard]] int chosenAnimation(const ImportContext& context, const std::vector<Animation>& animations);

} // namespace touchstone
