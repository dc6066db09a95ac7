#pragma once
// The plain structs exchanged between the haptic step and a device. Neither side links the other.

#include "engine/math/object_motion.h"
#include "engine/math/similarity.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <limits>
#include <span>

namespace touchstone {

class ForceLimiter;

/// The device's mapping by clutch and zoom: part of a tick's input. It rotates forces back and does not scale
/// them.
struct DeviceMapping {
    Similarity workspaceFromDevice;
    double coupling = 1.0; ///< 0..1: force fraction passed; below 1 while clutched and as the force returns
};

/// Limits of a device; the safety stage never exceeds them.
struct DeviceLimits {
    double maxForce = 8.5;               ///< N, magnitude. Phantom Premium 1.5: 8.5 N peak.
    double maxForceRate = 8500.0;        ///< N/s, slew: full force in 1 ms. Lower feels soft at impacts.
    double maxTorque = 0.0;              ///< N·m, magnitude; 0: the device takes no torque
    double maxTorqueRate = 0.0;          ///< N·m/s
    double recommendedStiffness = 600.0; ///< N/m, used where a material states none
    double maxStiffness = 3500.0;        ///< N/m, above it the closed loop may buzz
    /// s: a sample older than this is stale and the force fades out. Twenty periods at 1 kHz: longer than any
    /// USB poll or scheduling delay, shorter than a hand's reaction. A larger value keeps pushing on an
    /// outdated position.
    double staleAge = 0.02;
    double positionResolution = 3e-5; ///< m
    double apparentMass = 0.075;      ///< kg at the tip, minimum over all directions. Phantom Premium 1.5
    double coulombFriction = 0.0;     ///< N at the tip, the minimum over all directions; 0: unknown
    bool commandDelay = false;        ///< a command acts a tick later, not at once
    /// N, > 0: a hand that the program moves gives way within the tick rather than press harder (stage 7).
    /// Infinite: the hand of a device, which bears what it bears.
    double press = std::numeric_limits<double>::infinity();

    bool operator==(const DeviceLimits&) const = default;
};

/// One hand's input of a tick. Device frame: m, right-handed, y up, z towards the user.
struct DeviceSample {
    glm::dvec3 position{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    uint32_t buttons = 0;
    double age = 0.0;   ///< s since the device measured it
    bool valid = false; ///< false: the hand's position is unknown (unplugged, not started)
    /// Touch begins again with this sample: the hand did not move here from the last sample's position.
    bool begins = false;
    /// The hand is moved by something that sees the model (mouse, simulated hand). Its start was then chosen
    /// in sight of the model, and while it is not valid it has been lifted on purpose: no fault of a device.
    bool inSight = false;
    DeviceMapping mapping{};
    DeviceLimits limits{}; ///< of the device that gets this tick's command; also while not valid

    /// The haptic interface point, workspace.
    [[nodiscard]] glm::dvec3 inWorkspace() const { return mapping.workspaceFromDevice.point(position); }
};

/// Result of the last tick and the objects' motion since, for a hand that the program itself moves.
/// Workspace. `objects` is valid during the call that passes it.
struct TouchFeedback {
    bool touching = false;
    glm::dvec3 hip{0.0}, proxy{0.0}; ///< m, at the end of the last tick
    /// N, stage 7: before safety, also while the force is off, and before the hand gives way.
    glm::dvec3 force{0.0};
    std::span<const glm::dvec3> planes{}; ///< unit normals of the active constraint planes
    int object = -1;                      ///< touched; index into `objects`
    ObjectMotions objects{};              ///< to this tick; empty: nothing moves
    double animation = 0.0;               ///< s, of the scene's animation in this tick
};

/// A command to a device, in the device frame. Only the safety stage can make one that is not zero.
class DeviceCommand {
  public:
    DeviceCommand() = default;                                         ///< zero force
    [[nodiscard]] const glm::dvec3& force() const { return force_; }   ///< N
    [[nodiscard]] const glm::dvec3& torque() const { return torque_; } ///< N·m

  private:
    friend class ForceLimiter;
    DeviceCommand(const glm::dvec3& force, const glm::dvec3& torque) : force_(force), torque_(torque) {}
    glm::dvec3 force_{0.0}, torque_{0.0};
};

} // namespace touchstone
