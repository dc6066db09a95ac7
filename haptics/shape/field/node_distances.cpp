#include "haptics/shape/field/node_distances.h"

#include "engine/core/parallel.h"

#include <openvdb/tools/MeshToVolume.h>

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone {

namespace {

/// OpenVDB asks it now and then whether to stop. As its base it is given to what OpenVDB's library holds
/// compiled.
class Interrupter final : public openvdb::util::NullInterrupter {
  public:
    explicit Interrupter(const Progress& progress) : progress_(progress) {}
    bool wasInterrupted(int = -1) override { return progress_.cancelled(); }

  private:
    const Progress& progress_;
};

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
openvdb::FloatGrid::Ptr sidesOf(const HapticObject& mesh, const std::vector<glm::dvec3>& places,
                                const Progress& progress) {
    constexpr float kBand = 2.0f;
    std::vector<openvdb::Vec3s> points;
    points.reserve(places.size());
    for (const glm::dvec3& p : places)
        points.emplace_back(p.x, p.y, p.z);
    std::vector<openvdb::Vec3I> triangles;
    triangles.reserve(mesh.triangleCount());
    for (size_t t = 0; t < mesh.triangleCount(); ++t)
        triangles.emplace_back(mesh.indices[3 * t], mesh.indices[3 * t + 1], mesh.indices[3 * t + 2]);
    const openvdb::tools::QuadAndTriangleDataAdapter<openvdb::Vec3s, openvdb::Vec3I> soup(points, triangles);
    const auto unit = openvdb::math::Transform::createLinearTransform(1.0);
    Interrupter interrupter(progress);
    auto sides = openvdb::tools::meshToVolume<openvdb::FloatGrid>(
        static_cast<openvdb::util::NullInterrupter&>(interrupter), soup, *unit, kBand, kBand,
        openvdb::tools::DISABLE_RENORMALIZATION);
    progress.stopIfCancelled();
    return sides;
}
constexpr float kSure = 0.75f;

constexpr double kHalf = 0.5 * (FieldGrid::kBrick - 1); // voxels: from a block's first node to its middle
const double kCorner = std::sqrt(3.0) * kHalf;

} // namespace

/// What a thread reads: voxels, negative inside. Zeros where there is no grid.
class NodeDistances::Sides {
  public:
    explicit Sides(const openvdb::FloatGrid* grid) {
        if (grid != nullptr)
            grid_.emplace(grid->getConstAccessor());
    }
    [[nodiscard]] float at(const glm::ivec3& node) const {
        return grid_ ? grid_->getValue({node.x, node.y, node.z}) : 0.0f;
    }

  private:
    std::optional<openvdb::FloatGrid::ConstAccessor> grid_;
};

NodeDistances::NodeDistances(const HapticObject& mesh, const FieldLayout& layout, const Reach& reach,
                             bool closed, const Progress& progress)
    : voxel_(layout.voxel), shell_(closed ? 0.0 : layout.voxel),
      // A little more than is told, so that what is beyond is clamped to one number.
      farInside_(reach.inside / layout.voxel + 0.01),
      farOutside_((reach.outside + shell_) / layout.voxel + 0.01),
      // The last brick ends with a node of the block beyond it.
      count_((layout.cells + (kSide - 1)) / kSide + 1), triangles_(inGrid(mesh, layout), mesh.indices),
      blocks_(numberOf({0, 0, count_.z})) {
    const glm::ivec3 pairs = this->pairs();
    // A row of pairs counts as a block of inParallel, and so do the sides, which come first.
    const auto rows = static_cast<size_t>(pairs.y) * static_cast<size_t>(pairs.z);
    openvdb::FloatGrid::Ptr sides;
    {
        constexpr double kTimePerTriangle = 1e-5, kTimePerBlock = 2e-5; // s
        const EstimatedProgress estimate(progress.part(0.0, 0.6), kBuildingField,
                                         0.05 + kTimePerTriangle * static_cast<double>(mesh.triangleCount()) +
                                             kTimePerBlock * static_cast<double>(blocks_.size()));
        inParallel((rows + 1) * kProgressWork, progress.silent(), kBuildingField, [&](size_t begin, size_t) {
            if (const size_t row = begin / kProgressWork; row > 0)
                measureNear(row - 1);
            else if (closed)
                sides = sidesOf(mesh, inGrid(mesh, layout), progress);
        });
    }
    inParallel(rows * kProgressWork, progress.part(0.6, 1.0), kBuildingField,
               [&](size_t begin, size_t) { measureRest(begin / kProgressWork, Sides(sides.get())); });
}

/// The pairs of a row along x.
template <class Visit>
void NodeDistances::eachPairOf(size_t row, const Visit& visit) const {
    const glm::ivec3 pairs = this->pairs();
    const auto ny = static_cast<size_t>(pairs.y);
    for (int x = 0; x < pairs.x; ++x)
        visit(glm::ivec3(x, static_cast<int>(row % ny), static_cast<int>(row / ny)));
}

/// Calls visit(block, place among those of the pair).
template <class Visit>
void NodeDistances::eachBlockOf(const glm::ivec3& pair, const Visit& visit) const {
    for (size_t k = 0; k < NearestTriangles::kPlaces; ++k)
        if (const glm::ivec3 block = kPair * pair + glm::ivec3(k & 1, k >> 1 & 1, k >> 2);
            glm::all(glm::lessThan(block, count_)))
            visit(block, k);
}

void NodeDistances::measureMiddles(const glm::ivec3& pair, uint32_t& known) {
    const double most = std::max(farInside_, farOutside_) + kCorner;
    std::array<glm::dvec3, NearestTriangles::kPlaces> middles;
    std::array<double, NearestTriangles::kPlaces> squared;
    squared.fill(most * most);
    for (size_t k = 0; k < middles.size(); ++k)
        middles[k] = glm::dvec3(kSide * (kPair * pair + glm::ivec3(k & 1, k >> 1 & 1, k >> 2))) + kHalf;
    triangles_.lower(middles, squared, known);
    eachBlockOf(pair, [&](const glm::ivec3& block, size_t k) {
        blocks_[numberOf(block)].middle = std::sqrt(squared[k]);
    });
}

/// Without signs, as far as reachAt(node), voxels.
template <class ReachAt>
void NodeDistances::measureNodes(const glm::ivec3& block, uint32_t& known, const ReachAt& reachAt) {
    const double middle = blocks_[numberOf(block)].middle;
    auto& nodes = blocks_[numberOf(block)].nodes = std::make_unique<Nodes>();
    std::array<glm::dvec3, NearestTriangles::kPlaces> places;
    std::array<double, NearestTriangles::kPlaces> squared;
    for (int z = 0; z < kSide; z += 2)
        for (int y = 0; y < kSide; y += 2)
            for (int x = 0; x < kSide; x += 2) {
                const auto node = [&](size_t k) {
                    return glm::ivec3(x, y, z) + glm::ivec3(k & 1, k >> 1 & 1, k >> 2);
                };
                for (size_t k = 0; k < places.size(); ++k) {
                    const glm::ivec3 at = kSide * block + node(k);
                    places[k] = glm::dvec3(at);
                    // No farther than the way to the middle and on to its nearest place.
                    const double most =
                        std::min(reachAt(at), middle + glm::distance(glm::dvec3(node(k)), glm::dvec3(kHalf)));
                    squared[k] = most * most;
                }
                triangles_.lower(places, squared, known);
                for (size_t k = 0; k < places.size(); ++k) {
                    const glm::ivec3 at = node(k);
                    (*nodes)[static_cast<size_t>(at.x + kSide * (at.y + kSide * at.z))] =
                        bare(std::sqrt(squared[k]));
                }
            }
}

/// The blocks that may have a node within both reaches, and the middles of the others.
void NodeDistances::measureNear(size_t row) {
    const double least = std::min(farInside_, farOutside_), most = std::max(farInside_, farOutside_);
    uint32_t known = 0;
    eachPairOf(row, [&](const glm::ivec3& pair) {
        measureMiddles(pair, known);
        eachBlockOf(pair, [&](const glm::ivec3& block, size_t) {
            if (blocks_[numberOf(block)].middle - kCorner < least)
                measureNodes(block, known, [&](const glm::ivec3&) { return most; });
        });
    });
}

/// Blocks of which no node is as near to the mesh as distances are told are flat.
void NodeDistances::measureRest(size_t row, const Sides& sides) {
    uint32_t known = 0;
    eachPairOf(row, [&](const glm::ivec3& pair) {
        eachBlockOf(pair, [&](const glm::ivec3& block, size_t) {
            Block& own = blocks_[numberOf(block)];
            const float side = sides.at(kSide * block); // of the whole block where it is far
            if (own.nodes == nullptr && own.middle - kCorner >= reach(side)) {
                own.flat = valueOf(bare(own.middle), side);
                return;
            }
            if (own.nodes == nullptr)
                measureNodes(block, known, [&](const glm::ivec3& node) { return reach(sides.at(node)); });
            sign(block, sides);
        });
    });
}

void NodeDistances::sign(const glm::ivec3& block, const Sides& sides) {
    size_t i = 0;
    Nodes& nodes = *blocks_[numberOf(block)].nodes;
    for (int z = 0; z < kSide; ++z)
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x, ++i)
                nodes[i] = valueOf(nodes[i], sides.at(kSide * block + glm::ivec3(x, y, z)));
}

/// Rounding to floats keeps the order: these are the bits of the bounded distance.
float NodeDistances::valueOf(float bare, float side) const noexcept {
    const auto least = static_cast<double>(std::min(std::abs(side), kSure));
    const float value = std::max(std::min(bare, this->bare(reach(side))), this->bare(least));
    return side < 0.0f ? -value : value;
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

} // namespace touchstone
