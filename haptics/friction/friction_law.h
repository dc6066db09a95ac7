#pragma once
// The friction laws: functions of lengths, independent of any mesh. One file each: zilles_law, ho_law,
// elastoplastic_law, velocity_threshold_law, kim_law; friction.cpp calls the one that the settings select and
// moves the proxy.

#include "haptics/state/device_state.h"

#include <glm/glm.hpp>

namespace touchstone {

/// Input of a law. Lengths and vectors in any one frame and unit. Normal and tangential stiffness are both K,
/// so a force F is the stretch F / K, and the normal force N is the depth N / K.
struct FrictionInput {
    FrictionState state = FrictionState::Sticking; ///< of the last tick; not Free
    glm::dvec3 stretch{0.0};      ///< x: from the place without friction to the stiction point
    double lastLength = 0.0;      ///< |x| at the end of the last tick
    double depth = 0.0;           ///< N / K >= 0
    double staticFriction = 0.0;  ///< mu_s > 0
    double dynamicFriction = 0.0; ///< mu_d, 0 .. mu_s
    // Of velocityThresholdLaw alone.
    glm::dvec3 slip{0.0};   ///< velocity of the hand along the surface, length per s
    double threshold = 0.0; ///< of |slip|, length per s
    double viscosity = 0.0; ///< b / K, s: the length of the viscous force over |slip|
    // Of kimLaw alone.
    double dt = 1e-3;    ///< s
    double growth = 0.0; ///< d |p_c - p_t| of [002 eq. 4]
};

/// Result of a law. The friction force is K * share * stretch.
struct FrictionAnswer {
    FrictionState state = FrictionState::Sticking;
    bool stays = true;       ///< the stiction point keeps its place, to the last bit
    glm::dvec3 stretch{0.0}; ///< the new x
    double share = 1.0;      ///< tangential stiffness over K
};

/// Zilles and Salisbury [001 §4.1.1]: one state, like a convict's ball and chain. Sticks while |x| <= mu_s N
/// / K; beyond it the stiction point is moved to mu_d N / K from the frictionless place, and sticks there:
/// the sawtooth of [001 Fig. 4-4].
[[nodiscard]] FrictionAnswer zillesLaw(const FrictionInput& input) noexcept;

/// Ho, Basdogan and Srinivasan [000 §4.2]: sticking with ks, breaking away above mu_s N; sliding with kd, the
/// stiction point mu_d N / kd behind, for as long as kd |x| does not fall below mu_d N; then sticking again.
/// ks = K mu_s / max(1, mu_s) and kd = K mu_d / max(1, mu_s): proportional to the coefficients, and never
/// stiffer than the surface, which is as stiff as the device can bear.
[[nodiscard]] FrictionAnswer hoLaw(const FrictionInput& input) noexcept;

/// Hayward and Armstrong's drift-free elasto-plastic model (ISER 1999; with the exact exponential step of
/// Dupont, Hayward, Armstrong and Altpeter, 2002), in the form without time. The adhesion point follows a
/// growing stretch by alpha(|x|) of its growth and nothing else:
///   alpha = 0                                              |x| <= kElastic L: no creep
///         = A (1 - cos(pi (|x| / L - kElastic) / (1 - kElastic))) / 2    up to L
/// Sticking: L = mu_s N / K, A = 1/2, so that the limit is reached; beyond it the contact breaks away.
/// Sliding: L = mu_d N / K, A = 1, and |x| never exceeds L; below kElastic L it sticks again.
[[nodiscard]] FrictionAnswer elastoplasticLaw(const FrictionInput& input) noexcept;

/// The two-state law of [001 Fig. 4-2], after Salcudean and Vlaar: a spring K (eq. 4.3) holds the sticking
/// contact until it bears more than mu_s N (eq. 4.5); then it slides and bears b v against the velocity, for
/// as long as |v| >= the threshold. Below it the contact sticks where it is: the spring begins slack. The
/// bound of the viscous force by mu_d N is ours: it keeps the force in the cone at any speed.
[[nodiscard]] FrictionAnswer velocityThresholdLaw(const FrictionInput& input) noexcept;

/// Kim, Kyrikou, Sukhatme and Desbrun [002 §4.3]: the contact point follows its frictionless place by the
/// fraction 1 - f of the way. f_c is the dynamic coefficient, f_v = f_c (1 + d |p_c - p_t|) (eq. 4), here at
/// most 0.999 since at 1 the point never moves again. Equations 5 to 7 as printed (F_v in eq. 7 is F_r) take
/// f = f_v in every tick: a low-pass whose drag is proportional to the servo's period. With
///   f = tau / (tau + dt), tau = 1 ms f_v / (1 - f_v)
/// it is the same at 1 kHz, and lags by tau v behind the velocity v at any rate. It knows no cone and no
/// sticking: at rest the point creeps to its frictionless place with the time constant tau.
[[nodiscard]] FrictionAnswer kimLaw(const FrictionInput& input) noexcept;

/// Fraction of its limit up to which the elasto-plastic contact is purely elastic.
inline constexpr double kElastic = 0.7;

} // namespace touchstone
