#pragma once
// Frames and the maps between them. A transform reads as `aFromB`: it maps coordinates in b to a.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

namespace touchstone {

/// x -> scale * (rotation * x) + translation, in double. It preserves angles and ratios, so forces, friction
/// cones and penetration depths computed in one frame hold in the other up to `scale`.
struct Similarity {
    double scale = 1.0;                      ///< length in a of one unit of length in b; > 0
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0}; ///< unit
    glm::dvec3 translation{0.0};             ///< in a

    [[nodiscard]] glm::dvec3 point(const glm::dvec3& b) const { return scale * (rotation * b) + translation; }
    [[nodiscard]] glm::dvec3 vector(const glm::dvec3& b) const { return scale * (rotation * b); }
    [[nodiscard]] glm::dvec3 direction(const glm::dvec3& b) const { return rotation * b; }

    [[nodiscard]] Similarity inverse() const {
        const glm::dquat back = glm::conjugate(rotation);
        return {1.0 / scale, back, (back * -translation) / scale};
    }

    /// `inverse().point(a)`, without its cancellation where both are far from a's origin.
    [[nodiscard]] glm::dvec3 inversePoint(const glm::dvec3& a) const {
        return glm::conjugate(rotation) * (a - translation) / scale;
    }
    /// `inverse() * aFromC`, which is bFromC, likewise without cancellation.
    [[nodiscard]] Similarity inverseTimes(const Similarity& aFromC) const {
        return {aFromC.scale / scale, glm::normalize(glm::conjugate(rotation) * aFromC.rotation),
                inversePoint(aFromC.translation)};
    }

    /// `aFromB * bFromC` is `aFromC`.
    [[nodiscard]] Similarity operator*(const Similarity& bFromC) const {
        return {scale * bFromC.scale, glm::normalize(rotation * bFromC.rotation), point(bFromC.translation)};
    }
};

/// Axis-aligned box; empty until the first `include`.
struct Bounds {
    glm::dvec3 low{1e300};
    glm::dvec3 high{-1e300};

    void include(const glm::dvec3& p) {
        low = glm::min(low, p);
        high = glm::max(high, p);
    }
    [[nodiscard]] bool empty() const { return low.x > high.x; }
    [[nodiscard]] glm::dvec3 centre() const { return 0.5 * (low + high); }
    [[nodiscard]] glm::dvec3 extent() const { return empty() ? glm::dvec3(0.0) : high - low; }
    [[nodiscard]] double diagonal() const { return glm::length(extent()); }
};

} // namespace touchstone
