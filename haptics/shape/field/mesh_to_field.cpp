#include "haptics/shape/field/mesh_to_field.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/core/parallel.h"
#include "engine/grid/sparse_grid.h"
#include "haptics/shape/field/nearest_triangles.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {

namespace {

constexpr const char* kBuilding = "building the distance field";

/// The object's bounds, and room about them for the field's outside and two voxels.
void roomFor(const HapticObject& mesh, double outside, double voxel, glm::dvec3& low, glm::dvec3& size) {
    low = glm::dvec3(INFINITY);
    glm::dvec3 high(-INFINITY);
    for (const uint32_t v : mesh.indices) {
        low = glm::min(low, glm::dvec3(mesh.vertices[v]));
        high = glm::max(high, glm::dvec3(mesh.vertices[v]));
    }
    const double margin = outside + 2.0 * voxel;
    low -= margin;
    size = high - low + margin;
}

FieldLayout layoutFor(const HapticObject& mesh, const FieldRequest& request) {
    if (!(request.voxel > 0.0) || !std::isfinite(request.voxel))
        throw Error(mesh.name, "", "the voxel size is no positive number", "give a voxelSize above 0");
    if (const double finest = finestVoxel(mesh, request.outside); request.voxel < finest)
        throw Error(mesh.name, "",
                    "a distance field with voxels of " + std::to_string(request.voxel) +
                        " of its size has more than " + std::to_string(kMostFieldCells) + " cells",
                    "make the voxels at least " + std::to_string(finest / request.voxel) + " times as large");
    FieldLayout layout{.voxel = request.voxel};
    glm::dvec3 size;
    roomFor(mesh, request.outside, request.voxel, layout.origin, size);
    layout.cells = glm::ivec3(glm::ceil(size / request.voxel));
    return layout;
}

/// The relief is whole up to here from the surface: over all places where it puts the surface, and two
/// voxels.
double wholeUpTo(const FieldRelief& relief, double voxel) {
    return relief.highest() + 2.0 * voxel;
}

/// Subtracts the relief from the nodes of a brick, in proportion to what reliefShare leaves of it.
void layRelief(const FieldLayout& layout, const FieldRequest& request, const glm::ivec3& first,
               std::span<float> nodes) {
    const double whole = wholeUpTo(request.relief, request.voxel);
    FieldRelief relief = request.relief;
    if (relief.noiseWavelength < layout.voxel)
        relief.noiseWavelength = 0.0; // no two nodes share a value
    size_t i = 0;
    for (int z = 0; z < FieldGrid::kNodes; ++z)
        for (int y = 0; y < FieldGrid::kNodes; ++y)
            for (int x = 0; x < FieldGrid::kNodes; ++x) {
                float& node = nodes[i++];
                const auto f = static_cast<double>(node);
                const double share = reliefShare(f, whole, f < 0.0 ? request.inside : request.outside);
                if (!(share > 0.0))
                    continue;
                const glm::ivec3 at = first + glm::ivec3(x, y, z);
                const glm::dvec3 place = layout.origin + layout.voxel * glm::dvec3(at);
                node = static_cast<float>(f - share * reliefAt(relief, place, at));
            }
}

std::vector<glm::dvec3> inGrid(const HapticObject& mesh, const FieldLayout& layout) {
    std::vector<glm::dvec3> places;
    places.reserve(mesh.vertices.size());
    for (const glm::vec3& v : mesh.vertices)
        places.push_back((glm::dvec3(v) - layout.origin) / layout.voxel);
    return places;
}

/// OpenVDB's field of a closed mesh in the narrowest band that it makes, voxels. What is taken from it are
/// the signs, which it finds from outside, and that nodes at faces inside of another body are not at the
/// surface: up to kSure voxels no distance is less than its own, which is that to the triangles in float
/// elsewhere. (With the triangles' distance alone such a face is a zero of the field, on whose rim the proxy
/// runs out of moves; so it does where only what OpenVDB puts kSure deep is kept there.)
std::unique_ptr<SparseGrid> sidesOf(const HapticObject& mesh, const std::vector<glm::dvec3>& places,
                                    const Progress& progress) {
    constexpr float kBand = 2.0f;
    constexpr double kTimePerTriangle = 1e-5; // s
    const EstimatedProgress estimate(progress, kBuilding,
                                     0.05 + kTimePerTriangle * static_cast<double>(mesh.triangleCount()));
    auto sides = gridLibrary().distances(places, mesh.indices, kBand, [&] { return progress.cancelled(); });
    progress.stopIfCancelled();
    return sides;
}
constexpr float kSure = 0.75f;

/// Distances from the mesh at the nodes of the bricks, each of 8^3 cells, without those that the next bricks
/// have, too.
class NodeDistances {
  public:
    static constexpr int kSide = FieldGrid::kBrick;
    using Nodes = std::array<float, size_t{kSide} * kSide * kSide>;

    /// `closed`: negative inside; else less half of the thickness of a shell. Throws Cancelled.
    NodeDistances(const HapticObject& mesh, const FieldLayout& layout, const FieldRequest& request,
                  bool closed, const Progress& progress);

    /// The nodes of a brick, x fastest. Those beyond the grid may be anything.
    void copyBrick(const glm::ivec3& first, std::span<float> nodes) const noexcept;

  private:
    /// All of its nodes are `flat`, where it has none.
    struct Block {
        std::unique_ptr<Nodes> nodes;
        float flat = 0.0f;
    };
    /// What a thread keeps from one block to the next.
    struct Reader {
        const SparseGrid* sides = nullptr; ///< voxels: negative inside; null: a shell
        Nodes block{};                     ///< of the sides, where a block is measured
        uint32_t known = 0;                ///< NearestTriangles::lower
    };
    static constexpr int kPair = 2; ///< blocks a side whose middles are measured at once
    static_assert(kPair * kPair * kPair == NearestTriangles::kPlaces);

    [[nodiscard]] size_t numberOf(const glm::ivec3& block) const noexcept {
        const auto nx = static_cast<size_t>(count_.x), ny = static_cast<size_t>(count_.y);
        return static_cast<size_t>(block.x) +
               nx * (static_cast<size_t>(block.y) + ny * static_cast<size_t>(block.z));
    }
    void measurePair(const glm::ivec3& block, Reader& reader);
    void measureBlock(const glm::ivec3& block, double middle, Reader& reader);
    /// Voxels: as far as distances are told.
    [[nodiscard]] double reach(float side) const noexcept { return side < 0.0f ? farInside_ : farOutside_; }
    [[nodiscard]] float valueOf(double squared, float side) const noexcept;

    double voxel_, shell_; ///< object units
    double farInside_, farOutside_;
    glm::ivec3 count_; ///< of blocks
    NearestTriangles triangles_;
    std::vector<Block> blocks_;
};

NodeDistances::NodeDistances(const HapticObject& mesh, const FieldLayout& layout, const FieldRequest& request,
                             bool closed, const Progress& progress)
    : voxel_(layout.voxel), shell_(closed ? 0.0 : layout.voxel),
      // A little more than is told, so that what is beyond is clamped to one number.
      farInside_(request.inside / layout.voxel + 0.01),
      farOutside_((request.outside + shell_) / layout.voxel + 0.01),
      // The last brick ends with a node of the block beyond it.
      count_((layout.cells + (kSide - 1)) / kSide + 1), triangles_(inGrid(mesh, layout), mesh.indices),
      blocks_(numberOf({0, 0, count_.z})) {
    const auto sides = closed ? sidesOf(mesh, inGrid(mesh, layout), progress.part(0.0, 0.4)) : nullptr;
    const glm::ivec3 pairs = (count_ + (kPair - 1)) / kPair;
    // A row of pairs counts as a block of inParallel.
    const auto rows = static_cast<size_t>(pairs.y) * static_cast<size_t>(pairs.z);
    inParallel(rows * kProgressWork, progress.part(0.4, 1.0), kBuilding, [&](size_t begin, size_t) {
        const auto row = static_cast<int>(begin / kProgressWork);
        Reader reader{.sides = sides.get()};
        for (int x = 0; x < pairs.x; ++x)
            measurePair(kPair * glm::ivec3(x, row % pairs.y, row / pairs.y), reader);
    });
}

/// Blocks of which no node is as near to the mesh as distances are told are flat.
void NodeDistances::measurePair(const glm::ivec3& block, Reader& reader) {
    constexpr double kHalf = 0.5 * (kSide - 1);
    const double corner = std::sqrt(3.0) * kHalf, most = std::max(farInside_, farOutside_) + corner;
    std::array<glm::dvec3, NearestTriangles::kPlaces> middles;
    std::array<double, NearestTriangles::kPlaces> squared;
    squared.fill(most * most);
    const auto own = [&](size_t k) { return block + glm::ivec3(k & 1, k >> 1 & 1, k >> 2); };
    for (size_t k = 0; k < middles.size(); ++k)
        middles[k] = glm::dvec3(kSide * own(k)) + kHalf;
    triangles_.lower(middles, squared, reader.known);
    for (size_t k = 0; k < middles.size(); ++k) {
        if (glm::any(glm::greaterThanEqual(own(k), count_)))
            continue;
        const double distance = std::sqrt(squared[k]);
        // Of the whole block where it is far.
        const float side = reader.sides != nullptr ? reader.sides->value(kSide * own(k)) : 0.0f;
        if (distance - corner >= reach(side))
            blocks_[numberOf(own(k))].flat = valueOf(squared[k], side);
        else
            measureBlock(own(k), distance, reader);
    }
}

void NodeDistances::measureBlock(const glm::ivec3& block, double middle, Reader& reader) {
    auto& nodes = blocks_[numberOf(block)].nodes = std::make_unique<Nodes>();
    constexpr double kHalf = 0.5 * (kSide - 1);
    std::array<glm::dvec3, NearestTriangles::kPlaces> places;
    std::array<double, NearestTriangles::kPlaces> squared;
    std::array<float, NearestTriangles::kPlaces> sides;
    static_assert(kSide == SparseGrid::kLeaf);
    if (reader.sides != nullptr)
        reader.sides->copyLeaf(kSide * block, reader.block);
    const auto numberIn = [](const glm::ivec3& node) {
        return static_cast<size_t>(node.x + kSide * (node.y + kSide * node.z));
    };
    for (int z = 0; z < kSide; z += 2)
        for (int y = 0; y < kSide; y += 2)
            for (int x = 0; x < kSide; x += 2) {
                const auto node = [&](size_t k) {
                    return glm::ivec3(x, y, z) + glm::ivec3(k & 1, k >> 1 & 1, k >> 2);
                };
                for (size_t k = 0; k < places.size(); ++k) {
                    places[k] = glm::dvec3(kSide * block + node(k));
                    sides[k] = reader.block[numberIn(node(k))];
                    // No farther than the way to the middle and on to its nearest place.
                    const double most = std::min(
                        reach(sides[k]), middle + glm::distance(glm::dvec3(node(k)), glm::dvec3(kHalf)));
                    squared[k] = most * most;
                }
                triangles_.lower(places, squared, reader.known);
                for (size_t k = 0; k < places.size(); ++k)
                    (*nodes)[numberIn(node(k))] = valueOf(squared[k], sides[k]);
            }
}

float NodeDistances::valueOf(double squared, float side) const noexcept {
    const auto least = static_cast<double>(std::min(std::abs(side), kSure));
    const double distance = voxel_ * std::max(std::sqrt(squared), least);
    return static_cast<float>((side < 0.0f ? -distance : distance) - shell_);
}

void NodeDistances::copyBrick(const glm::ivec3& first, std::span<float> nodes) const noexcept {
    float* to = nodes.data();
    for (int z = 0; z < FieldGrid::kNodes; ++z)
        for (int y = 0; y < FieldGrid::kNodes; ++y)
            for (int x = 0; x < FieldGrid::kNodes; x += kSide) {
                const glm::ivec3 node = first + glm::ivec3(x, y, z), in = node % kSide;
                const Block& block = blocks_[numberOf(node / kSide)];
                const int count = std::min(kSide, FieldGrid::kNodes - x);
                if (block.nodes == nullptr)
                    std::fill_n(to, count, block.flat);
                else
                    std::copy_n(block.nodes->data() + kSide * (in.y + kSide * in.z), count, to);
                to += count;
            }
}

/// `closed`: negative inside; else a shell.
std::shared_ptr<const FieldGrid> gridOf(const HapticObject& mesh, const FieldLayout& layout,
                                        const FieldRequest& request, bool closed, const Progress& progress) {
    const NodeDistances distances(mesh, layout, request, closed, progress.part(0.0, 0.7));
    progress.step(0.7, kBuilding);
    const auto layers = static_cast<double>((layout.cells.z + FieldGrid::kBrick - 1) / FieldGrid::kBrick);
    return std::make_shared<const FieldGrid>(
        layout, request.inside, request.outside, [&](const glm::ivec3& first, std::span<float> nodes) {
            if (first.x == 0 && first.y == 0)
                progress.step(0.7 + 0.3 * (first.z / FieldGrid::kBrick) / layers, kBuilding);
            distances.copyBrick(first, nodes);
            if (!request.relief.empty())
                layRelief(layout, request, first, nodes);
        });
}

} // namespace

double reachOf(const FieldRelief& relief, double voxel) {
    return relief.empty() ? 0.0 : 2.0 * wholeUpTo(relief, voxel);
}

double finestVoxel(const HapticObject& mesh, double outside) {
    glm::dvec3 low, size;
    roomFor(mesh, outside, 0.0, low, size);
    // The margin of two voxels and the rounding up add at most five cells to each axis.
    const auto cells = [&](double voxel) {
        const glm::dvec3 n = size / voxel + 5.0;
        return n.x * n.y * n.z;
    };
    double voxel = std::cbrt(size.x * size.y * size.z / static_cast<double>(kMostFieldCells));
    while (cells(voxel) > static_cast<double>(kMostFieldCells))
        voxel *= 1.01;
    return voxel;
}

std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh, const FieldRequest& asked,
                                             const Progress& progress) {
    progress.stopIfCancelled();
    // Clamped values must not enter a cell through which the surface passes.
    FieldRequest request = asked;
    const double least = std::max(2.0 * asked.voxel, reachOf(asked.relief, asked.voxel));
    request.inside = std::max(asked.inside, least);
    request.outside = std::max(asked.outside, least);
    const FieldLayout layout = layoutFor(mesh, request);
    if (mesh.closed) {
        const auto solid = gridOf(mesh, layout, request, true, progress.part(0.0, 0.6));
        if (solid->low().x <= solid->high().x)
            return solid;
    }
    return gridOf(mesh, layout, request, false, progress.part(0.6, 1.0));
}

namespace {

/// Of all that the field depends on; kBuilder: of this file.
uint64_t keyOf(const HapticObject& mesh, const FieldRequest& request) {
    constexpr int kBuilder = 2;
    Hash64 hash;
    hash.add(kBuilder);
    hash.add(FieldGrid::kBrick);
    hash.add(gridLibrary().version());
    hash.add(mesh.closed);
    for (const double number : {request.voxel, request.inside, request.outside})
        hash.add(number);
    if (const FieldRelief& relief = request.relief; !relief.empty()) {
        for (const double number :
             {relief.noise, relief.noiseWavelength, relief.lattice, relief.latticeWavelength})
            hash.add(number);
        hash.add(relief.seed);
    }
    hash.add(mesh.vertices.size());
    for (const glm::vec3& v : mesh.vertices)
        for (int axis = 0; axis < 3; ++axis)
            hash.add(v[axis]);
    hash.add(mesh.indices.size());
    for (const uint32_t index : mesh.indices)
        hash.add(index);
    return hash.value();
}

} // namespace

std::shared_ptr<const FieldGrid> fieldOfMesh(const HapticObject& mesh, const FieldRequest& request,
                                             const FieldCache& cache, const Progress& progress) {
    const uint64_t key = keyOf(mesh, request);
    if (auto kept = cache.find(key))
        return kept;
    auto built = fieldOfMesh(mesh, request, progress);
    cache.keep(key, *built);
    return built;
}

} // namespace touchstone
