#pragma once
// What moves the vertices of an object.

#include "engine/scene/mesh_deformation.h"
#include "haptics/shape/mesh/haptic_object.h"

namespace touchstone {

/// Null where nothing does: of a shape, of a mesh without triangles, and of a part that a plane has left,
/// whose vertices are other ones than those of `source`.
[[nodiscard]] inline const MeshDeformation* deformationOf(const Scene& source, const HapticObject& object) {
    if (object.instance < 0 || object.shape != nullptr || object.indices.empty() || object.cut)
        return nullptr;
    const auto mesh = static_cast<size_t>(source.instances[static_cast<size_t>(object.instance)].mesh);
    return source.meshes[mesh].deformation.get();
}

} // namespace touchstone
