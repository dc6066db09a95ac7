#pragma once

#include "engine/import/geometry/gltf_nodes.h"

#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// Node animations: times finite, not negative and strictly increasing, values finite and as many as the
/// interpolation needs, rotations of unit length, weights of meshes that have morph targets. Unknown paths
/// are left out with a warning.
[[nodiscard]] std::vector<Animation> readAnimations(ImportContext& context, const GltfDocument& document,
                                                    const NodeForest& forest, const std::vector<Node>& nodes);

/// `wanted` (LoadOptions::animation) as an index into `animations`: the first of that name, else the number;
/// -1 where it is empty. Throws Error, which names the animations, where there is none.
[[nodiscard]] int chosenAnimation(const ImportContext& context, const std::vector<Animation>& animations,
                                  const std::optional<std::string>& wanted);

} // namespace touchstone
