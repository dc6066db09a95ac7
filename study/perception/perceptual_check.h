#pragma once
// Which edges of a mesh people may feel, by the angles between facets that [004] found for one cylinder, and
// how many triangles would do. Advice for a modeller, no promise about a person.

#include "haptics/scene/haptic_scene.h"

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace touchstone::study {

/// A rendering of [004] and the angle between facets at which a cylinder of 100 mm was told from a smooth one
/// in 70.7 % of the trials: the mean of twelve people (P1: of two).
struct FacetLimit {
    const char* condition; ///< "C1"
    const char* rendering; ///< "force without shading"
    double degrees;        ///< [004 Tables 1 and 2]
    bool shaded;           ///< the direction of the force, or the contact location, is smoothed
};
/// C1, C2, C3, C4, P1.
[[nodiscard]] std::span<const FacetLimit> facetLimits();

/// Of one limit, over the edges that are meant to be smooth.
struct FacetCheck {
    FacetLimit limit{};
    size_t beyond = 0; ///< edges whose angle is larger
    /// Where nine edges of ten are within the limit: the fewest triangles, of those tried, that keep it so.
    /// Not all, since meshoptimizer leaves slivers, which meet their neighbours at any angle.
    std::optional<size_t> enough{};
    double error = 0.0; ///< m in the workspace, of `enough`: meshoptimizer's estimate of the largest distance
    /// Else: about how many triangles it takes, since the angle falls as the edges' length.
    std::optional<size_t> needed{};
};

struct PerceptualCheck {
    size_t triangles = 0;
    size_t edges = 0;       ///< with two triangles
    size_t creases = 0;     ///< of these, with other vertex normals on their two sides: meant to be edges
    bool anySmooth = false; ///< there are normals to shade with; else every edge is a facet's
    double median = 0.0, most90 = 0.0, most99 = 0.0,
           largest = 0.0;       ///< degrees, of the edges that are no creases
    glm::dvec3 largestAt{0.0};  ///< m, workspace: the middle of the edge with the largest angle
    bool simplified = false;    ///< `enough` was looked for
    std::vector<double> angles; ///< degrees, of the edges that are no creases, in no order
    std::vector<FacetCheck> limits;
};

/// Counts over all meshes of a scene; linear in its triangles. Objects without triangles have no edges.
/// Meshes of more than kMostToSimplify triangles in all are counted alone.
inline constexpr size_t kMostToSimplify = 1'500'000;
enum class Search : uint8_t { CountAlone, Enough };
[[nodiscard]] PerceptualCheck checkPerception(const HapticScene& scene, Search search = Search::Enough);

} // namespace touchstone::study
