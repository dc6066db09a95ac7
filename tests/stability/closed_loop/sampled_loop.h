#pragma once
// What theory says of a linear device in a hand against a sampled wall. Knows nothing of the program: its own
// discretisation, its own eigenvalues.

#include <complex>
#include <functional>

namespace touchstone::test {

/// A device held by a hand, against F = -K x - B v with the force held for a tick. SI.
struct LinearLoop {
    double mass = 0.1, viscous = 1.0;                              ///< of the device
    double handMass = 0.0, handDamping = 0.0, handStiffness = 0.0; ///< to a point that rests
    double period = 1e-3;                                          ///< s
    int delay = 0;                                                 ///< ticks, 0 or 1
    /// Hz, of the low-pass on the backward difference that the wall's damping takes for a velocity; 0: none.
    double velocityCutoff = 0.0;
};

/// Largest eigenvalue modulus of a tick of the exactly discretised loop: below 1 it is stable.
[[nodiscard]] double spectralRadius(const LinearLoop& loop, double stiffness, double damping = 0.0);

/// The stiffness at which the spectral radius first exceeds 1, by bisection from `low` (stable) upwards; 0
/// where even `low` is not stable.
[[nodiscard]] double eigenvalueLimit(const LinearLoop& loop, double damping = 0.0, double low = 1e-3);

/// The same for a bare mass and damper against a spring, in closed form (Jury's conditions on
/// z^d (z² - (1 + a) z + a) + K (g z + c), d ticks of delay, a = exp(-b T / m)).
[[nodiscard]] double bareLimit(double mass, double viscous, double period, int delay);

/// Colgate and Schenkel's condition: the least b of a device for which it is passive against a wall H(z), by
/// any hand: b > T / (2 (1 - cos wT)) Re{(1 - exp(-i wT)) H(exp(i wT))} for 0 < w <= pi / T, on a grid of wT.
[[nodiscard]] double passiveViscosity(const std::function<std::complex<double>(std::complex<double>)>& wall,
                                      double period);
/// K + B v of `loop`, with its delay and its velocity filter.
[[nodiscard]] std::complex<double> wallOf(const LinearLoop& loop, double stiffness, double damping,
                                          std::complex<double> z);

} // namespace touchstone::test
