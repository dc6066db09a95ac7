#pragma once
// The compiled scene of a ScenePart.

#include "engine/scene/scene_part.h"
#include "haptics/scene/haptic_scene.h"

#include <memory>

namespace touchstone {

/// What an object stores for the effects of its material.
[[nodiscard]] ObjectUse meshUse(const HapticMaterialData& material, bool oneSided);

/// The part of `whole` that is felt; `source` is what `whole` was compiled from. An object keeps its number
/// in HapticScene::objects: a hidden one, or one of which the plane leaves nothing, has no triangles, and no
/// query meets it. An object that the plane crosses is cut into a mesh with an open edge and built like any
/// other mesh, so that a tick knows no plane; an object on one side of it is shared. One that is felt as a
/// distance field stays one, filled, with a face where it is cut (CutField). A whole part: a copy. Not for
/// the servo thread: a cut object takes as long as compiling it. Throws Error, and Cancelled.
[[nodiscard]] std::shared_ptr<HapticScene> partOf(const HapticScene& whole, const Scene& source,
                                                  const ScenePart& part, const Progress& progress = {});

} // namespace touchstone
