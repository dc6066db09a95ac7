#pragma once
// A model with as few triangles as an angle between facets allows, and how far its surface then is from what
// it was.

#include "engine/math/similarity.h"
#include "engine/scene/scene.h"

#include <cstddef>

namespace touchstone::study {

struct ReducedModel {
    ScenePtr scene;               ///< the static pose; materials as before
    size_t before = 0, after = 0; ///< triangles
    size_t edgesBeyond = 0;       ///< smooth edges of the result whose angle is larger than was asked for
    double angleBefore = 0.0, angle = 0.0; ///< degrees: nine smooth edges of ten are within it
    /// m, scene frame: distances between both surfaces, each measured from places on the other one.
    double largest = 0.0, mean = 0.0;
    size_t places = 0; ///< at which they were measured
};

/// The fewest triangles, of levels of 0.71 of the one before (meshoptimizer), whose smooth edges are within
/// `degrees` in nine cases of ten, as PerceptualCheck counts them. Deterministic. Throws Error where the
/// model has no triangles, or is itself beyond the angle.
[[nodiscard]] ReducedModel reducedTo(const Scene& scene, const Similarity& workspaceFromScene,
                                     double degrees);

} // namespace touchstone::study
