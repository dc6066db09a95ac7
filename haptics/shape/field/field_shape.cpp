#include "haptics/shape/field/field_shape.h"

#include "engine/core/error.h"

#include <utility>

namespace touchstone {

namespace {

/// Object units: a proxy that rests in a kink keeps a gap of 1e-12 (contact.h) from both cells, and lies as
/// far from the face between them as their angle makes it: this far at 1e-4 rad.
constexpr double kKink = 1e-8;
constexpr int kOutsideSteps = 512;

glm::dvec3 unit(const glm::dvec3& v, const glm::dvec3& otherwise) {
    const double length = glm::length(v);
    return length > 0.0 ? v / length : otherwise;
}

/// The part of the line from + t * d, t in [begin, end], in the box 0..size; begin > end where there is none.
std::pair<double, double> clipped(const glm::dvec3& from, const glm::dvec3& d, const glm::dvec3& size,
                                  double begin, double end) {
    for (int axis = 0; axis < 3; ++axis) {
        if (d[axis] == 0.0) {
            if (from[axis] < 0.0 || from[axis] > size[axis])
                return {1.0, 0.0};
            continue;
        }
        const double a = -from[axis] / d[axis], b = (size[axis] - from[axis]) / d[axis];
        begin = std::max(begin, std::min(a, b));
        end = std::min(end, std::max(a, b));
    }
    return {begin, end};
}

/// Where the line from + t * d leaves the box of `side` cells that begins at `low`.
double leaves(const glm::dvec3& from, const glm::dvec3& d, const glm::ivec3& low, int side) {
    double exit = INFINITY;
    for (int axis = 0; axis < 3; ++axis)
        if (d[axis] != 0.0)
            exit = std::min(exit, (low[axis] + (d[axis] > 0.0 ? side : 0) - from[axis]) / d[axis]);
    return exit;
}

} // namespace

/// A place and the cell that contains it.
struct FieldShape::Place {
    glm::ivec3 cell;
    glm::dvec3 u;        ///< in the cell, within 0..1
    double beyond = 0.0; ///< distance from the grid
};

FieldShape::FieldShape(std::shared_ptr<const FieldGrid> grid) : grid_(std::move(grid)) {
    if (!(grid_->low().x <= grid_->high().x))
        throw Error("distance field", "", "has no inside: it is nowhere negative", "give it a surface");
    boundingRadius_ = glm::length(glm::max(glm::abs(grid_->low()), glm::abs(grid_->high())));
}

FieldShape::Place FieldShape::at(const glm::dvec3& point) const noexcept {
    const glm::dvec3 grid = grid_->gridFromObject(point);
    const glm::dvec3 near = glm::clamp(grid, glm::dvec3(0.0), glm::dvec3(grid_->layout().cells));
    Place place{.cell = grid_->cellAt(near), .u = {}};
    place.u = glm::clamp(near - glm::dvec3(place.cell), 0.0, 1.0);
    place.beyond = grid_->layout().voxel * glm::length(grid - near);
    return place;
}

double FieldShape::value(const glm::dvec3& point) const noexcept {
    const Place place = at(point);
    return grid_->cell(place.cell).value(place.u) + place.beyond;
}

/// From outside of the cell its value goes on as its tangent; from outside of the grid as the distance from
/// it.
FeatureDistance FieldShape::seen(const FieldCell& cell, const glm::ivec3& index,
                                 const glm::dvec3& point) const noexcept {
    const double voxel = grid_->layout().voxel;
    const glm::dvec3 u = grid_->gridFromObject(point) - glm::dvec3(index), q = glm::clamp(u, 0.0, 1.0);
    const glm::dvec3 slope = cell.gradient(q) / voxel, away = voxel * (u - q);
    FeatureDistance seen{.distance = cell.value(q) + glm::dot(slope, away),
                         .gradient = slope,
                         .feature = grid_->numberOf(index)};
    const glm::dvec3 grid = grid_->gridFromObject(point);
    if (glm::any(glm::lessThan(grid, glm::dvec3(0.0))) ||
        glm::any(glm::greaterThan(grid, glm::dvec3(grid_->layout().cells)))) {
        seen.distance = cell.value(q) + glm::length(away);
        seen.gradient = slope + unit(away, glm::dvec3(0.0));
    }
    // Flat far inside and far outside: from the middle of the object.
    seen.gradient = unit(seen.gradient, unit(point - 0.5 * (grid_->low() + grid_->high()), {0.0, 1.0, 0.0}));
    seen.closest = point - seen.distance * seen.gradient;
    return seen;
}

size_t FieldShape::near(const glm::dvec3& point, double reach,
                        std::span<FeatureDistance> found) const noexcept {
    const Place place = at(point);
    const FieldCell own = grid_->cell(place.cell);
    if (own.value(place.u) + place.beyond > reach)
        return 0;
    size_t count = 0;
    const auto add = [&](const FeatureDistance& feature) {
        if (count < found.size()) {
            size_t i = count;
            for (; i > 0 && found[i - 1].distance > feature.distance; --i)
                found[i] = found[i - 1];
            found[i] = feature;
        }
        ++count;
    };
    add(seen(own, place.cell, point));
    const double kink = kKink / grid_->layout().voxel;
    glm::ivec3 side(0); // of the faces that are near
    for (int axis = 0; axis < 3; ++axis)
        side[axis] = place.u[axis] < kink ? -1 : place.u[axis] > 1.0 - kink ? 1 : 0;
    if (side == glm::ivec3(0))
        return count;
    const glm::dvec3 slope = own.gradient(place.u);
    for (int mask = 1; mask < 8; ++mask) {
        const glm::ivec3 towards = side * glm::ivec3(mask & 1, mask >> 1 & 1, mask >> 2);
        const glm::ivec3 index = place.cell + towards;
        const bool several = ((mask & 1) != 0 && side.x == 0) || ((mask & 2) != 0 && side.y == 0) ||
                             ((mask & 4) != 0 && side.z == 0);
        if (several || !grid_->contains(index))
            continue;
        const FieldCell other = grid_->cell(index);
        const glm::dvec3 u = glm::clamp(place.u - glm::dvec3(towards), 0.0, 1.0);
        // Concave: beyond the kink the other cell lies below the continuation of this one.
        if (glm::dot(other.gradient(u) - slope, glm::dvec3(towards)) >= 0.0)
            continue;
        if (const FeatureDistance feature = seen(other, index, point); feature.distance <= reach)
            add(feature);
    }
    return count;
}

FeatureDistance FieldShape::distanceFrom(FeatureId feature, const glm::dvec3& point) const noexcept {
    const glm::ivec3 index = grid_->cellOf(feature);
    return seen(grid_->cell(index), index, point);
}

glm::dvec3 FieldShape::gradient(const glm::dvec3& point) const noexcept {
    const Place place = at(point);
    glm::dvec3 sum(0.0);
    for (int k = 0; k < 8; ++k) {
        const glm::ivec3 corner(k & 1, k >> 1 & 1, k >> 2);
        const glm::dvec3 weight = glm::mix(1.0 - place.u, place.u, glm::dvec3(corner));
        sum += weight.x * weight.y * weight.z * grid_->nodeGradient(place.cell + corner);
    }
    return sum;
}

glm::dvec3 FieldShape::shadingNormal(FeatureId, const glm::dvec3& point) const noexcept {
    return unit(gradient(point), glm::dvec3(0.0));
}

/// Sphere tracing: f grows by at most its Lipschitz bound, and by the distance from the grid.
double FieldShape::sweepOutside(const glm::dvec3& centre, const glm::dvec3& motion, double level, double from,
                                double to) const noexcept {
    const double rate = (grid_->lipschitz() + 1.0) * glm::length(motion);
    double time = from;
    for (int step = 0; step < kOutsideSteps && time < to; ++step) {
        const double free = value(centre + time * motion) - level;
        if (free <= 0.0)
            return time;
        time += std::max(free / rate, 1e-15);
    }
    return time < to ? time : INFINITY;
}

/// Cell by cell, where the cubic along the line first falls below the level; what the Lipschitz bound clears
/// is skipped. Each turn enters another cell, so there are at most as many as the grid has layers on its
/// three axes.
double FieldShape::sweepInside(const glm::dvec3& centre, const glm::dvec3& motion, double level, double from,
                               double to) const noexcept {
    const FieldLayout& layout = grid_->layout();
    const glm::dvec3 begin = grid_->gridFromObject(centre), d = motion / layout.voxel;
    const double rate = grid_->lipschitz() * glm::length(motion);
    double time = from;
    while (time < to) {
        const glm::dvec3 place = begin + time * d;
        glm::ivec3 cell = grid_->cellAt(place);
        for (int axis = 0; axis < 3; ++axis) // from a face into the cell that the line enters
            if (d[axis] < 0.0 && place[axis] <= cell[axis] && cell[axis] > 0)
                --cell[axis];
        const float flat = grid_->flatBrick(cell);
        const bool isFlat = flat == flat;
        double exit =
            isFlat ? leaves(begin, d, FieldGrid::kBrick * (cell / FieldGrid::kBrick), FieldGrid::kBrick)
                   : leaves(begin, d, cell, 1);
        exit = std::min(std::max(exit, std::nextafter(time, INFINITY)), to);
        if (!isFlat) {
            const auto along = grid_->cell(cell).along(place - glm::dvec3(cell), d);
            const double fall = firstBelow(along, level, 0.0, exit - time);
            if (fall < INFINITY)
                return time + fall;
            exit = std::max(exit, time + (along[0] - level) / rate);
        }
        time = exit;
    }
    return INFINITY;
}

double FieldShape::sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                         double limit) const noexcept {
    if (!(glm::dot(motion, motion) > 0.0))
        return limit;
    const double level = std::min(radius, value(centre)) - kTouch;
    const auto [enters, leavesAt] = clipped(grid_->gridFromObject(centre), motion / grid_->layout().voxel,
                                            glm::dvec3(grid_->layout().cells), 0.0, limit);
    double time = INFINITY;
    if (enters > leavesAt) {
        time = sweepOutside(centre, motion, level, 0.0, limit);
    } else {
        time = sweepOutside(centre, motion, level, 0.0, enters);
        if (!(time < INFINITY))
            time = sweepInside(centre, motion, level, enters, leavesAt);
        if (!(time < INFINITY))
            time = sweepOutside(centre, motion, level, leavesAt, limit);
    }
    return std::min(time, limit);
}

} // namespace touchstone
