#pragma once
// Tactile shading [004 §4.2]: a tangent line that moves along with the finger, of a smooth curve that is
// never computed itself.

#include "haptics/finger/arc_finger.h"
#include "haptics/finger/polyline.h"

#include <cstdint>

namespace touchstone {

/// How the parameter of this step comes out of the tangent line of the last one.
enum class TangentStep : uint8_t {
    AsPublished, ///< the contact on the last line gives the new parameter
    /// The line whose own contact gives its parameter. On a convex curve of radius rho the published step
    /// multiplies the error by -R / rho (R: the finger's radius), so it swings to and fro where the curve is
    /// sharper than the finger. There the solution lies between a place and its next one: false position
    /// finds it, with at most kMostHalvings contacts. In a hollow the published step comes nearer without
    /// swinging.
    Solved
};

/// One finger on one polyline. One thread; no allocation. `polyline` outlives it.
class TactileShading {
  public:
    explicit TactileShading(const Polyline& polyline, const ArcFinger& finger = {},
                            TangentStep step = TangentStep::AsPublished) noexcept
        : polyline_(polyline), finger_(finger), step_(step) {}

    struct Felt {
        SurfaceLine line;   ///< the surface of this step
        PadContact contact; ///< of the finger with it
        double place = 0.0; ///< on the curve: patch + t
    };
    /// The finger at its next pose (m, rad). Where it touches nothing it is projected on the surface as if it
    /// did. A pose that is not finite changes nothing and gives the last answer.
    Felt step(const FingerPose& pose) noexcept;
    /// The next step begins anew at the edge into which the finger reaches deepest.
    void forget() noexcept { known_ = false; }

  private:
    static constexpr int kMostHalvings = 12;

    [[nodiscard]] double contactPlace(double from, const FingerPose& pose) const noexcept;
    [[nodiscard]] double solvedPlace(double from, const FingerPose& pose) const noexcept;
    void switchToDeeper(const FingerPose& pose) noexcept;

    const Polyline& polyline_;
    ArcFinger finger_;
    TangentStep step_;
    Felt felt_;
    bool known_ = false;
};

} // namespace touchstone
