#include "haptics/texture/bump.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// The core normal map's normal, object frame, not of unit length; the felt normal where there is no tangent
/// frame.
glm::dvec3 normalFromMap(const SurfaceSpot& spot, SpotMaps& maps) {
    const HapticMap& map = spot.material.normal;
    if (!spot.hasUv(map.layout().texCoord))
        return spot.normal;
    glm::dvec3 local = 2.0 * maps.vector(map) - 1.0;
    local.x *= spot.material.normalScale;
    local.y *= spot.material.normalScale;
    local.z = std::max(local.z, 0.0); // a normal that points into the surface would pull the hand in
    glm::dvec3 tangent(0.0);
    double sign = 0.0;
    if (!spot.object.tangents.empty()) {
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec4& t = spot.object.tangents[spot.source(k)];
            tangent += spot.weight[static_cast<int>(k)] * glm::dvec3(t.x, t.y, t.z);
            sign += spot.weight[static_cast<int>(k)] * static_cast<double>(t.w);
        }
    } else {
        // dP/du is perpendicular to grad v, on the side of grad u; the image's top points against growing v.
        const SurfaceGradients& g = maps.gradients(map.layout().texCoord);
        tangent = glm::cross(g.second, spot.normal);
        if (glm::dot(tangent, g.first) < 0.0)
            tangent = -tangent;
        sign = -glm::dot(glm::cross(spot.normal, tangent), g.second);
    }
    tangent -= glm::dot(tangent, spot.normal) * spot.normal;
    const double length = glm::length(tangent);
    if (!(length > 1e-12) || sign == 0.0)
        return spot.normal;
    tangent /= length;
    const glm::dvec3 bitangent = (sign < 0.0 ? -1.0 : 1.0) * glm::cross(spot.normal, tangent);
    const glm::dvec3 normal = local.x * tangent + local.y * bitangent + local.z * spot.normal;
    return glm::dot(normal, normal) > 1e-18 ? normal : spot.normal;
}

/// Height and its gradient: model metres, and metres of the model per object unit.
struct Heights {
    bool known = false;
    double above = 0.0; ///< above the lowest place, seen from the side that is touched
    glm::dvec3 gradient{0.0};
};

/// `high` - `low` bounds the values; from the back a bump is a dent, and the highest place is the lowest.
double aboveLowest(double value, double low, double high, bool fromBack) {
    return std::max(fromBack ? high - value : value - low, 0.0);
}

Heights heightsFromMap(const SurfaceSpot& spot, SpotMaps& maps) {
    const HapticMap& map = spot.material.height;
    const double scale = spot.material.heightScale;
    if (map.empty() || scale == 0.0 || !spot.hasUv(map.layout().texCoord))
        return {};
    const HapticMap::Slope read = maps.slope(map, spot.slopes);
    const double black = scale * static_cast<double>(map.least()),
                 white = scale * static_cast<double>(map.greatest());
    const glm::dvec2 overMap = scale * read.gradient;
    const SurfaceGradients g = maps.gradients(map);
    return {true,
            aboveLowest(scale * read.value, std::min(black, white), std::max(black, white), spot.backside),
            overMap.x * g.first + overMap.y * g.second};
}

Heights heightsFromVertices(const SurfaceSpot& spot) {
    const HapticObject& o = spot.object;
    if (o.heights.empty())
        return {};
    const auto at = [&](size_t corner) { return static_cast<double>(o.heights[spot.source(corner)]); };
    const auto facet = [&]() -> SurfaceGradients {
        return {gradientOver(spot.triangle, at(0), at(1), at(2)), glm::dvec3(0.0)};
    };
    return {true,
            aboveLowest(spot.attribute(o.heights, 0.0), static_cast<double>(o.minHeight),
                        static_cast<double>(o.greatestHeight), spot.backside),
            smoothed(spot, o.heightGradients, facet).first};
}

/// [001 4.11], N + (B_u (N x P_t) - B_v (N x P_s)) / |N|, with the triangle's own sides as s and t: with N =
/// P_s x P_t the result is independent of the parameters, and the sides exist where texture coordinates are
/// missing, mirrored or collapsed.
glm::dvec3 blinnNormal(const SurfaceSpot& spot, const glm::dvec3& slope) {
    const glm::dvec3 s = spot.triangle.b - spot.triangle.a, t = spot.triangle.c - spot.triangle.a;
    const double size = glm::length(glm::cross(s, t));
    const glm::dvec3& n = spot.normal; // N = size n
    return size * n + glm::dot(slope, s) * glm::cross(n, t) - glm::dot(slope, t) * glm::cross(n, s);
}

/// `slope`: grad H, dimensionless. The [000] form keeps its component in the felt surface. Not of unit
/// length.
glm::dvec3 normalFromSlope(const SurfaceSpot& spot, const glm::dvec3& slope, TextureMode mode) {
    const glm::dvec3& n = spot.normal;
    const glm::dvec3 bumped =
        mode == TextureMode::Blinn ? blinnNormal(spot, slope) : n - slope + glm::dot(slope, n) * n;
    const double squared = glm::dot(bumped, bumped);
    return std::isfinite(squared) && squared > 0.0 ? bumped : n;
}

/// Unit vector along m, with the tangent t of its angle to the unit vector n compressed smoothly below that
/// of the limit, T: t / (1 + (t/T)^4)^(1/4) preserves small tilts to fourth order and never reaches the
/// limit, so no shape is cut flat.
glm::dvec3 compressTilt(const glm::dvec3& n, const glm::dvec3& m, double limit, bool& compressed) {
    constexpr double kNoLimit = 1.5707963267948966;
    if (limit >= kNoLimit)
        return glm::normalize(m);
    const double along = glm::dot(n, m);
    const glm::dvec3 sideways = m - along * n;
    const double squared = glm::dot(sideways, sideways);
    if (!(limit > 0.0) || !(squared > 0.0))
        return n;
    constexpr double kSteep = 1e30; // beyond it fourth powers would overflow
    if (squared > kSteep)
        return compressTilt(n, glm::normalize(m), limit, compressed);
    // Tangent = |sideways| / root; without a limit root is `along`.
    const double slope = std::tan(limit);
    const double c = std::max(along, 0.0) * std::max(along, 0.0), s = squared / (slope * slope);
    compressed = s > c;
    const double root = std::sqrt(std::sqrt(c * c + s * s));
    return (root * n + sideways) / std::sqrt(root * root + squared);
}

} // namespace

Bump readBump(const SurfaceSpot& spot, SpotMaps& maps, const HapticSettings& settings) noexcept {
    const double strength = settings.textureStrength;
    Bump bump;
    bump.normal = spot.normal;
    Heights heights = heightsFromMap(spot, maps);
    if (!heights.known)
        heights = heightsFromVertices(spot);
    // Blinn's and Minsky's modes use grad H.
    const bool fromNormalMap =
        !spot.material.normal.empty() && (settings.texture == TextureMode::Law || !heights.known);
    if (heights.known) {
        bump.hasHeight = true;
        bump.height = strength * heights.above * spot.workspacePerObject / spot.modelPerObject;
        if (!fromNormalMap)
            bump.normal =
                normalFromSlope(spot, strength / spot.modelPerObject * heights.gradient, settings.texture);
    }
    if (fromNormalMap) {
        constexpr double kSteepest = 0.05; // cosine; beyond 87 degrees slopes diverge
        const glm::dvec3 m = normalFromMap(spot, maps);
        const double along = std::max(glm::dot(m, spot.normal), kSteepest * glm::length(m));
        bump.normal = spot.normal + strength * (m / along - spot.normal);
    }
    bump.normal = compressTilt(spot.normal, bump.normal, settings.textureTiltLimit, bump.tiltCompressed);
    return bump;
}

} // namespace touchstone
