#pragma once

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/field_cache.h"

#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// Adds an object whose geometry is `shape` (in an object frame whose unit is about its size) with one of the
/// scene's materials, of which force shading, stiffness, damping and friction apply; maps need a mesh's
/// coordinates. `sides` is not read: a shape has both. Returns its index in HapticScene::objects. Before
/// neighbourhoods are built and the scene is handed to a servo. Throws Error.
int addShape(HapticScene& scene, std::string name, std::shared_ptr<const Shape> shape, int material,
             const Similarity& workspaceFromObject);

/// `object` with `shape` in place of its geometry, in the same frame.
[[nodiscard]] std::shared_ptr<HapticObject> withShape(const HapticObject& object,
                                                      std::shared_ptr<const Shape> shape);

/// m, workspace: how far from its surface a field tells distances. Inside 1.5 times as deep as the greatest
/// force of the default limits pushes; outside the largest ball (the panel's largest proxy radius, and what
/// counts as near a model) with the same room.
struct FieldDepths {
    double inside = 0.0, outside = 0.0;
};
[[nodiscard]] FieldDepths fieldDepths();

/// Where fieldObject looks for fields of earlier runs and keeps its own; none until this is called. Main
/// thread, before the first scene is compiled.
void keepFieldsIn(const FieldCache& cache);

/// The object of a mesh that is felt as its distance field (`use.implicit`): voxels of use.voxelSize, or a
/// 128th of the longest side where none is stated or where it would need too many cells, with a warning; as
/// deep as fieldDepths(). Not for the servo thread. Throws Error, which names the mesh, and Cancelled.
[[nodiscard]] std::shared_ptr<const HapticObject> fieldObject(const HapticObject& mesh,
                                                              const Similarity& workspaceFromScene,
                                                              const ObjectUse& use, const Progress& progress,
                                                              std::vector<Warning>& warnings);

/// Of Scene::instances, in order: those that are felt as the shell of an open mesh. A clipping plane leaves a
/// face on other fields (isFilled), on these the rim of the shell.
[[nodiscard]] std::vector<int> shellsOf(const HapticScene& scene);

/// The object of a scene's volume (Scene::volume): the field of distances from the surface where its values
/// are Scene::iso, as deep as above and at most kDeepestVoxels. Not for the servo thread. Throws Error and
/// Cancelled.
[[nodiscard]] std::shared_ptr<const HapticObject> volumeObject(const Scene& scene, int instance,
                                                               const Similarity& workspaceFromScene,
                                                               const Progress& progress,
                                                               std::vector<Warning>& warnings);

} // namespace touchstone
