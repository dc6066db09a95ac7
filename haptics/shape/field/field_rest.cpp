// Where a ball rests on a field: Newton's method on the conditions of Lagrange.

#include "haptics/shape/field/field_shape.h"

#include <algorithm>

namespace touchstone {

namespace {

constexpr int kSteps = 12;
/// Cell edges. The method is quadratic: after a step as short as this what is left is rounding.
constexpr double kConverged = 1e-8;

/// Faces between cells that hold the ball with both of their cells: what it slides on is their common edge.
class Faces {
  public:
    /// A step from one cell to another. True where it goes back through the face that the last one on its
    /// axis came through: the rest of either cell lies in the other.
    bool crossed(int axis, int from, int to) noexcept {
        if (from == to)
            return false;
        const int plane = std::max(from, to), way = to > from ? 1 : -1;
        const bool back = plane_[axis] == plane && way_[axis] == -way;
        plane_[axis] = plane;
        way_[axis] = way;
        if (back) {
            held_[axis] = true;
            ++count_;
        }
        return back;
    }
    [[nodiscard]] bool held(int axis) const noexcept { return held_[axis]; }
    [[nodiscard]] int plane(int axis) const noexcept { return plane_[axis]; }

    /// A least of the distance to the goal, not a saddle or a most: `a` is positive along the surface, as far
    /// as the faces leave it free. `g` need not be unit.
    [[nodiscard]] bool isLeast(const glm::dmat3& a, const glm::dvec3& g) const noexcept {
        if (count_ > 1)
            return true;
        const glm::dvec3 size = glm::abs(g);
        int axis = size.x <= size.y && size.x <= size.z ? 0 : size.y <= size.z ? 1 : 2;
        if (count_ == 1)
            axis = held_[0] ? 0 : held_[1] ? 1 : 2;
        glm::dvec3 other(0.0);
        other[axis] = 1.0;
        const glm::dvec3 s = glm::cross(g, other), t = glm::cross(g, s);
        const double ss = glm::dot(s, a * s), st = glm::dot(s, a * t), tt = glm::dot(t, a * t);
        return ss > 0.0 && (count_ == 1 || ss * tt > st * st);
    }

    /// True where each of the faces holds the ball at x: into either of its cells the way to the goal grows.
    /// `up` = x - goal = m g but for the part across the faces. A kink that falls away holds nothing.
    [[nodiscard]] bool hold(const FieldGrid& grid, const glm::dvec3& x, const glm::dvec3& up,
                            double m) const noexcept {
        for (int axis = 0; axis < 3; ++axis) {
            if (!held_[axis])
                continue;
            glm::ivec3 high = grid.cellAt(x), low = high;
            high[axis] = plane_[axis];
            low[axis] = plane_[axis] - 1;
            const double above = grid.cell(high).gradient(x - glm::dvec3(high))[axis],
                         below = grid.cell(low).gradient(x - glm::dvec3(low))[axis];
            if (up[axis] < m * above || up[axis] > m * below)
                return false;
        }
        return true;
    }

  private:
    glm::ivec3 plane_{-1}, way_{0};
    glm::bvec3 held_{false};
    int count_ = 0;
};

} // namespace

/// In cell edges x, with the goal q: x - q = m g(x) and f(x) = distance, g the gradient of f. The derivatives
/// of both by x and m, with A = 1 - m H, H that of g:
///     A dx - g dm = -r, r = x - q - m g;      g dx = distance - f.
/// So dx = A^-1 (g dm - r), and dm from the second. On a face that holds the ball (Faces) x keeps its
/// coordinate across it, and the first equation loses that row.
bool FieldShape::restNear(const glm::dvec3& from, const glm::dvec3& goal, double distance,
                          glm::dvec3& place) const noexcept {
    const glm::dvec3 q = grid_->gridFromObject(goal);
    glm::dvec3 x = grid_->gridFromObject(from);
    Faces faces;
    double m = 0.0;
    for (int step = 0; step < kSteps; ++step) {
        const glm::ivec3 index = grid_->cellAt(x);
        const glm::dvec3 u = x - glm::dvec3(index);
        if (!glm::all(glm::greaterThanEqual(u, glm::dvec3(0.0))) ||
            !glm::all(glm::lessThanEqual(u, glm::dvec3(1.0))))
            return false; // outside of the grid, or no number
        const FieldCell cell = grid_->cell(index);
        glm::dvec3 g = cell.gradient(u);
        const glm::dvec3 mixed = cell.mixed(u);
        if (step == 0)
            m = glm::dot(x - q, g) / glm::dot(g, g);
        glm::dmat3 a(1.0, -m * mixed.z, -m * mixed.y, -m * mixed.z, 1.0, -m * mixed.x, -m * mixed.y,
                     -m * mixed.x, 1.0);
        if (!(m > 0.0) || !faces.isLeast(a, g))
            return false; // the goal is not behind the surface, or g is zero
        glm::dvec3 r = x - q - m * g;
        for (int axis = 0; axis < 3; ++axis)
            if (faces.held(axis)) {
                g[axis] = r[axis] = 0.0;
                for (int k = 0; k < 3; ++k)
                    a[axis][k] = a[k][axis] = k == axis ? 1.0 : 0.0;
            }
        const glm::dmat3 inverse = glm::inverse(a);
        const glm::dvec3 away = inverse * g, rest = inverse * r;
        const double dm = (distance - cell.value(u) + glm::dot(g, rest)) / glm::dot(g, away);
        const glm::dvec3 dx = dm * away - rest;
        x += dx;
        m += dm;
        if (glm::dot(dx, dx) <= kConverged * kConverged) {
            place = grid_->layout().origin + grid_->layout().voxel * x;
            return faces.hold(*grid_, x, x - q, m);
        }
        const glm::ivec3 next = grid_->cellAt(x);
        for (int axis = 0; axis < 3; ++axis)
            if (!faces.held(axis) && faces.crossed(axis, index[axis], next[axis]))
                x[axis] = faces.plane(axis);
    }
    return false;
}

} // namespace touchstone
