#pragma once
// A stroke on a scene that moves: the hand is carried by the part that it strokes.

#include "devices/stroke/stroke_library.h"
#include "devices/surface/triangle_source.h"
#include "engine/math/similarity.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// Instances that move as one while the scene's animation plays, with what a hand that rides on them has to
/// keep out of. Device frame, where everything is in the static pose.
struct MovingPart {
    std::vector<bool> instances;              ///< by Scene::instances: belongs to it
    std::shared_ptr<const PartMotion> motion; ///< null: it rests
    /// What every other part sweeps over in a whole round of the animation, seen from this part: a box each.
    std::vector<Bounds> keepOut;
};

/// At most eight parts, in the order in which a stroke is tried on them: the one at the place that was asked
/// for, then those that show most of themselves to `request.front`. Empty where nothing moves.
[[nodiscard]] std::vector<MovingPart> movingParts(const Scene& scene, const Similarity& deviceFromScene,
                                                  const StrokeRequest& request);

/// Those of `triangles` that belong to the part, which outlives the source.
[[nodiscard]] TriangleSource trianglesOf(TriangleSource triangles, const MovingPart& part);

} // namespace touchstone
