#pragma once
// The part of space that a picture, or a part of it, shows. Pure arithmetic.

#include <glm/glm.hpp>

#include <array>

namespace touchstone {

/// The half-spaces of a clip space with depth 0..1, between `low` and `high` of x and y (-1..1: all of it).
class Frustum {
  public:
    explicit Frustum(const glm::dmat4& clipFromEye, const glm::dvec2& low = glm::dvec2(-1.0),
                     const glm::dvec2& high = glm::dvec2(1.0)) {
        const glm::dmat4 rows = glm::transpose(clipFromEye);
        planes_ = {rows[0] - low.x * rows[3],
                   high.x * rows[3] - rows[0],
                   rows[1] - low.y * rows[3],
                   high.y * rows[3] - rows[1],
                   rows[2],
                   rows[3] - rows[2]};
    }

    /// Nothing of the ball is shown. False says nothing: a ball near an edge may still be outside.
    [[nodiscard]] bool misses(const glm::dvec3& centre, double radius) const {
        for (const glm::dvec4& plane : planes_)
            if (glm::dot(glm::dvec3(plane), centre) + plane.w < -radius * glm::length(glm::dvec3(plane)))
                return true;
        return false;
    }

  private:
    std::array<glm::dvec4, 6> planes_; ///< inside: dot(plane, (p, 1)) >= 0
};

} // namespace touchstone
