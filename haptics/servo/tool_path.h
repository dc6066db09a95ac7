#pragma once
// What a hand makes with its tool, tick by tick.

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "haptics/tick/haptic_step.h"

#include <array>
#include <cstdint>
#include <span>

namespace touchstone {

/// Lays the dabs of one hand along its way while the button is held: a quarter of the radius apart, at least
/// half a voxel. Servo thread; no allocation.
///
/// Carve and Drag work at the tip; Stamp and Imprint once, where they were pressed down. Add, Smooth
/// and Paint need contact: they work at the proxy, Add and Smooth every kRepeat where the hand rests, too.
/// The ball of Add stands out of the surface by three quarters of a voxel: the proxy that it covers is lifted
/// by the next solve (takeUpReshaped), and from there the next ball grows.
class ToolPath {
  public:
    static constexpr size_t kMost = 9;       ///< entries in a tick
    static constexpr double kRepeat = 0.032; ///< s

    /// After the step of `input.tick`. `pressed`: the button is, or the tool holds itself. Returns the number
    /// of entries written.
    size_t advance(const LiveTool& tool, bool pressed, const HapticScene& scene, ObjectMotions motions,
                   const TickInput& input, const HapticOutput& output,
                   std::span<SculptEntry, kMost> made) noexcept;

    /// Between two scenes.
    void release() noexcept { down_ = false; }

  private:
    [[nodiscard]] bool begins(const LiveTool& tool, const HapticScene& scene,
                              const HapticOutput& output) noexcept;

    bool down_ = false;
    int object_ = -1;
    glm::dvec3 last_{0.0}; ///< place of the last dab, or where the stroke began; object frame
    double rested_ = 0.0;  ///< s since the last dab
};

} // namespace touchstone
