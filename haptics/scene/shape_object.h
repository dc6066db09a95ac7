#pragma once

#include "haptics/scene/haptic_scene.h"

#include <memory>
#include <string>

namespace touchstone {

/// Adds an object whose geometry is `shape` (in an object frame whose unit is about its size) with one of the
/// scene's materials, of which force shading, stiffness, damping and friction apply; maps need a mesh's
/// coordinates. `sides` is not read: a shape has both. Returns its index in HapticScene::objects. Before
/// neighbourhoods are built and the scene is handed to a servo. Throws Error.
int addShape(HapticScene& scene, std::string name, std::shared_ptr<const Shape> shape, int material,
             const Similarity& workspaceFromObject);

} // namespace touchstone
