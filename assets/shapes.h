#pragma once
// The closed-form shapes of our scenes, at any tessellation. Shared by the asset program, the tests and the
// benchmarks, so that all use the same meshes.

#include <glm/glm.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace touchstone::assets {

/// An indexed triangle mesh in metres, centred on the origin, counter-clockwise seen from outside. Evaluated
/// in double and rounded once to float. Every array but `positions` and `indices` may be empty. A closed
/// shape is exactly closed: duplicated vertices along a seam are bitwise equal.
struct Shape {
    std::vector<glm::vec3> positions;
    std::vector<glm::vec3> normals;  ///< unit
    std::vector<glm::vec2> uv;       ///< origin upper left, as in glTF
    std::vector<glm::vec4> tangents; ///< along growing u; bitangent cross(n, t) * w points to the image's top
    std::vector<uint32_t> indices;

    [[nodiscard]] size_t triangleCount() const { return indices.size() / 3; }
};

/// Repeats of the texture around a shape; zero omits UVs and tangents (and with them the seam).
struct TextureRepeats {
    int u = 0, v = 0;
};

/// Torus about the z axis: `ring` is the radius of the tube's centre line, `tube` that of the tube, m.
/// u runs along the ring, v around the tube. 2 * aroundRing * aroundTube triangles; each count at least 3.
[[nodiscard]] Shape torus(double ring, double tube, uint32_t aroundRing, uint32_t aroundTube,
                          TextureRepeats repeats = {});

/// Sphere with poles on the y axis: `latitudes` circles of `longitudes` points and two poles, smooth normals.
/// 2 * latitudes * longitudes triangles on latitudes * longitudes + 2 vertices.
[[nodiscard]] Shape sphere(double radius, uint32_t latitudes, uint32_t longitudes);

/// Box of the given side lengths, m, on shared corners without normals (12 triangles on 8 vertices).
[[nodiscard]] Shape boxWithSharedCorners(const glm::dvec3& sides);

/// Box of the given side lengths, m, with flat normals and each face cut into cells * cells squares.
[[nodiscard]] Shape box(const glm::dvec3& sides, uint32_t cells = 1);

/// One face of a gridded box: the rectangles between neighbouring cuts, on the side of the axis given by
/// `sign` (+1 or -1); `at` is the face's coordinate on that axis. Cuts ascend.
struct Face {
    int axis = 2;
    double sign = 1.0;
    double at = 0.0;
    std::vector<double> cutsA, cutsB; ///< along axis + 1 and axis + 2 (cyclic: x, y, z)
};
/// Appends the face's cells for which `keep(a, b)` holds (cell indices along A and B), flat normals, no UVs.
template <class Keep>
void appendFace(Shape& shape, const Face& face, Keep keep);
void appendCell(Shape& shape, const Face& face, size_t a, size_t b);

/// Prism with a regular base about the y axis: `sides` lateral faces, corners at `circumradius`, m, caps
/// flat. `smooth` gives the lateral vertices radial normals (those of [000 Fig. 6]: a cylinder); otherwise
/// each lateral face has its own. `rows` cuts the lateral faces along the axis.
[[nodiscard]] Shape prism(uint32_t sides, double circumradius, double length, bool smooth, uint32_t rows = 1);

/// Rectangle in the plane y = 0 facing +y, `width` along x and `depth` along z, m, of columns * rows cells,
/// with UVs 0..1 (u along +x, v along +z) and tangents.
[[nodiscard]] Shape plane(double width, double depth, uint32_t columns = 1, uint32_t rows = 1);

template <class Keep>
void appendFace(Shape& shape, const Face& face, Keep keep) {
    for (size_t a = 0; a + 1 < face.cutsA.size(); ++a)
        for (size_t b = 0; b + 1 < face.cutsB.size(); ++b)
            if (keep(a, b))
                appendCell(shape, face, a, b);
}

} // namespace touchstone::assets
