#pragma once
// Local deformation for the eye: meshes that give way under a hand.

#include "engine/scene/mesh_deformation.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/state/device_state.h"
#include "renderer/scene_renderer.h"

#include <span>
#include <vector>

namespace touchstone {

/// The vertices of object `object` (HapticScene::objects), an instance of a mesh of `scene`, lowered by the
/// dents in it: x - n d phi(|x - c| / R) for each, with the normals of the surface that this makes. Vertices
/// whose normals face away from a dent stay (surface/press_dents.h). False where none moved. Allocates where
/// `drawn` is of another size.
bool dentedVertices(const Scene& scene, const HapticScene& haptic, size_t object,
                    std::span<const Dents> hands, DrawnVertices& drawn);

/// Draws the dents of all hands, and the mesh at rest again when they are gone. Main thread. A mesh that
/// several nodes show, or that an animation deforms, is felt giving way but not drawn so.
class DentedMeshes {
  public:
    /// `renderer` shows `scene`, from which `haptic` was compiled.
    void show(const HandDents& dents, const Scene& scene, const HapticScene& haptic, SceneRenderer& renderer);

  private:
    std::vector<int> shown_; // meshes whose vertices are not those at rest
    DrawnVertices drawn_;
};

} // namespace touchstone
