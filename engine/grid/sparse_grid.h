#pragma once
// What the program knows of touchstone_grids.so, the one part of it that links OpenVDB: 68,866 symbols with
// long names, 26 ms of every start, which a model without fields does not need. (touchstone_vdb_reader is
// a process of its own.)

#include <glm/glm.hpp>

#include <array>
#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The faces of dual contouring; counter-clockwise seen from where values are positive.
struct GridFaces {
    using Triangle = std::array<uint32_t, 3>;
    using Quad = std::array<uint32_t, 4>;
    std::vector<glm::vec3> points; ///< index coordinates
    std::vector<Triangle> triangles;
    std::vector<Quad> quads;
};

/// Three indices a triangle; a quad is cut along its first diagonal.
[[nodiscard]] std::vector<uint32_t> triangleCorners(const GridFaces& faces);

/// Numbers at whole index coordinates, in leaves of 8^3 that begin at multiples of 8; elsewhere one
/// background. Active are those that count as near the surface. One thread at a time, but for const
/// functions.
class SparseGrid {
  public:
    static constexpr int kLeaf = 8;
    virtual ~SparseGrid() = default;

    /// All of the leaf at `first`; inactive.
    virtual void fillLeaf(const glm::ivec3& first, float value) = 0;
    /// The leaf's values, x fastest; active those between `low` and `high`, exclusive.
    virtual void setLeaf(const glm::ivec3& first, std::span<const float> values, float low = -INFINITY,
                         float high = INFINITY) = 0;
    /// A box of values, x fastest; all active.
    virtual void setBox(const glm::ivec3& low, const glm::ivec3& size, std::span<const float> values) = 0;

    [[nodiscard]] virtual float value(const glm::ivec3& at) const = 0;
    /// The leaf's values, x fastest.
    virtual void copyLeaf(const glm::ivec3& first, std::span<float> values) const = 0;
    /// The zero of the values, without adaptivity.
    [[nodiscard]] virtual GridFaces zero() const = 0;
    /// An OpenVDB file of a level set. Index i is at `origin` + i.x steps[0] + i.y steps[1] + i.z steps[2].
    [[nodiscard]] virtual std::string file(const std::string& name, const std::array<glm::dvec3, 3>& steps,
                                           const glm::dvec3& origin) const = 0;
};

/// Implemented in the library. Any thread.
class GridLibrary {
  public:
    virtual ~GridLibrary() = default;

    /// OpenVDB's: what it makes may differ between versions.
    [[nodiscard]] virtual uint32_t version() const = 0;
    /// `threads`: that it may use where it works, and where it is freed.
    [[nodiscard]] virtual std::unique_ptr<SparseGrid> create(float background, int threads) const = 0;
    /// Signed distances of a closed mesh, negative inside, `band` voxels to either side. `corners`: three a
    /// triangle. Works on all cores, which ask `cancelled` now and then, at once, and free the grid; what is
    /// returned when cancelled is of no use.
    [[nodiscard]] virtual std::unique_ptr<SparseGrid>
    distances(std::span<const glm::dvec3> vertices, std::span<const uint32_t> corners, float band,
              const std::function<bool()>& cancelled) const = 0;
};

/// Loads the library at its first call. Throws Error where it cannot be loaded. Any thread but the servo's.
[[nodiscard]] const GridLibrary& gridLibrary();

/// The name of the function that the library exports: `const GridLibrary* touchstoneGridLibrary()`.
inline constexpr const char* kGridLibrarySymbol = "touchstoneGridLibrary";

} // namespace touchstone
