#include "haptics/shape/field/save/field_faces.h"

#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// Along the gradient onto the zero of the cell's polynomial, or as near to it as the cell goes.
glm::dvec3 ontoSurface(const FieldGrid& field, const glm::dvec3& vertex) {
    constexpr int kSteps = 8;
    constexpr double kOnSurface = 1e-6; // voxels
    const glm::ivec3 index = field.cellAt(vertex);
    const FieldCell cell = field.cell(index);
    glm::dvec3 u = vertex - glm::dvec3(index);
    double value = cell.value(u);
    for (int step = 0; step < kSteps && std::abs(value) > kOnSurface * field.layout().voxel; ++step) {
        const glm::dvec3 slope = cell.gradient(u);
        const double steep = glm::dot(slope, slope);
        if (!(steep > 0.0))
            break;
        const glm::dvec3 to = glm::clamp(u - value / steep * slope, 0.0, 1.0);
        const double there = cell.value(to);
        if (!(std::abs(there) < std::abs(value)))
            break;
        u = to;
        value = there;
    }
    return glm::dvec3(index) + u;
}

/// Where the surface crosses the edge of the grid that the quad is dual to: the one that its four cells
/// share.
std::optional<glm::dvec3> crossingOf(const FieldGrid& field, const QuadCells& cells) {
    const auto& [low, high] = cells;
    const glm::ivec3 size = high - low;
    if (size.x + size.y + size.z != 2 || size.x > 1 || size.y > 1 || size.z > 1)
        return std::nullopt; // a point on a face of its cell: floats do not tell whose it is
    const glm::ivec3 along = glm::ivec3(1) - size;
    if (!field.contains(low) || !field.contains(high))
        return std::nullopt;
    const double f = field.node(high), g = field.node(high + along);
    if ((f < 0.0) == (g < 0.0))
        return std::nullopt;
    return glm::dvec3(high) + f / (f - g) * glm::dvec3(along);
}

constexpr int kNoCut = -1;

/// The corner, 0 or 1, at which the diagonal begins that leads nearer to the crossing; kNoCut where both pass
/// it, or where the quad folds over that diagonal.
int bestCut(const std::array<glm::dvec3, 4>& corners, const glm::dvec3& crossing) {
    constexpr double kNear = 0.05; // voxels
    int best = kNoCut;
    double nearest = kNear;
    for (int cut = 0; cut < 2; ++cut) {
        const auto at = [&](int k) { return corners[static_cast<size_t>((cut + k) % 4)]; };
        const Triangle one(at(0), at(1), at(2)), other(at(0), at(2), at(3));
        const double distance =
            std::min(distanceTo(one, crossing).distance, distanceTo(other, crossing).distance);
        if (distance < nearest && glm::dot(one.normal, other.normal) >= 0.0) {
            nearest = distance;
            best = cut;
        }
    }
    return best;
}

} // namespace

QuadCells cellsOf(const GridFaces& faces, const GridFaces::Quad& quad) {
    QuadCells cells{.low = glm::ivec3(INT32_MAX), .high = glm::ivec3(INT32_MIN)};
    for (const uint32_t corner : quad) {
        const glm::ivec3 cell(glm::floor(faces.points[corner]));
        cells.low = glm::min(cells.low, cell);
        cells.high = glm::max(cells.high, cell);
    }
    return cells;
}

FieldFaces facesOf(const FieldGrid& field, const GridFaces& made) {
    FieldFaces faces;
    faces.vertices.reserve(made.points.size());
    for (const glm::vec3& point : made.points)
        faces.vertices.push_back(ontoSurface(field, glm::dvec3(point)));
    faces.corners.reserve(6 * made.quads.size());
    for (const GridFaces::Quad& quad : made.quads) {
        const std::array<glm::dvec3, 4> corners{faces.vertices[quad[0]], faces.vertices[quad[1]],
                                                faces.vertices[quad[2]], faces.vertices[quad[3]]};
        const auto crossing = crossingOf(field, cellsOf(made, quad));
        const int cut = crossing ? bestCut(corners, *crossing) : 0;
        if (cut == kNoCut) {
            const auto first = static_cast<uint32_t>(faces.vertices.size());
            for (size_t k = 0; k < 4; ++k)
                faces.corners.insert(faces.corners.end(), {quad[k], quad[(k + 1) % 4], first});
            faces.vertices.push_back(*crossing);
        } else {
            const auto at = [&](int k) { return quad[static_cast<size_t>((cut + k) % 4)]; };
            const uint32_t a = at(0), b = at(1), c = at(2), d = at(3);
            faces.corners.insert(faces.corners.end(), {a, b, c, a, c, d});
        }
    }
    return faces;
}

} // namespace touchstone
