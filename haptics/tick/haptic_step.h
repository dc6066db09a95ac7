#pragma once
// One tick of touch. haptic_step.cpp contains all stages in order.

#include "engine/device_io/device_io.h"
#include "engine/math/similarity.h"
#include "haptics/program/ending.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "haptics/state/device_state.h"
#include "haptics/tick/stage_trace.h"
#include "haptics/tick/stopwatch.h"
#include "haptics/world/world_state.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <span>

namespace touchstone {

/// All external input of one tick. The step reads no clock.
struct TickInput {
    uint64_t tick = 0;
    double time = 0.0;                   ///< s since start
    double dt = 1e-3;                    ///< s, > 0
    bool late = false;                   ///< the previous tick ended after its next deadline
    std::span<const DeviceSample> hands; ///< one per hand
    const LiveTool* tool = nullptr;      ///< in every hand; null: none sculpts
};

/// Output of one tick for one hand. Workspace frame, SI, unless stated otherwise.
struct HapticOutput {
    double zoom = 1.0;           ///< workspace metres for one device metre
    glm::dvec3 hip{0.0};         ///< haptic interface point
    glm::dvec3 hipVelocity{0.0}; ///< m/s, filtered
    /// Centre of the proxy sphere (IHIP, god-object), in a dent as deep as the surface is.
    glm::dvec3 proxy{0.0};
    glm::dvec3 normal{0.0}; ///< unit normal of the felt surface (shaded, textured); zero without contact
    glm::dvec3 force{0.0};  ///< N, stage 7, before safety
    double borne = 1.0;     ///< in (0, 1], what `force` is of the surface's: less where the hand gives way
    DeviceCommand command;  ///< device frame, after safety
    glm::dvec3 commandInWorkspace{0.0};
    double penetration = 0.0; ///< |proxy - HIP|, m
    uint32_t contacts = 0;    ///< touching features in the last solve
    uint32_t iterations = 0;  ///< proxy moves
    FrictionState friction = FrictionState::Free;
    uint32_t flags = 0;                 ///< TickFlag bits
    program::ProgramEnd programEnd{};   ///< with TickFlag::ProgramFailed
    int object = -1;                    ///< touched object, -1 without contact
    int triangle = -1;                  ///< touched triangle of that object's mesh
    std::array<glm::dvec3, 3> planes{}; ///< active constraint planes' normals, `planeCount` of them
    uint32_t planeCount = 0;
    glm::dvec3 stictionPoint{0.0}; ///< valid while friction is not Free
    double height = 0.0;           ///< felt height H, m, less the depth of a dent
    /// J, passivity observer: above zero the device gave the hand more energy than it took. Zero with
    /// passivity=off.
    double energyBalance = 0.0;
};

/// One tick: sample, contact, proxy, shading, texture, friction and force of every hand, the forces on the
/// objects, then safety of every hand (docs/architecture.md, One tick). `world` has the poses of this tick
/// (WorldState::advance); each hand has its own limits (DeviceSample::limits) and touches the same objects.
/// Deterministic; no clock, allocation, lock, throw or I/O. `states` and `outputs` have one entry per hand of
/// `input`. Stopwatch: StageTracer on the servo and wherever its results must be reproduced to the
/// last bit; StageStopwatch, SplitStopwatch and NoStopwatch where cost is studied.
template <class Stopwatch>
void hapticStep(const HapticScene& scene, const HapticSettings& settings, const TickInput& input,
                WorldState& world, std::span<DeviceState> states, std::span<HapticOutput> outputs,
                Stopwatch& stopwatch) noexcept;

extern template void hapticStep<NoStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                             WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                             NoStopwatch&) noexcept;
extern template void hapticStep<StageStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                                WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                                StageStopwatch&) noexcept;
extern template void hapticStep<SplitStopwatch>(const HapticScene&, const HapticSettings&, const TickInput&,
                                                WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                                SplitStopwatch&) noexcept;
extern template void hapticStep<StageTracer>(const HapticScene&, const HapticSettings&, const TickInput&,
                                             WorldState&, std::span<DeviceState>, std::span<HapticOutput>,
                                             StageTracer&) noexcept;

} // namespace touchstone
