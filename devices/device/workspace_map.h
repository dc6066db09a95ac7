#pragma once
// Clutch and zoom: how a small device reaches all of a large workspace.

#include "engine/device_io/device_io.h"

namespace touchstone {

inline constexpr double kMinZoom = 0.1, kMaxZoom = 10.0;

/// The device's second button, as a bit of DeviceSample::buttons.
inline constexpr uint32_t kClutchButton = 1u << 1;

/// What the user wants of the workspace.
struct WorkspaceWish {
    double zoom = 1.0;   ///< m in the workspace for one m of the device, kMinZoom..kMaxZoom
    bool clutch = false; ///< while true the device moves and the HIP does not
};

/// Takes the places of a device into the workspace, x -> zoom x + t, so that the haptic interface point (HIP)
/// never jumps:
///
/// - *Clutch*. While it is held the HIP stays where it was, t = HIP - zoom x, and the coupling of the force
///   goes to zero; when it is let go the HIP goes on from there, and the coupling comes back. Also in
///   contact: the point that is held keeps pressing, so the force that comes back is the one that was there.
/// - *Zoom* goes about the HIP, t' = HIP - zoom' x, at no more than kZoomRate, so that a hand in motion is
///   not thrown.
///
/// The force is turned and not scaled, so that the device feels a stiffness of k times zoom, and the work
/// that it does is the force times its own way: all limits and the energy balance are the device's
/// (docs/devices.md#workspace). Pure arithmetic on one thread: no clock, allocation, lock or throw.
class WorkspaceMap {
  public:
    /// 1/s, of the logarithm of the zoom: tenfold in 0.5 s. Faster feels like a jerk to a moving hand.
    static constexpr double kZoomRate = 4.6;
    /// s until the clutch has taken a full force away, and until it has come back: as the safety stage fades.
    static constexpr double kClutchOut = 0.05, kClutchIn = 0.1;
    /// s without a sample at `centre`: longer than the safety stage takes to forget a touch.
    static constexpr double kCentring = 0.06;
    /// s that fades and glides go on in one sample, however long it was in coming.
    static constexpr double kLongestStep = 0.010;

    /// The device's `place` is the workspace's from now on, at the zoom that is wanted. The coupling goes on.
    void begin(const WorkspaceWish& target, const glm::dvec3& place = glm::dvec3(0.0)) noexcept;
    /// The device's `place` becomes the workspace's again, wherever that takes the HIP: for kCentring there
    /// is no sample, so that touch begins anew and is not dragged through the model.
    void centre(const glm::dvec3& place = glm::dvec3(0.0)) noexcept {
        centring_ = kCentring;
        centre_ = place;
    }
    /// Writes the mapping of this tick into `sample`, `seconds` after the last one (0 to kLongestStep of them
    /// count). A sample that is not valid gets the mapping as it is.
    void apply(DeviceSample& sample, const WorkspaceWish& target, double seconds) noexcept;

    [[nodiscard]] const DeviceMapping& mapping() const { return mapping_; }

  private:
    DeviceMapping mapping_;
    glm::dvec3 hip_{0.0}, centre_{0.0};
    bool placed_ = false; // hip_ is of the last valid sample
    double centring_ = 0.0;
};

} // namespace touchstone
