#pragma once
// The state of each object while the proxy moves through a tick of moving objects.

#include "haptics/contact/candidates.h"
#include "haptics/solve/object_path.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <span>

namespace touchstone {

/// One object near the proxy, and that object's copy of the proxy: a place in the object's frame that moves
/// with it and never passed through it.
struct MovingObstacle {
    int object = -1; ///< HapticScene::objects
    ObjectPath path;
    Similarity pose;        ///< workspaceFromObject at the end of the current step
    glm::dvec3 place{0.0};  ///< object frame and units
    double reach = 0.0;     ///< distance that the proxy keeps, object units
    double standing = 0.0;  ///< distance already kept at the start of the step, object units
    double bounding = 0.0;  ///< radius about the origin, object units
    glm::dvec3 origin{0.0}; ///< `place` at the start of the step
};

/// Objects that met another one through the proxy and left it no room. They are not felt until the proxy is
/// in front of them again; `places` is the proxy's last place in the frame of each.
struct JammedObjects {
    static constexpr size_t kMax = CandidateCache::kMaxIgnored;
    std::array<int, kMax> objects{};
    std::array<glm::dvec3, kMax> places{};
    size_t count = 0;

    [[nodiscard]] std::span<const int> ignored() const { return {objects.data(), count}; }
    [[nodiscard]] bool holds(int object) const {
        return std::find(objects.begin(), objects.begin() + count, object) != objects.begin() + count;
    }
    [[nodiscard]] bool add(int object, const glm::dvec3& place) {
        if (count == kMax)
            return false;
        objects[count] = object;
        places[count++] = place;
        return true;
    }
    void remove(size_t i) {
        --count;
        objects[i] = objects[count];
        places[i] = places[count];
    }
};

} // namespace touchstone
