#pragma once
// Clutch and zoom: access to a workspace larger than that of the device.

#include "engine/device_io/device_io.h"

namespace touchstone {

inline constexpr double kMinZoom = 0.1, kMaxZoom = 10.0;

/// The device's second button, as a bit of DeviceSample::buttons.
inline constexpr uint32_t kClutchButton = 1u << 1;

/// The target zoom and the state of the clutch.
struct WorkspaceWish {
    double zoom = 1.0;   ///< workspace metres for one device metre, kMinZoom..kMaxZoom
    bool clutch = false; ///< while true the device moves and the HIP does not
};

/// Maps device positions into the workspace, x -> zoom x + t, such that the haptic interface point (HIP)
/// never jumps:
///
/// - *Clutch*. While it is held, the HIP stays in place, t = HIP - zoom x, and the force coupling falls to
///   zero. On release the HIP moves on from there and the coupling returns. This also holds in contact: the
///   held HIP keeps its penetration, so the force that returns is the one from before.
/// - *Zoom* is centred on the HIP, t' = HIP - zoom' x, and changes at no more than kZoomRate, so that a
///   moving hand is not accelerated abruptly.
///
/// The force is rotated but not scaled. The device therefore renders a stiffness of k times zoom, and its
/// work is the force times its own displacement: all limits and the energy balance are the device's
/// (docs/devices.md#workspace). Pure arithmetic on one thread: no clock, allocation, lock or throw.
class WorkspaceMap {
  public:
    /// 1/s, of the logarithm of the zoom: tenfold in 0.5 s. A moving hand feels a faster change as a jerk.
    static constexpr double kZoomRate = 4.6;
    /// s in which the clutch fades out a full force, and in which the force returns; equal to the safety
    /// stage's fade.
    static constexpr double kClutchOut = 0.05, kClutchIn = 0.1;
    /// s without a valid sample after `centre`; longer than the safety stage keeps a contact.
    static constexpr double kCentring = 0.06;
    /// s; the longest interval by which fades and zoom advance in one sample.
    static constexpr double kLongestStep = 0.010;

    /// Maps the device's current position to workspace point `place` at the target zoom. The coupling
    /// continues.
    void begin(const WorkspaceWish& target, const glm::dvec3& place = glm::dvec3(0.0)) noexcept;
    /// Maps the device's `place` to its workspace point again, whatever displacement of the HIP that takes:
    /// samples are invalid for kCentring, so that contact starts afresh and the HIP is not dragged through
    /// the model.
    void centre(const glm::dvec3& place = glm::dvec3(0.0)) noexcept {
        centring_ = kCentring;
        centre_ = place;
    }
    /// Writes this tick's mapping into `sample`, `seconds` after the last one (clamped to 0..kLongestStep).
    /// An invalid sample gets the unchanged mapping.
    void apply(DeviceSample& sample, const WorkspaceWish& target, double seconds) noexcept;

    [[nodiscard]] const DeviceMapping& mapping() const { return mapping_; }

  private:
    DeviceMapping mapping_;
    glm::dvec3 hip_{0.0}, centre_{0.0};
    bool placed_ = false; // hip_ is of the last valid sample
    double centring_ = 0.0;
};

} // namespace touchstone
