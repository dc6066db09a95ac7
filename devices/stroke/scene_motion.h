#pragma once
// A stroke on a moving scene: the hand moves with the part that it strokes.

#include "devices/stroke/deforming_part.h"
#include "devices/stroke/stroke_library.h"
#include "devices/surface/triangle_source.h"
#include "engine/math/similarity.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// Instances that move as one while the scene's animation plays, or one that deforms, with the space that a
/// hand moving with them must avoid. Device frame, in the static pose.
struct MovingPart {
    std::vector<bool> instances;                    ///< by Scene::instances: true for the part's instances
    std::shared_ptr<const PathMotion> motion;       ///< null: static, or deforming
    std::shared_ptr<const DeformingPart> deforming; ///< the part's only instance; null: it is rigid
    /// Boxes that cover what every other part sweeps over in one round of the animation, in this part's
    /// frame.
    std::vector<Bounds> keepOut;
};

/// At most eight parts, in the order in which a stroke is tried on them: the one at the given place, then by
/// visible area towards `request.front`. Empty where nothing moves. The scene outlives them.
[[nodiscard]] std::vector<MovingPart> movingParts(const Scene& scene, const Similarity& deviceFromScene,
                                                  const StrokeRequest& request);

/// The triangles of the part, which outlives the source.
[[nodiscard]] TriangleSource trianglesOf(TriangleSource triangles, const MovingPart& part);

} // namespace touchstone
