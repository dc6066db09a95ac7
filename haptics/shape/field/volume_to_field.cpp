#include "haptics/shape/field/volume_to_field.h"

#include "engine/core/parallel.h"
#include "haptics/shape/field/iso_distance.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone {

namespace {

constexpr int kMargin = 2; // nodes beyond the volume on each side

/// Where the nodes lie in the volume.
struct NodePlan {
    glm::ivec3 nodes{0};
    double voxel = 0.0;    ///< m
    glm::dmat3 axes{1.0};  ///< columns: unit, at right angles, right-handed; scene frame
    glm::dvec3 first{0.0}; ///< scene frame
    bool onVoxels = false; ///< node (i, j, k) is voxel (i, j, k) - kMargin
    double coarser = 1.0;
};

/// The axes' directions, the first kept, the others turned to right angles.
glm::dmat3 rightAngled(const glm::dmat3& axes) {
    const glm::dvec3 x = glm::normalize(axes[0]);
    const glm::dvec3 y = glm::normalize(axes[1] - glm::dot(axes[1], x) * x);
    return {x, y, glm::cross(x, y)};
}

NodePlan planFor(const Volume& volume, double mostNodes) {
    constexpr double kEqual = 1e-5;
    const glm::dmat3& steps = volume.facts().axes;
    NodePlan plan;
    plan.axes = rightAngled(steps);
    const double finest = std::min({glm::length(steps[0]), glm::length(steps[1]), glm::length(steps[2])});
    plan.voxel = finest;
    plan.onVoxels = true;
    for (int axis = 0; axis < 3; ++axis)
        plan.onVoxels =
            plan.onVoxels && glm::length(steps[axis] - finest * plan.axes[axis]) < kEqual * finest;
    // The box of the volume along the axes.
    Bounds box;
    for (int corner = 0; corner < 8; ++corner)
        box.include(
            glm::transpose(plan.axes) *
            (steps * (glm::dvec3(volume.size() - 1) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2))));
    const auto count = [&](double voxel) {
        return glm::max(glm::dvec3(1.0), glm::ceil(box.extent() / voxel - kEqual)) + 1.0 + 2.0 * kMargin;
    };
    const auto all = [&](double voxel) {
        const glm::dvec3 n = count(voxel);
        return n.x * n.y * n.z;
    };
    const auto longest = [&](double voxel) {
        const glm::dvec3 n = count(voxel);
        return std::max({n.x, n.y, n.z}) - 1.0;
    };
    while (all(plan.voxel) > mostNodes || longest(plan.voxel) > FieldGrid::kMostOnAxis) {
        plan.voxel *= std::max(1.001, std::cbrt(all(plan.voxel) / mostNodes));
        plan.onVoxels = false;
    }
    plan.coarser = plan.voxel / finest;
    plan.nodes = plan.onVoxels ? volume.size() + 2 * kMargin : glm::ivec3(count(plan.voxel));
    plan.first = volume.facts().origin + plan.axes * (box.low - plan.voxel * kMargin);
    return plan;
}

/// Coordinates in the volume, in voxels, of a node.
struct VoxelFromNode {
    glm::dmat3 linear{1.0};
    glm::dvec3 offset{0.0};
    [[nodiscard]] glm::dvec3 operator()(const glm::dvec3& node) const { return linear * node + offset; }
};

VoxelFromNode voxelFromNode(const Volume& volume, const NodePlan& plan) {
    if (plan.onVoxels)
        return {glm::dmat3(1.0), glm::dvec3(-kMargin)};
    const glm::dmat3 voxelFromScene = glm::inverse(volume.facts().axes);
    return {voxelFromScene * (plan.voxel * plan.axes), voxelFromScene * (plan.first - volume.facts().origin)};
}

/// highestOutside - value, interpolated between voxels; beyond the volume that of its border.
class Sampler {
  public:
    Sampler(const Volume& volume, double iso) : volume_(volume), outside_(highestOutside(iso)) {}

    [[nodiscard]] float at(const glm::dvec3& place) const {
        const glm::dvec3 inside = glm::clamp(place, glm::dvec3(0.0), glm::dvec3(volume_.size() - 1));
        const glm::ivec3 cell = glm::min(glm::ivec3(inside), volume_.size() - 2);
        const glm::dvec3 u = inside - glm::dvec3(cell);
        std::array<double, 4> rows{};
        for (size_t k = 0; k < rows.size(); ++k) {
            std::array<float, 2> pair{};
            volume_.row(cell + glm::ivec3(0, k & 1, k >> 1), pair);
            rows[k] = (1.0 - u.x) * static_cast<double>(pair[0]) + u.x * static_cast<double>(pair[1]);
        }
        const double near = (1.0 - u.y) * rows[0] + u.y * rows[1],
                     far = (1.0 - u.y) * rows[2] + u.y * rows[3];
        return static_cast<float>(static_cast<double>(outside_) - ((1.0 - u.z) * near + u.z * far));
    }

    /// A row of nodes that are voxels, with the margin.
    void row(int y, int z, std::span<float> values) const {
        const glm::ivec3 n = volume_.size();
        const std::span<float> own = values.subspan(kMargin, static_cast<size_t>(n.x));
        volume_.row({0, std::clamp(y - kMargin, 0, n.y - 1), std::clamp(z - kMargin, 0, n.z - 1)}, own);
        for (float& value : own)
            value = outside_ - value;
        std::ranges::fill(values.first(kMargin), own.front());
        std::ranges::fill(values.last(kMargin), own.back());
    }

  private:
    const Volume& volume_;
    float outside_;
};

NodeValues valuesAt(const Volume& volume, double iso, const NodePlan& plan, const Progress& progress) {
    NodeValues grid{.nodes = plan.nodes, .value = {}};
    const size_t layer = static_cast<size_t>(plan.nodes.x) * static_cast<size_t>(plan.nodes.y);
    grid.value.resize(layer * static_cast<size_t>(plan.nodes.z));
    const Sampler sampler(volume, iso);
    const VoxelFromNode voxel = voxelFromNode(volume, plan);
    // A layer counts as a block of inParallel.
    inParallel(static_cast<size_t>(plan.nodes.z) * kProgressWork, progress, "reading the volume",
               [&](size_t begin, size_t) {
                   const auto z = static_cast<int>(begin / kProgressWork);
                   for (int y = 0; y < plan.nodes.y; ++y) {
                       const std::span<float> row =
                           std::span(grid.value)
                               .subspan(layer * static_cast<size_t>(z) +
                                            static_cast<size_t>(y) * static_cast<size_t>(plan.nodes.x),
                                        static_cast<size_t>(plan.nodes.x));
                       if (plan.onVoxels)
                           sampler.row(y, z, row);
                       else
                           for (int x = 0; x < plan.nodes.x; ++x)
                               row[static_cast<size_t>(x)] = sampler.at(voxel(glm::dvec3(x, y, z)));
                   }
               });
    return grid;
}

/// Distance from the volume's border in voxels of the field, negative within: exact inside, too small near
/// edges outside.
class BorderDistance {
  public:
    BorderDistance(const Volume& volume, const NodePlan& plan)
        : voxel_(voxelFromNode(volume, plan)), last_(volume.size() - 1) {
        const glm::dmat3 rows = glm::transpose(voxel_.linear);
        for (int axis = 0; axis < 3; ++axis)
            perVoxel_[axis] = 1.0 / glm::length(rows[axis]);
    }
    [[nodiscard]] double at(const glm::dvec3& node) const {
        const glm::dvec3 place = voxel_(node);
        const glm::dvec3 beyond = glm::max(-place, place - last_) * perVoxel_;
        return std::max({beyond.x, beyond.y, beyond.z});
    }

  private:
    VoxelFromNode voxel_;
    glm::dvec3 last_, perVoxel_{1.0};
};

} // namespace

VolumeField fieldOfVolume(const Volume& volume, double iso, const FieldReach& reach,
                          const std::string& shownAs, const Progress& progress, uint64_t mostNear) {
    volume.checkIso(iso, shownAs);
    VolumeField field;
    NodePlan plan;
    NodeValues grid;
    double inside = 0.0, outside = 0.0;
    field.mostNodes = kMostVolumeNodes;
    for (bool done = false; !done;) {
        grid = {};
        plan = planFor(volume, field.mostNodes);
        inside = std::clamp(reach.inside / plan.voxel, 2.0, kDeepestVoxels);
        outside = std::max(reach.outside / plan.voxel, 2.0);
        grid = valuesAt(volume, iso, plan, progress.part(0.0, 0.1));
        // A field of no more nodes cannot have more of them near the surface: there are two rounds at most.
        done = toDistances(grid, inside, outside, mostNear, progress.part(0.1, 0.8));
        if (!done)
            field.mostNodes = static_cast<double>(mostNear);
    }
    // Object frame: the box's middle, and its longest side.
    const glm::dvec3 size = plan.voxel * glm::dvec3(plan.nodes - 1);
    const double unit = std::max({size.x, size.y, size.z});
    const double voxel = plan.voxel / unit;
    field.coarser = plan.coarser;
    field.sceneFromObject = {unit, glm::quat_cast(plan.axes), plan.first + plan.axes * (0.5 * size)};
    const BorderDistance border(volume, plan);
    const glm::ivec3 n = plan.nodes;
    const auto layers = static_cast<double>((n.z + FieldGrid::kBrick - 1) / FieldGrid::kBrick);
    field.grid = std::make_shared<const FieldGrid>(
        FieldLayout{.origin = -0.5 * size / unit, .voxel = voxel, .cells = n - 1}, inside * voxel,
        outside * voxel, [&](const glm::ivec3& first, std::span<float> nodes) {
            if (first.x == 0 && first.y == 0)
                progress.step(0.8 + 0.2 * (first.z / FieldGrid::kBrick) / layers,
                              "building the distance field");
            size_t i = 0;
            for (int z = 0; z < FieldGrid::kNodes; ++z)
                for (int y = 0; y < FieldGrid::kNodes; ++y) {
                    const int row = std::min(first.y + y, n.y - 1), layer = std::min(first.z + z, n.z - 1);
                    const float* const values =
                        grid.value.data() +
                        static_cast<size_t>(n.x) * (static_cast<size_t>(row) +
                                                    static_cast<size_t>(n.y) * static_cast<size_t>(layer));
                    for (int x = 0; x < FieldGrid::kNodes; ++x) {
                        const int column = std::min(first.x + x, n.x - 1);
                        auto distance = static_cast<double>(values[column]);
                        if (distance < outside) // else nothing is farther than the field tells
                            distance = std::max(distance, border.at(glm::dvec3(column, row, layer)));
                        nodes[i++] = static_cast<float>(voxel * distance);
                    }
                }
        });
    return field;
}

} // namespace touchstone
