#pragma once
// Embree's tree over the triangles of one object, for rays: contact=rays, contact=neighbourhood and the ray
// floor need it, contact=sweep does not.

#include "engine/core/built_once.h"
#include "engine/core/progress.h"

#include <memory>

struct RTCSceneTy;

namespace touchstone {

struct HapticObject;

class RayTree {
  public:
    RayTree() = default;
    /// A copy starts unbuilt: the tree reads the vertices of the object that it was built for.
    RayTree(const RayTree&) noexcept {}
    RayTree& operator=(const RayTree&) = delete;

    /// Null until it is built. Wait-free.
    [[nodiscard]] RTCSceneTy* get() const noexcept {
        const auto* built = built_.get();
        return built == nullptr ? nullptr : built->get();
    }
    /// Builds the tree once; `object` contains this tree and does not move any more. Any thread but the
    /// servo; throws Error when Embree fails, and Cancelled.
    void build(const HapticObject& object, const Progress& progress = {}) const;

  private:
    BuiltOnce<std::shared_ptr<RTCSceneTy>> built_;
};

} // namespace touchstone
