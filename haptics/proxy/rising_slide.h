#pragma once
// Slides over shapes that rise towards the hand: hollows, saddles, concave kinks.

#include "haptics/contact/candidates.h"
#include "haptics/shape/contact.h"
#include "haptics/solve/sub_goal.h"

#include <glm/glm.hpp>

#include <array>
#include <span>

namespace touchstone {

/// Ends of one slide that are lifted onto the surface.
inline constexpr size_t kMostLifts = 8;

/// A slide that something has stopped. Reference frame, object units.
struct StoppedSlide {
    glm::dvec3 start{0.0};
    glm::dvec3 goal{0.0};                    ///< of the solve
    std::span<const ConstraintPlane> planes; ///< at the start, relative to it
    glm::dvec3 move{0.0};                    ///< to the place nearest to the goal that the planes allow
    double share = 0.0;                      ///< of `move`, up to the hit
    double covered = 0.0;                    ///< how far the candidates cover `move`'s way from the start
    double radius = 0.0;                     ///< of the proxy
    double strikeGap = 0.0;                  ///< gap at which a sweep ends
    int lifts = 0;                           ///< at most, up to kMostLifts
};

/// What one slide leaves to the next one of the same tick: the features of the last kink.
struct SlideMemory {
    struct Feature {
        int object = -1; ///< -1: none
        FeatureId feature = 0;
    };
    static constexpr size_t kFeatures = 2;
    std::array<Feature, kFeatures> features;

    void add(const Contact& contact) noexcept {
        if (contact.candidate != Contact::kNoCandidate ||
            (features[0].object == contact.object && features[0].feature == contact.feature))
            return;
        features[1] = features[0];
        features[0] = {contact.object, contact.feature};
    }
};

struct SlideUp {
    glm::dvec3 displacement{0.0};
    int lifts = 0; ///< that were made
};

/// The displacement that replaces share * move: a free way to a place nearer to the goal, or share * move.
///
/// Where the surface rises towards the hand with curvature c a slide in the tangent plane ends after
/// sqrt(2 gap / c), a millionth of the object: the surface has risen by the gap that a sweep leaves (1e-12).
/// But there free space is convex, and the chord between two places of the surface is free. So the slide's
/// end is lifted onto the surface, and the chord to it is swept. Which end: where free space is convex the
/// tangent plane at each lifted end is one more half-space that contains it, and the place nearest to the
/// goal in all of them bounds what any end can gain. Planes are added until an end gains half of that bound;
/// a smooth hollow and a kink need no cases of their own. Where they show that free space is not convex so
/// far, or a bump that no ramp passes stands in the way, nearer ends are tried.
///
/// Bounded: `lifts` lifts of at most five evaluations, for each at most three evaluations and three sweeps
/// more; mostly two lifts and one sweep in all.
[[nodiscard]] SlideUp alongRisingSurface(CandidateCache& cache, const StoppedSlide& slide,
                                         SlideMemory& memory) noexcept;

} // namespace touchstone
