#pragma once
// Stage 5, haptic programs: what the program of a touched material makes of the sample.

#include "haptics/program/ending.h"
#include "haptics/surface/surface_sample.h"

#include <glm/glm.hpp>

#include <cstdint>

namespace touchstone {

struct ToolMotion;        // haptics/state/device_state.h
class PersistentTextures; // haptics/texture/persistent_textures.h

/// Of one hand in one tick. The contacts of a corner share the budget: what the first leaves is the second's.
struct ProgramRun {
    const ToolMotion& tool;
    glm::dvec3 velocity{0.0};  ///< of the HIP relative to the surface, m/s, reference object frame
    double zoom = 1.0;         ///< workspace metres for one device metre
    double dt = 1e-3;          ///< s
    uint32_t budget = 0;       ///< left, in the units of haptics/program/operation.h
    program::ProgramEnd end{}; ///< the first that has no result: its surface is plain
    /// The world's; null where it has none. Programs read them, and queue the strokes of this tick.
    PersistentTextures* textures = nullptr;
    double part = 1.0; ///< of the next contact: its fraction of the load, as in withProgram
};

/// The run of a tick, with the whole budget.
[[nodiscard]] ProgramRun programRun(const ToolMotion& tool, const glm::dvec3& velocity, double zoom,
                                    double dt, PersistentTextures* textures) noexcept;

/// Runs the program of the touched material, if it has one, at a contact that `feel` (readSurface) describes:
/// stiffness, damping and friction become those that it returns, and feel.programForce what it adds to the
/// elastic force of the depth `depth` (workspace m; see withProgram). `feel.normal` is the felt normal.
void runProgram(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                const DeviceLimits& limits, int reference, const Contact& contact, double depth,
                ProgramRun& run, SurfaceSample& feel) noexcept;

/// An elastic force that was made for `feel.stiffness`, with what the program adds for a depth of which
/// `part` counts. It never pulls.
[[nodiscard]] inline glm::dvec3 withProgram(const SurfaceSample& feel, const glm::dvec3& elastic,
                                            double part) noexcept {
    if (!feel.programmed) [[likely]]
        return elastic;
    const glm::dvec3 force = elastic + part * feel.programForce;
    const double push = glm::dot(force, feel.normal);
    return push < 0.0 ? force - push * feel.normal : force;
}

/// Motion of the tool for programs: once a tick, after the sample. `velocity`: filtered, workspace, m/s.
void followTool(const glm::dvec3& velocity, double dt, ToolMotion& tool) noexcept;

/// Keeps the direction of a motion along the surface of normal `normal`: slower ones than 1 mm/s have none.
/// Velocity and normal in a frame whose directions `workspaceFromReference` turns.
void followDirection(const glm::dvec3& velocity, const glm::dvec3& normal,
                     const Similarity& workspaceFromReference, ToolMotion& tool) noexcept;

} // namespace touchstone
