#include "assets/shapes.h"

#include "assets/cut_torus.h"

#include <array>
#include <cmath>
#include <numbers>
#include <stdexcept>

namespace touchstone::assets {

namespace {

struct Turn {
    double cosine, sine;
};

/// Cosine and sine of each step of a full turn. The quarter turns are exact, so a closed shape is symmetric
/// and a seam that returns to step 0 has identical bits.
std::vector<Turn> turns(uint32_t steps) {
    std::vector<Turn> result(steps);
    for (uint32_t i = 0; i < steps; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / steps;
        result[i] = {std::cos(angle), std::sin(angle)};
        if ((uint64_t{i} * 4) % steps == 0) {
            static constexpr std::array<Turn, 4> kQuarters{{{1, 0}, {0, 1}, {-1, 0}, {0, -1}}};
            result[i] = kQuarters[uint64_t{i} * 4 / steps];
        }
    }
    return result;
}

void appendTriangle(Shape& shape, uint32_t a, uint32_t b, uint32_t c) {
    shape.indices.insert(shape.indices.end(), {a, b, c});
}

/// a, b, c, d go around the quad; counter-clockwise if `forwards`.
void appendQuad(Shape& shape, uint32_t a, uint32_t b, uint32_t c, uint32_t d, bool forwards) {
    appendTriangle(shape, a, forwards ? b : c, forwards ? c : b);
    appendTriangle(shape, a, forwards ? c : d, forwards ? d : c);
}

void demand(bool holds, const char* what) {
    if (!holds)
        throw std::invalid_argument(what);
}

} // namespace

Shape torus(double ring, double tube, uint32_t aroundRing, uint32_t aroundTube, TextureRepeats repeats) {
    demand(aroundRing >= 3 && aroundTube >= 3, "a torus needs at least three segments each way");
    const bool textured = repeats.u > 0 && repeats.v > 0;
    const uint32_t columns = aroundRing + (textured ? 1 : 0), rows = aroundTube + (textured ? 1 : 0);
    const std::vector<Turn> ringTurns = turns(aroundRing), tubeTurns = turns(aroundTube);

    Shape shape;
    shape.positions.reserve(size_t{columns} * rows);
    shape.normals.reserve(size_t{columns} * rows);
    shape.indices.reserve(size_t{6} * aroundRing * aroundTube);
    for (uint32_t i = 0; i < columns; ++i) {
        const Turn r = ringTurns[i % aroundRing];
        for (uint32_t j = 0; j < rows; ++j) {
            // The tube is traversed against the sense of u cross n, so that v grows downwards where u grows
            // to the right for an observer of the surface: the image is not mirrored and w is +1.
            const Turn t = tubeTurns[(aroundTube - j % aroundTube) % aroundTube];
            const double reach = ring + tube * t.cosine;
            shape.positions.emplace_back(reach * r.cosine, reach * r.sine, tube * t.sine);
            shape.normals.emplace_back(t.cosine * r.cosine, t.cosine * r.sine, t.sine);
            if (textured) {
                shape.uv.emplace_back(static_cast<double>(repeats.u) * i / aroundRing,
                                      static_cast<double>(repeats.v) * j / aroundTube);
                shape.tangents.emplace_back(-r.sine, r.cosine, 0.0, 1.0);
            }
        }
    }
    const auto at = [&](uint32_t i, uint32_t j) { return (i % columns) * rows + j % rows; };
    for (uint32_t i = 0; i < aroundRing; ++i)
        for (uint32_t j = 0; j < aroundTube; ++j) {
            const uint32_t a = at(i, j), b = at(i + 1, j), c = at(i + 1, j + 1), d = at(i, j + 1);
            appendTriangle(shape, a, d, b);
            appendTriangle(shape, b, d, c);
        }
    return shape;
}

namespace {

/// The strip between two circles of m and n vertices about a tube, those of the second after the first's.
void appendStrip(Shape& shape, uint32_t first, uint32_t m, uint32_t second, uint32_t n) {
    uint32_t p = 0, q = 0;
    while (p < m || q < n) {
        const uint32_t a = first + p % m, b = second + q % n;
        if (q == n || (p < m && uint64_t{p + 1} * n <= uint64_t{q + 1} * m))
            appendTriangle(shape, a, first + ++p % m, b);
        else
            appendTriangle(shape, b, a, second + ++q % n);
    }
}

} // namespace

Shape cutTorus(double ring, double tube, std::span<const uint32_t> points) {
    demand(points.size() >= 4 && points.front() == points.back(), "a cut torus ends as it begins");
    const auto around = static_cast<uint32_t>(points.size() - 1);
    const std::vector<Turn> ringTurns = turns(around);
    Shape shape;
    uint32_t first = 0;
    for (uint32_t i = 0; i <= around; ++i) {
        const uint32_t count = points[i];
        demand(count >= 3, "a circle needs at least three points");
        const Turn r = ringTurns[i % around];
        const std::vector<Turn> tubeTurns = turns(count);
        for (uint32_t j = 0; j < count; ++j) {
            const Turn t = tubeTurns[(count - j) % count];
            const double reach = ring + tube * t.cosine;
            shape.positions.emplace_back(reach * r.cosine, reach * r.sine, tube * t.sine);
            shape.normals.emplace_back(t.cosine * r.cosine, t.cosine * r.sine, t.sine);
        }
        if (i > 0)
            appendStrip(shape, first - points[i - 1], points[i - 1], first, count);
        first += count;
    }
    return shape;
}

Shape tableOneRing() {
    // A strip has as many triangles as its two circles have vertices, so 239 vertices on circles that begin
    // and end with 11 make 2 * 239 - 2 * 11 = 456 triangles: 13 circles of 11 and 8 of 12.
    constexpr std::array<uint32_t, 21> kPoints{11, 11, 12, 11, 12, 11, 12, 11, 12, 11, 11,
                                               11, 12, 11, 12, 11, 12, 11, 12, 11, 11};
    return cutTorus(0.060, 0.025, kPoints);
}

Shape sphere(double radius, uint32_t latitudes, uint32_t longitudes) {
    demand(latitudes >= 1 && longitudes >= 3, "a sphere needs a circle of at least three points");
    const std::vector<Turn> around = turns(longitudes);
    Shape shape;
    const auto add = [&](const glm::dvec3& n) {
        shape.normals.emplace_back(n);
        shape.positions.emplace_back(radius * n);
    };
    shape.indices.reserve(size_t{6} * latitudes * longitudes);
    add({0.0, 1.0, 0.0});
    for (uint32_t i = 1; i <= latitudes; ++i) {
        const double polar = std::numbers::pi * i / (latitudes + 1);
        const double height = 2 * i == latitudes + 1 ? 0.0 : std::cos(polar);
        for (uint32_t j = 0; j < longitudes; ++j)
            add({std::sin(polar) * around[j].sine, height, std::sin(polar) * around[j].cosine});
    }
    add({0.0, -1.0, 0.0});
    const uint32_t last = latitudes * longitudes + 1;
    const auto at = [&](uint32_t i, uint32_t j) { return 1 + i * longitudes + j % longitudes; };
    for (uint32_t j = 0; j < longitudes; ++j)
        appendTriangle(shape, 0, at(0, j), at(0, j + 1));
    for (uint32_t i = 0; i + 1 < latitudes; ++i)
        for (uint32_t j = 0; j < longitudes; ++j) {
            appendTriangle(shape, at(i, j), at(i + 1, j), at(i, j + 1));
            appendTriangle(shape, at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
        }
    for (uint32_t j = 0; j < longitudes; ++j)
        appendTriangle(shape, last, at(latitudes - 1, j + 1), at(latitudes - 1, j));
    return shape;
}

Shape boxWithSharedCorners(const glm::dvec3& sides) {
    Shape shape;
    for (uint32_t i = 0; i < 8; ++i)
        shape.positions.emplace_back((i & 1 ? 0.5 : -0.5) * sides.x, (i & 2 ? 0.5 : -0.5) * sides.y,
                                     (i & 4 ? 0.5 : -0.5) * sides.z);
    shape.indices = {0, 4, 6, 0, 6, 2, 1, 3, 7, 1, 7, 5, 0, 1, 5, 0, 5, 4,
                     2, 6, 7, 2, 7, 3, 0, 2, 3, 0, 3, 1, 4, 5, 7, 4, 7, 6};
    return shape;
}

void appendCell(Shape& shape, const Face& face, size_t a, size_t b) {
    const auto first = static_cast<uint32_t>(shape.positions.size());
    const int axisA = (face.axis + 1) % 3, axisB = (face.axis + 2) % 3;
    glm::dvec3 normal(0.0);
    normal[face.axis] = face.sign;
    for (const auto& [i, j] : {std::pair{0, 0}, {1, 0}, {1, 1}, {0, 1}}) {
        glm::dvec3 corner(0.0);
        corner[face.axis] = face.at;
        corner[axisA] = face.cutsA[a + static_cast<size_t>(i)];
        corner[axisB] = face.cutsB[b + static_cast<size_t>(j)];
        shape.positions.emplace_back(corner);
        shape.normals.emplace_back(normal);
    }
    appendQuad(shape, first, first + 1, first + 2, first + 3, face.sign > 0.0);
}

Shape box(const glm::dvec3& sides, uint32_t cells) {
    demand(cells >= 1, "a box needs at least one cell on each face");
    std::array<std::vector<double>, 3> cuts;
    for (int axis = 0; axis < 3; ++axis)
        for (uint32_t i = 0; i <= cells; ++i)
            cuts[static_cast<size_t>(axis)].push_back(sides[axis] * (static_cast<double>(i) / cells - 0.5));
    Shape shape;
    for (int axis = 0; axis < 3; ++axis)
        for (const double sign : {-1.0, 1.0}) {
            const int axisA = (axis + 1) % 3, axisB = (axis + 2) % 3;
            const auto first = static_cast<uint32_t>(shape.positions.size());
            glm::dvec3 normal(0.0), corner(0.0);
            normal[axis] = sign;
            corner[axis] = 0.5 * sign * sides[axis];
            for (const double a : cuts[static_cast<size_t>(axisA)])
                for (const double b : cuts[static_cast<size_t>(axisB)]) {
                    corner[axisA] = a;
                    corner[axisB] = b;
                    shape.positions.emplace_back(corner);
                    shape.normals.emplace_back(normal);
                }
            for (uint32_t a = 0; a < cells; ++a)
                for (uint32_t b = 0; b < cells; ++b) {
                    const uint32_t here = first + a * (cells + 1) + b, beyond = here + cells + 1;
                    appendQuad(shape, here, beyond, beyond + 1, here + 1, sign > 0.0);
                }
        }
    return shape;
}

Shape prism(uint32_t sides, double circumradius, double length, bool smooth, uint32_t rows) {
    demand(sides >= 3 && rows >= 1, "a prism needs at least three sides and one row");
    const std::vector<Turn> around = turns(sides);
    const auto corner = [&](uint32_t i, double y) {
        return glm::dvec3(circumradius * around[i % sides].sine, y, circumradius * around[i % sides].cosine);
    };
    Shape shape;
    for (uint32_t i = 0; i < sides; ++i) {
        const glm::dvec3 left = corner(i, 0.0), right = corner(i + 1, 0.0);
        const glm::dvec3 flat = glm::normalize(left + right);
        for (uint32_t row = 0; row <= rows; ++row) {
            const double y = length * (static_cast<double>(row) / rows - 0.5);
            const auto first = static_cast<uint32_t>(shape.positions.size());
            shape.positions.emplace_back(left.x, y, left.z);
            shape.positions.emplace_back(right.x, y, right.z);
            shape.normals.emplace_back(smooth ? left / circumradius : flat);
            shape.normals.emplace_back(smooth ? right / circumradius : flat);
            if (row == rows)
                continue;
            appendTriangle(shape, first, first + 1, first + 3);
            appendTriangle(shape, first, first + 3, first + 2);
        }
    }
    for (const double sign : {-1.0, 1.0}) {
        const auto centre = static_cast<uint32_t>(shape.positions.size());
        shape.positions.emplace_back(0.0, 0.5 * sign * length, 0.0);
        for (uint32_t i = 0; i < sides; ++i)
            shape.positions.emplace_back(corner(i, 0.5 * sign * length));
        shape.normals.insert(shape.normals.end(), sides + 1, glm::vec3(0.0f, static_cast<float>(sign), 0.0f));
        for (uint32_t i = 0; i < sides; ++i) {
            const uint32_t a = centre + 1 + i, b = centre + 1 + (i + 1) % sides;
            if (sign > 0.0)
                appendTriangle(shape, centre, a, b);
            else
                appendTriangle(shape, centre, b, a);
        }
    }
    return shape;
}

Shape plane(double width, double depth, uint32_t columns, uint32_t rows) {
    demand(columns >= 1 && rows >= 1, "a plane needs at least one cell each way");
    Shape shape;
    for (uint32_t j = 0; j <= rows; ++j)
        for (uint32_t i = 0; i <= columns; ++i) {
            const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
            shape.positions.emplace_back(width * (u - 0.5), 0.0, depth * (v - 0.5));
            shape.normals.emplace_back(0.0f, 1.0f, 0.0f);
            shape.uv.emplace_back(u, v);
            shape.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
        }
    for (uint32_t j = 0; j < rows; ++j)
        for (uint32_t i = 0; i < columns; ++i) {
            const uint32_t a = j * (columns + 1) + i, b = a + 1, c = a + columns + 1, d = c + 1;
            appendTriangle(shape, a, c, b);
            appendTriangle(shape, b, c, d);
        }
    return shape;
}

} // namespace touchstone::assets
