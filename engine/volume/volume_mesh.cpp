#include "engine/volume/volume_mesh.h"

#include "engine/core/error.h"
#include "engine/grid/sparse_grid.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <memory>
#include <span>

namespace touchstone {

namespace {

constexpr const char* kMeshing = "meshing the surface";
constexpr int kLeaf = SparseGrid::kLeaf;
constexpr int kMostStride = 4;

/// Every `stride`-th voxel, at least the first and the last of an axis; coordinates from 0 on. The layer
/// about them is outside, so that the surface ends at the border: its points are moved there.
class CoarseSamples {
  public:
    CoarseSamples(const Volume& volume, double iso, int stride)
        : volume_(volume), strides_(glm::min(glm::ivec3(stride), volume.size() - 1)),
          outside_(highestOutside(iso)), far_(static_cast<float>(volume.high() - volume.low())),
          size_((volume.size() - 1) / strides_ + 1) {}

    [[nodiscard]] uint64_t count() const { return uint64_t(size_.x) * uint64_t(size_.y) * uint64_t(size_.z); }
    [[nodiscard]] glm::dvec3 voxel(const glm::dvec3& sample) const {
        return glm::clamp(glm::dvec3(strides_) * sample, glm::dvec3(0.0), glm::dvec3(volume_.size() - 1));
    }
    [[nodiscard]] const glm::ivec3& size() const { return size_; }
    [[nodiscard]] float far() const { return far_; }
    /// Whether the surface may pass between the samples low..high, inclusive; outside of the volume is
    /// outside.
    [[nodiscard]] bool crosses(const glm::ivec3& low, const glm::ivec3& high) const {
        const ValueRange range = rangeOf(low, high);
        return range.low <= outside_ && range.high > outside_;
    }
    /// Of a sample where the surface is far; also of places beyond the volume.
    [[nodiscard]] bool inside(const glm::ivec3& at) const { return rangeOf(at, at).low > outside_; }

    /// Positive outside; of the samples from `first` on along a row, of which at most kLeaf + 1 are asked
    /// for.
    void fill(const glm::ivec3& first, std::span<float> values) const {
        std::ranges::fill(values, kBeyond * far_);
        const auto off = [&](int axis) { return first[axis] < 0 || first[axis] >= size_[axis]; };
        const int begin = std::max(first.x, 0);
        const int end = std::min(first.x + static_cast<int>(values.size()), size_.x);
        if (off(1) || off(2) || begin >= end)
            return;
        std::array<float, kLeaf * kMostStride + 1> stored{};
        volume_.row(strides_ * glm::ivec3(begin, first.y, first.z),
                    std::span(stored).first(static_cast<size_t>((end - begin - 1) * strides_.x + 1)));
        for (int x = begin; x < end; ++x)
            values[static_cast<size_t>(x - first.x)] =
                outside_ - stored[static_cast<size_t>((x - begin) * strides_.x)];
    }

  private:
    static constexpr float kBeyond =
        1e-3f; // near zero: the surface is nearer to that layer than to the border

    [[nodiscard]] ValueRange rangeOf(const glm::ivec3& low, const glm::ivec3& high) const {
        const glm::ivec3 last = size_ - 1;
        ValueRange range{INFINITY, -INFINITY};
        if (glm::any(glm::lessThan(low, glm::ivec3(0))) || glm::any(glm::greaterThan(high, last)))
            range.low = -INFINITY;
        const glm::ivec3 a = glm::clamp(low, glm::ivec3(0), last) * strides_ / Volume::kBlock;
        const glm::ivec3 b = glm::clamp(high, glm::ivec3(0), last) * strides_ / Volume::kBlock;
        for (int z = a.z; z <= b.z; ++z)
            for (int y = a.y; y <= b.y; ++y)
                for (int x = a.x; x <= b.x; ++x) {
                    range.low = std::min(range.low, volume_.range({x, y, z}).low);
                    range.high = std::max(range.high, volume_.range({x, y, z}).high);
                }
        return range;
    }

    const Volume& volume_;
    glm::ivec3 strides_;
    float outside_, far_;
    glm::ivec3 size_;
};

/// A leaf's samples and their next ones along each axis, the first axis fastest.
class LeafValues {
  public:
    void fill(const CoarseSamples& samples, const glm::ivec3& first) {
        for (int z = 0; z < kSide; ++z)
            for (int y = 0; y < kSide; ++y)
                samples.fill(first + glm::ivec3(0, y, z),
                             std::span(values_).subspan(index({0, y, z}), static_cast<size_t>(kSide)));
    }
    [[nodiscard]] float at(const glm::ivec3& place) const { return values_[index(place)]; }
    /// Edges that the surface crosses, of those that begin at the leaf's samples.
    [[nodiscard]] uint64_t crossed() const {
        uint64_t edges = 0;
        for (int z = 0; z < kLeaf; ++z)
            for (int y = 0; y < kLeaf; ++y)
                for (int x = 0; x < kLeaf; ++x) {
                    const bool inside = at({x, y, z}) < 0.0f;
                    edges += uint64_t{(at({x + 1, y, z}) < 0.0f) != inside} +
                             uint64_t{(at({x, y + 1, z}) < 0.0f) != inside} +
                             uint64_t{(at({x, y, z + 1}) < 0.0f) != inside};
                }
        return edges;
    }

  private:
    static constexpr int kSide = kLeaf + 1;
    [[nodiscard]] static size_t index(const glm::ivec3& at) {
        return static_cast<size_t>(at.x + kSide * (at.y + kSide * at.z));
    }
    std::array<float, static_cast<size_t>(kSide* kSide* kSide)> values_{};
};

/// Leaves of 8^3 where the surface passes and next to them; elsewhere tiles that tell the side. Null where
/// the surface would have more than `mostFaces`: dual contouring makes one of each edge that it crosses.
std::unique_ptr<SparseGrid> gridOf(const CoarseSamples& samples, uint64_t mostFaces,
                                   const Progress& progress) {
    // Two cores and no more (engine/core/parallel.h).
    auto grid = gridLibrary().create(samples.far(), 2);
    const glm::ivec3 leaves = samples.size() / kLeaf + 1; // the first begins one leaf before
    LeafValues values;
    std::array<float, static_cast<size_t>(kLeaf * kLeaf * kLeaf)> leaf;
    uint64_t faces = 0;
    const auto fill = [&](const glm::ivec3& first) {
        if (!samples.crosses(first - 1, first + kLeaf)) {
            if (samples.inside(first))
                grid->fillLeaf(first, -samples.far());
            return;
        }
        values.fill(samples, first);
        faces += values.crossed();
        size_t node = 0;
        for (int k = 0; k < kLeaf; ++k)
            for (int j = 0; j < kLeaf; ++j)
                for (int i = 0; i < kLeaf; ++i)
                    leaf[node++] = values.at({i, j, k});
        grid->setLeaf(first, leaf);
    };
    for (int z = -1; z <= leaves.z; ++z) {
        progress.step(share(static_cast<size_t>(z + 1), static_cast<size_t>(leaves.z + 1)), kMeshing);
        for (int y = -1; y <= leaves.y; ++y)
            for (int x = -1; x <= leaves.x; ++x)
                fill(kLeaf * glm::ivec3(x, y, z));
        if (faces > mostFaces)
            return nullptr;
    }
    return grid;
}

/// The samples of the smallest stride from `stride` on, which it becomes, whose surface has few enough faces.
std::unique_ptr<SparseGrid> smallEnoughGrid(const Volume& volume, double iso, int& stride, uint64_t mostFaces,
                                            const std::string& shownAs, const Progress& progress) {
    for (; stride <= kMostStride; ++stride)
        if (auto grid = gridOf(CoarseSamples(volume, iso, stride), mostFaces, progress))
            return grid;
    char value[32];
    std::snprintf(value, sizeof value, "%.6g", iso);
    throw Error(shownAs, "",
                std::string("its surface with the value ") + value + " has more than " +
                    std::to_string(mostFaces) + " faces, even from every " + std::to_string(kMostStride) +
                    "th voxel: it is noise",
                "give another --iso, or smooth the volume");
}

} // namespace

SurfaceMesh meshOfVolume(const Volume& volume, double iso, const std::string& shownAs,
                         const Progress& progress, uint64_t mostFaces) {
    volume.checkIso(iso, shownAs);
    int stride = 1;
    while (CoarseSamples(volume, iso, stride).count() > kMostDrawnVoxels)
        ++stride;
    auto grid = smallEnoughGrid(volume, iso, stride, mostFaces, shownAs, progress.part(0.0, 0.4));
    progress.step(0.4, kMeshing);
    const GridFaces faces = grid->zero();
    grid.reset();
    progress.step(0.8, kMeshing);
    if (faces.quads.empty() && faces.triangles.empty())
        throw Error(shownAs, "", "has no surface with this value", "give another --iso");
    SurfaceMesh mesh;
    mesh.stride = stride;
    const CoarseSamples samples(volume, iso, stride);
    mesh.positions.reserve(faces.points.size());
    for (const glm::vec3& point : faces.points)
        mesh.positions.emplace_back(volume.scenePoint(samples.voxel(glm::dvec3(point))));
    mesh.corners = triangleCorners(faces);
    mesh.normals.assign(faces.points.size(), glm::vec3(0.0f));
    for (size_t at = 0; at < mesh.corners.size(); at += 3) {
        const uint32_t* const corner = &mesh.corners[at];
        const glm::vec3 area = glm::cross(mesh.positions[corner[1]] - mesh.positions[corner[0]],
                                          mesh.positions[corner[2]] - mesh.positions[corner[0]]);
        for (int k = 0; k < 3; ++k)
            mesh.normals[corner[k]] += area;
    }
    for (glm::vec3& normal : mesh.normals)
        normal = glm::dot(normal, normal) > 0.0f ? glm::normalize(normal) : glm::vec3(0.0f, 1.0f, 0.0f);
    return mesh;
}

} // namespace touchstone
