#pragma once
// The two plain structs through which the haptic step and a device talk. Neither side links the other.

#include "engine/math/object_motion.h"
#include "engine/math/similarity.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstdint>
#include <span>

namespace touchstone {

class ForceLimiter;

/// What clutch and zoom make of a place of the device: part of a tick's input. Forces are turned back by it
/// and not scaled.
struct DeviceMapping {
    Similarity workspaceFromDevice;
    double coupling = 1.0; ///< 0..1: share of the force that reaches the hand. Less while the clutch is held
                           ///< and until its force has come back
};

/// Inputs in the device frame: m, right-handed, y up, z towards the user.
struct DeviceSample {
    glm::dvec3 position{0.0};
    glm::dquat orientation{1.0, 0.0, 0.0, 0.0};
    uint32_t buttons = 0;
    double age = 0.0;   ///< s since the device measured it
    bool valid = false; ///< false: nothing is known of the hand (unplugged, not started)
    /// Touch begins again with this sample: the hand did not move here from where the last sample was.
    bool begins = false;
    /// The hand is moved by something that sees the model (mouse, simulated hand). Where it begins was then
    /// chosen in the open, and while it is not valid it has been lifted on purpose: no fault of a device.
    bool inSight = false;
    DeviceMapping mapping{};

    /// The haptic interface point, workspace.
    [[nodiscard]] glm::dvec3 inWorkspace() const { return mapping.workspaceFromDevice.point(position); }
};

/// What the last tick came to and how the objects have moved since, for a hand that the program itself moves.
/// Workspace. `objects` holds during the call that passes it.
struct TouchFeedback {
    bool touching = false;
    glm::dvec3 hip{0.0}, proxy{0.0};      ///< m, at the end of the last tick
    glm::dvec3 force{0.0};                ///< N, stage 7: before safety, also while the force is off
    std::span<const glm::dvec3> planes{}; ///< unit normals of the active constraint planes
    int object = -1;                      ///< touched; index into `objects`
    ObjectMotions objects{};              ///< to this tick; empty: nothing moves
};

/// What may be sent to a device, in the device frame. Only the safety stage can make one that is not zero.
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

/// What a device can do; the safety stage never exceeds it.
struct DeviceLimits {
    double maxForce = 8.5;               ///< N, magnitude. Phantom Premium 1.5: 8.5 N peak.
    double maxForceRate = 8500.0;        ///< N/s, slew: full force in 1 ms. Lower feels soft at impacts.
    double maxTorque = 0.0;              ///< N·m, magnitude; 0: the device takes no torque
    double maxTorqueRate = 0.0;          ///< N·m/s
    double recommendedStiffness = 600.0; ///< N/m, used where a material states none
    double maxStiffness = 3500.0;        ///< N/m, above it the closed loop may buzz
    /// s: a sample older than this is stale and the force fades out. Twenty periods at 1 kHz: longer than any
    /// USB poll or scheduling hiccup, shorter than a hand's reaction. Larger keeps pushing on what may not be
    /// true.
    double staleAge = 0.02;
    double positionResolution = 3e-5; ///< m
    double apparentMass = 0.075;      ///< kg at the tip, the least in any direction. Phantom Premium 1.5.
    double coulombFriction = 0.0;     ///< N at the tip, the least in any direction; 0: none is known of
    bool commandDelay = false;        ///< a command acts a tick later, not at once
};

} // namespace touchstone
