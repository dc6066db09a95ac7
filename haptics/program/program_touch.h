#pragma once
// What a program makes of a contact: the elastic force and the coefficients of friction, before friction.
//
// The place p is displaced to p + h n, h = (p' - p) . n along the felt normal n. A spring from the hand, d
// below the surface, to the displaced surface has the potential U = k'/2 (d + h)^2, whose force is
//     k' (d + h) (n - grad_t h),
// with the gradient along the surface: a displaced surface does no work on a closed path. Where the program
// perturbs the normal itself (m), it is k' (d + h) m. The force that the program returns, f', was made of k d
// n, so that a changed stiffness k' scales it:
//     F = k'/k f' + k' (d + h) (n - grad_t h) - k' d n.
// Where h > d/2 a smooth s(h, d) <= d stands for it: with g(u) = u - (u - 1/2)^2 / 2 for 1/2 < u < 3/2 and 1
// beyond, s = d g(h/d). The force is that of U = k'/2 (d + s)^2, k' (d + s) ((1 + ds/dd) n - ds/dh grad_t h),
// so that a closed path across the limit does no work either, and no force steps there. Bounds hold whatever
// the program returns: |s| <= d, the force never pulls, and is at most kMaxProgramGain k' d, so that contact
// begins without a step. Coefficients are at least 0, and the dynamic friction is at most the static one.

#include "haptics/program/executor.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone::program {

/// Greatest force of a program in units of that of the plain surface.
constexpr double kMaxProgramGain = 8.0;

/// Where the gradient of the displacement comes from.
enum class ProgramGradient : uint8_t {
    Dual,    ///< forward differentiation, exact
    Central, ///< differences of six more runs
    None     ///< the displacement changes the depth alone
};

/// A contact as programs see it. Directions and places in the object's own frame, places in model metres.
struct ProgramContact {
    glm::dvec3 position{0.0};
    glm::dvec3 normal{0.0, 0.0, 1.0}, tangent{1.0, 0.0, 0.0}, binormal{0.0, 1.0, 0.0}; ///< unit
    glm::dvec2 uv{0.0};
    std::array<glm::dvec3, 2> uvSlope{}; ///< of u and of v along the surface, 1/m
    double persistent = 1.0;             ///< value of the persistent texture
    glm::dvec3 persistentSlope{0.0};     ///< along the surface, 1/m
    glm::dvec3 toolDirection{0.0};       ///< unit, of the last motion along the surface; 0 before any
    glm::dvec3 toolVelocity{0.0};        ///< m/s
    glm::dvec3 toolAcceleration{0.0};    ///< m/s^2
    double depth = 0.0;                  ///< d >= 0, workspace m
    double stiffness = 0.0;              ///< k > 0, N/m
    double damping = 0.0;                ///< N s/m
    double staticFriction = 0.0, dynamicFriction = 0.0;
    double filterWidth = 0.0;       ///< model m
    double time = 0.0;              ///< s
    double modelPerWorkspace = 1.0; ///< model metres in a workspace metre
    double maxStiffness = 0.0;      ///< N/m that the device can bear
    double differenceStep = 1e-4;   ///< model m, of ProgramGradient::Central
    uint32_t budget = kBudget;      ///< of all runs, see operation.h; above it the surface is plain
};

/// What is felt. With another ending than Finished: the plain surface.
struct ProgramFelt {
    Ending ending = Ending::Finished;
    glm::dvec3 force{0.0}; ///< elastic, N
    double stiffness = 0.0, damping = 0.0, staticFriction = 0.0, dynamicFriction = 0.0;
    double height = 0.0; ///< s(h, d), workspace m
    /// What the program changes of the persistent texture: its integral a second, m^2/s, within `brush`
    /// (model m, at least 0).
    double persistentChange = 0.0, brush = 0.0;
    uint32_t cost = 0; ///< of all runs, see operation.h
    uint16_t at = 0;   ///< as ProgramEnd::at
};

/// One call a tick and contact. On the servo: bounded, no allocation.
[[nodiscard]] ProgramFelt feelProgram(const RegisterProgram& program, ProgramGradient gradient,
                                      const ProgramContact& contact) noexcept;

} // namespace touchstone::program
