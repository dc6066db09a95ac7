#include "tests/stability/closed_loop/sampled_loop.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

namespace touchstone::test {

namespace {

using Real = long double;
template <size_t N>
using Square = std::array<std::array<Real, N>, N>;

template <size_t N>
Square<N> product(const Square<N>& a, const Square<N>& b) {
    Square<N> c{};
    for (size_t i = 0; i < N; ++i)
        for (size_t j = 0; j < N; ++j)
            for (size_t k = 0; k < N; ++k)
                c[i][j] += a[i][k] * b[k][j];
    return c;
}

template <size_t N>
Real norm(const Square<N>& a) {
    Real sum = 0;
    for (const auto& row : a)
        for (const Real value : row)
            sum += value * value;
    return std::sqrt(sum);
}

/// x and v after a tick from those before and the held force: M x'' = F - c x' - k x by its characteristic
/// roots, which are moved apart by 1e-9 of their size where they coincide.
struct Discrete {
    Real xx, xv, xf, vx, vv, vf;
};
Discrete discretise(const LinearLoop& loop) {
    using Complex = std::complex<Real>;
    const Real m = static_cast<Real>(loop.mass) + static_cast<Real>(loop.handMass);
    const Real c = static_cast<Real>(loop.viscous) + static_cast<Real>(loop.handDamping);
    const Real k = loop.handStiffness, t = loop.period;
    if (k == 0) {
        const Real e = -std::expm1(-c * t / m), tau = c > 0 ? m / c : 0;
        if (!(c > 0))
            return {1, t, t * t / (2 * m), 0, 1, t / m};
        return {1, tau * e, (t - tau * e) / c, 0, 1 - e, e / c};
    }
    Complex root = std::sqrt(Complex(c * c / (4 * m * m) - k / m));
    if (std::abs(root) < 1e-9L * std::sqrt(k / m))
        root = 1e-9L * std::sqrt(k / m);
    const Complex p = -c / (2 * m) + root, q = -c / (2 * m) - root;
    const Complex ep = std::exp(p * t), eq = std::exp(q * t);
    const Real xx = ((p * eq - q * ep) / (p - q)).real(), xv = ((ep - eq) / (p - q)).real();
    const Real vx = (p * q * (eq - ep) / (p - q)).real(), vv = ((p * ep - q * eq) / (p - q)).real();
    return {xx, xv, (1 - xx) / k, vx, vv, -vx / k};
}

} // namespace

/// State: x, v, the last tick's x, the filtered velocity, the last tick's force.
double spectralRadius(const LinearLoop& loop, double stiffness, double damping) {
    const Discrete d = discretise(loop);
    const Real t = loop.period;
    const Real share =
        loop.velocityCutoff > 0.0 ? -std::expm1(-2 * std::numbers::pi_v<Real> * loop.velocityCutoff * t) : 1;
    // The filtered velocity and the force of this tick, as rows over the state.
    const std::array<Real, 5> velocity{share / t, 0, -share / t, 1 - share, 0};
    std::array<Real, 5> force{};
    for (size_t i = 0; i < 5; ++i)
        force[i] = -static_cast<Real>(damping) * velocity[i];
    force[0] -= stiffness;
    const std::array<Real, 5> last{0, 0, 0, 0, 1};
    const std::array<Real, 5>& held = loop.delay == 0 ? force : last;
    Square<5> a{};
    for (size_t i = 0; i < 5; ++i) {
        a[0][i] = d.xf * held[i];
        a[1][i] = d.vf * held[i];
    }
    a[0][0] += d.xx;
    a[0][1] += d.xv;
    a[1][0] += d.vx;
    a[1][1] += d.vv;
    a[2][0] = 1;
    a[3] = velocity;
    a[4] = force;
    // Scaled to like units first; then the norm of a high power by squaring: |A^n|^(1/n) -> the radius, here
    // with n = 2^40.
    const std::array<Real, 5> unit{1, 1 / t, 1, 1 / t, std::max<Real>(1, stiffness)};
    for (size_t i = 0; i < 5; ++i)
        for (size_t j = 0; j < 5; ++j)
            a[i][j] *= unit[j] / unit[i];
    Real logarithm = 0, power = 1;
    for (int squaring = 0; squaring < 40; ++squaring) {
        const Real size = norm(a);
        if (!(size > 0))
            return 0.0;
        for (auto& row : a)
            for (Real& value : row)
                value /= size;
        logarithm += std::log(size) / power;
        a = product(a, a);
        power *= 2;
    }
    return static_cast<double>(std::exp(logarithm + std::log(norm(a)) / power));
}

double eigenvalueLimit(const LinearLoop& loop, double damping, double low) {
    const auto stable = [&](double stiffness) { return spectralRadius(loop, stiffness, damping) < 1.0; };
    if (!stable(low))
        return 0.0;
    double high = 2.0 * low;
    while (stable(high) && high < 1e9)
        low = std::exchange(high, 2.0 * high);
    for (int step = 0; step < 60; ++step) {
        const double middle = 0.5 * (low + high);
        (stable(middle) ? low : high) = middle;
    }
    return low;
}

double bareLimit(double mass, double viscous, double period, int delay) {
    const Real b = viscous, t = period, tau = mass / b, e = -std::expm1(-t / tau), a = 1 - e;
    // x / u = (g z + c) / (z² - (1 + a) z + a).
    const Real g = (t - tau * e) / b, c = tau * e * e / b - a * g;
    if (delay == 0) {
        // |a + K c| < 1 and 1 + (1 + a) + a + K (c - g) > 0.
        const Real byProduct = (1 - a) / c;
        const Real bySign = g > c ? 2 * (1 + a) / (g - c) : byProduct;
        return static_cast<double>(std::min(byProduct, bySign));
    }
    // z³ - (1 + a) z² + (a + K g) z + K c: 1 - (K c)² > |K c (1 + a) + a + K g|, and the sign at z = -1.
    const Real q = g + c * (1 + a);
    const Real byProduct = (-q + std::sqrt(q * q + 4 * c * c * (1 - a))) / (2 * c * c);
    const Real bySign = c > g ? 2 * (1 + a) / (c - g) : byProduct;
    return static_cast<double>(std::min(byProduct, bySign));
}

double passiveViscosity(const std::function<std::complex<double>(std::complex<double>)>& wall,
                        double period) {
    constexpr int kPoints = 200000;
    double least = 0.0;
    for (int i = 1; i <= kPoints; ++i) {
        const double angle = std::numbers::pi * i / kPoints;
        const std::complex<double> z = std::polar(1.0, angle);
        const double s = std::sin(0.5 * angle); // 1 - cos = 2 s²
        least = std::max(least, period / (4.0 * s * s) * ((1.0 - 1.0 / z) * wall(z)).real());
    }
    return least;
}

std::complex<double> wallOf(const LinearLoop& loop, double stiffness, double damping,
                            std::complex<double> z) {
    const double share = loop.velocityCutoff > 0.0
                             ? -std::expm1(-2.0 * std::numbers::pi * loop.velocityCutoff * loop.period)
                             : 1.0;
    const std::complex<double> velocity = share / (1.0 - (1.0 - share) / z) * (1.0 - 1.0 / z) / loop.period;
    return (stiffness + damping * velocity) * (loop.delay == 0 ? 1.0 : 1.0 / z);
}

} // namespace touchstone::test
