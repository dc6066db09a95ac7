#pragma once
// All triangles of a scene at rest in the frame of one of its objects, in long double. Boxes keep the search
// short; they are conservative, and a test compares them with the plain loop. Shares no code with haptics/.

#include "haptics/scene/haptic_scene.h"
#include "study/truth/brute_force.h"

#include <cstdint>
#include <vector>

namespace touchstone::truth {

/// x -> scale * (rotation * x) + translation in long double.
struct LSimilarity {
    long double scale = 1.0L;
    glm::qua<long double> rotation{1.0L, 0.0L, 0.0L, 0.0L};
    LVec3 translation{0.0L};

    explicit LSimilarity(const Similarity& s);
    [[nodiscard]] LVec3 point(const LVec3& p) const;
    [[nodiscard]] LVec3 inversePoint(const LVec3& p) const;
};

class Soup {
  public:
    /// `frame`: HapticScene::objects; lengths are that object's units.
    Soup(const HapticScene& scene, int frame);

    [[nodiscard]] size_t triangleCount() const { return indices_.size() / 3; }
    [[nodiscard]] Corners corners(size_t triangle) const;
    /// False where two corners are the same vertex after welding: neighbours cover such a triangle.
    [[nodiscard]] bool counts(size_t triangle) const;

    /// The object of a one-sided triangle; -1 for the others.
    [[nodiscard]] int oneSided(size_t triangle) const { return oneSided_[triangle]; }

    /// Every triangle whose box comes within `reach` of `p`, except those that do not count.
    [[nodiscard]] std::vector<size_t> near(const LVec3& p, long double reach) const;
    /// The triangles within `reach` of `p`, as contacts.
    [[nodiscard]] std::vector<BruteContact> within(const LVec3& p, long double reach) const;
    /// The minimum distance over all triangles.
    [[nodiscard]] BruteContact nearest(const LVec3& p) const;
    /// The minimum distance of the segment from `p` to `q` from any triangle, where it is below `enough`;
    /// otherwise some value of at least `enough`.
    [[nodiscard]] long double clearance(const LVec3& p, const LVec3& q, long double enough) const;

  private:
    struct Box {
        LVec3 low{INFINITY}, high{-INFINITY};
        [[nodiscard]] long double distance(const LVec3& p) const;
    };
    struct Node {
        Box box;
        uint32_t first = 0, count = 0; ///< of order_; a leaf has no children
        uint32_t left = 0, right = 0;
    };
    uint32_t build(uint32_t first, uint32_t count, const std::vector<LVec3>& centres);

    std::vector<LVec3> vertices_;
    std::vector<uint32_t> indices_;
    std::vector<int> oneSided_; ///< by triangle
    std::vector<uint32_t> order_;
    std::vector<Node> nodes_;
};

} // namespace touchstone::truth
