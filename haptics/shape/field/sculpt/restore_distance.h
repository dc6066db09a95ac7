#pragma once
// From changed values back to distances, in the part of a window that the change reaches.

#include "haptics/shape/field/sculpt/field_window.h"
#include "haptics/shape/field/sculpt/node_queue.h"
#include "haptics/shape/field/vectors.h"

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

namespace touchstone {

/// How far the field tells distances, object units.
struct DistanceReach {
    double inside = 0.0, outside = 0.0;
};

enum class ExactSide : uint8_t { None, Inside, Outside };

/// Makes the values of a window distances again, where those before the dab were. Kept to the last bit are
/// the nodes whose nearest place on the surface is farther than a voxel from the zone, unless the new surface
/// is nearer by kNearer. Closest points are handed on from the nodes at the surface, by increasing distance
/// and from each node to its 26 neighbours, and slid along the surface to the foot of the node that takes
/// them: no equation is discretised, so small balls are as exact as planes. One thread; the order of equal
/// distances is that of the nodes.
class DistanceRestorer {
  public:
    /// The window's active bricks hold all nodes that may have their nearest place in the zone. `exact`: the
    /// side of the surface where the values are distances already. `meanwhile` is called between steps.
    /// Returns changedNodes.
    std::vector<NodeBox> run(FieldWindow& window, const SculptZone& zone, const DistanceReach& reach,
                             ExactSide exact = ExactSide::None, const std::function<void()>& meanwhile = {});

  private:
    static constexpr float kNearer = 0.02f; // voxels
    /// None: of no active brick. Given: kept, and handed on. Given and Reached have a point.
    enum class Node : uint8_t { None, Kept, Given, Near, Open, Reached };
    void begin();
    [[nodiscard]] bool findNear();
    void open();
    [[nodiscard]] uint32_t mayOpen(const glm::ivec3& first, size_t index, int count) const;
    [[nodiscard]] uint32_t restsElsewhere(size_t index, Eight squared, Eight f, const glm::vec3& way) const;
    void seedKept();
    void march();
    void handOn(const glm::ivec3& place, size_t node, const glm::dvec3& point);
    void offer(size_t to, double squared, const glm::dvec3& point);
    [[nodiscard]] bool inReach(const glm::dvec3& point) const; ///< of the zone
    void give(size_t node, float distance, const glm::dvec3& point);
    [[nodiscard]] glm::dvec3 settled(size_t node, const glm::ivec3& place);
    [[nodiscard]] bool isExact(size_t node) const {
        return exact_ == (negative(node) ? ExactSide::Inside : ExactSide::Outside);
    }
    /// Voxels, of a node that was not changed.
    [[nodiscard]] float keptDistance(size_t node) const {
        return std::abs(window_->value[node]) / static_cast<float>(window_->voxel);
    }
    [[nodiscard]] bool negative(size_t node) const { return window_->value[node] < 0.0f; }
    [[nodiscard]] double reachOf(bool inside) const { return inside ? reach_.inside : reach_.outside; }
    /// Voxels.
    [[nodiscard]] double limit(bool inside) const { return reachOf(inside) / window_->voxel; }
    [[nodiscard]] std::vector<NodeBox> finish();
    void pause();
    /// pause, once for many calls.
    void count() {
        if (++counted_ % kCounted == 0)
            pause();
    }

    FieldWindow* window_ = nullptr;
    SculptZone zone_;
    DistanceReach reach_;
    ExactSide exact_ = ExactSide::None;
    static constexpr uint32_t kCounted = 512; // 0.1 to 0.4 ms
    uint32_t counted_ = 0;
    const std::function<void()>* meanwhile_ = nullptr;
    std::vector<Node> state_; ///< of nodes of active bricks and those around
    /// Voxels, of nodes of active bricks; of kept ones their distance less kNearer, which may be negative.
    std::vector<float> distance_;
    std::vector<uint32_t> pointOf_;  ///< index in points_, where there is a point
    std::vector<glm::dvec3> points_; ///< on the surface
    std::vector<uint32_t> touched_;  ///< nodes with a new distance
    NodeQueue queue_;
};

} // namespace touchstone
