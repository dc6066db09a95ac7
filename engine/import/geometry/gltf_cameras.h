#pragma once

#include "engine/import/geometry/gltf_nodes.h"

#include <vector>

namespace touchstone {

/// The cameras that the shown nodes place, in the order of `nodes`. Every lens of the file is checked; a
/// broken one, and one whose node has no orientation (a scale of zero), is left out with a warning.
///
/// A rigid camera follows from its node as glTF's view matrix does, the inverse of the node's transform: the
/// scale of a node scales what its camera measures in metres (near and far plane, the frame of an
/// orthographic camera). Axes that shear makes oblique are made orthogonal, from the direction of sight
/// first; a mirroring is left out.
[[nodiscard]] std::vector<SceneCamera> readCameras(ImportContext& context, const GltfDocument& document,
                                                   const NodeForest& forest, const std::vector<Node>& nodes);

} // namespace touchstone
