#pragma once
// The floating-point operations, on numbers and on dual numbers: value and derivatives by three variables
// (forward differentiation, Wengert 1964). One definition serves both.
//
// Where a derivative does not exist (floor at an integer, |x| at 0) it is that of one side. A factor of zero
// stays zero beside an infinite slope (sqrt at 0), so that a constant has the derivative zero everywhere.

#include <array>
#include <cmath>
#include <cstdint>
#include <type_traits>

namespace touchstone::program {

struct Dual {
    float v = 0.0f;
    std::array<float, 3> d{};
};

inline float valueOf(float x) {
    return x;
}
inline float valueOf(const Dual& x) {
    return x.v;
}

inline float product(float slope, float d) {
    return d == 0.0f ? 0.0f : slope * d;
}

/// `value` with the derivative slope() x'.
template <class Slope>
float chain(float, float value, const Slope&) {
    return value;
}
template <class Slope>
Dual chain(const Dual& x, float value, const Slope& slope) {
    const float s = slope();
    return {value, {product(s, x.d[0]), product(s, x.d[1]), product(s, x.d[2])}};
}

/// `value` with the derivative x' slope of x + y' slope of y.
template <class SlopeX, class SlopeY>
float chain(float, float, float value, const SlopeX&, const SlopeY&) {
    return value;
}
template <class SlopeX, class SlopeY>
Dual chain(const Dual& x, const Dual& y, float value, const SlopeX& slopeX, const SlopeY& slopeY) {
    const float s = slopeX(), t = slopeY();
    Dual result{value, {}};
    for (size_t k = 0; k < 3; ++k)
        result.d[k] = product(s, x.d[k]) + product(t, y.d[k]);
    return result;
}

template <class R>
R constant(float value) {
    if constexpr (std::is_same_v<R, float>)
        return value;
    else
        return {value, {}};
}

constexpr auto kZero = [] { return 0.0f; };
constexpr auto kOne = [] { return 1.0f; };
constexpr auto kMinusOne = [] { return -1.0f; };

template <class R>
R add(const R& x, const R& y) {
    return chain(x, y, valueOf(x) + valueOf(y), kOne, kOne);
}
template <class R>
R subtract(const R& x, const R& y) {
    return chain(x, y, valueOf(x) - valueOf(y), kOne, kMinusOne);
}
template <class R>
R multiply(const R& x, const R& y) {
    const float a = valueOf(x), b = valueOf(y);
    return chain(
        x, y, a * b, [&] { return b; }, [&] { return a; });
}
template <class R>
R divide(const R& x, const R& y) {
    const float a = valueOf(x), b = valueOf(y);
    return chain(
        x, y, a / b, [&] { return 1.0f / b; }, [&] { return -(a / b) / b; });
}
template <class R>
R negate(const R& x) {
    return chain(x, -valueOf(x), kMinusOne);
}
/// x - y floor(x / y), the sign of y.
template <class R>
R modFloor(const R& x, const R& y) {
    const float a = valueOf(x), b = valueOf(y), n = std::floor(a / b);
    return chain(x, y, a - b * n, kOne, [&] { return -n; });
}
/// x - y trunc(x / y). Not fmod, whose time grows with the quotient.
template <class R>
R remainder(const R& x, const R& y) {
    const float a = valueOf(x), b = valueOf(y), n = std::trunc(a / b);
    return chain(x, y, a - b * n, kOne, [&] { return -n; });
}
template <class R>
R absolute(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::fabs(a), [&] { return a < 0.0f ? -1.0f : 1.0f; });
}
inline float signOf(float x) {
    return x > 0.0f ? 1.0f : x < 0.0f ? -1.0f : 0.0f;
}
template <class R>
R fraction(const R& x) {
    const float a = valueOf(x);
    return chain(x, a - std::floor(a), kOne);
}
template <class R>
R minimum(const R& x, const R& y) {
    return valueOf(y) < valueOf(x) ? y : x;
}
template <class R>
R maximum(const R& x, const R& y) {
    return valueOf(x) < valueOf(y) ? y : x;
}
template <class R>
R clamp(const R& x, const R& low, const R& high) {
    return minimum(maximum(x, low), high);
}
template <class R>
R mix(const R& x, const R& y, const R& a) {
    return add(multiply(x, subtract(constant<R>(1.0f), a)), multiply(y, a));
}
template <class R>
R fusedMultiplyAdd(const R& x, const R& y, const R& z) {
    const float a = valueOf(x), b = valueOf(y);
    const R xy = chain(
        x, y, 0.0f, [&] { return b; }, [&] { return a; });
    return chain(xy, z, std::fma(a, b, valueOf(z)), kOne, kOne);
}
template <class R>
R smoothStep(const R& low, const R& high, const R& x) {
    const R t = clamp(divide(subtract(x, low), subtract(high, low)), constant<R>(0.0f), constant<R>(1.0f));
    return multiply(multiply(t, t), subtract(constant<R>(3.0f), multiply(constant<R>(2.0f), t)));
}
template <class R>
R sine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::sin(a), [&] { return std::cos(a); });
}
template <class R>
R cosine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::cos(a), [&] { return -std::sin(a); });
}
template <class R>
R tangent(const R& x) {
    const float t = std::tan(valueOf(x));
    return chain(x, t, [&] { return 1.0f + t * t; });
}
template <class R>
R arcSine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::asin(a), [&] { return 1.0f / std::sqrt((1.0f - a) * (1.0f + a)); });
}
template <class R>
R arcCosine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::acos(a), [&] { return -1.0f / std::sqrt((1.0f - a) * (1.0f + a)); });
}
template <class R>
R arcTangent(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::atan(a), [&] { return 1.0f / (1.0f + a * a); });
}
template <class R>
R arcTangent(const R& y, const R& x) {
    const float a = valueOf(y), b = valueOf(x), square = a * a + b * b;
    return chain(
        y, x, std::atan2(a, b), [&] { return b / square; }, [&] { return -a / square; });
}
template <class R>
R hyperbolicSine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::sinh(a), [&] { return std::cosh(a); });
}
template <class R>
R hyperbolicCosine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::cosh(a), [&] { return std::sinh(a); });
}
template <class R>
R hyperbolicTangent(const R& x) {
    const float t = std::tanh(valueOf(x));
    return chain(x, t, [&] { return 1.0f - t * t; });
}
template <class R>
R areaSine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::asinh(a), [&] { return 1.0f / std::sqrt(a * a + 1.0f); });
}
template <class R>
R areaCosine(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::acosh(a), [&] { return 1.0f / std::sqrt((a - 1.0f) * (a + 1.0f)); });
}
template <class R>
R areaTangent(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::atanh(a), [&] { return 1.0f / ((1.0f - a) * (1.0f + a)); });
}
template <class R>
R power(const R& x, const R& y) {
    const float a = valueOf(x), b = valueOf(y), value = std::pow(a, b);
    return chain(
        x, y, value, [&] { return b * std::pow(a, b - 1.0f); },
        [&] { return a > 0.0f ? value * std::log(a) : 0.0f; });
}
template <class R>
R exponential(const R& x) {
    const float e = std::exp(valueOf(x));
    return chain(x, e, [&] { return e; });
}
template <class R>
R logarithm(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::log(a), [&] { return 1.0f / a; });
}
constexpr float kLogOf2 = 0.693147180559945309f;
template <class R>
R powerOfTwo(const R& x) {
    const float e = std::exp2(valueOf(x));
    return chain(x, e, [&] { return e * kLogOf2; });
}
template <class R>
R binaryLogarithm(const R& x) {
    const float a = valueOf(x);
    return chain(x, std::log2(a), [&] { return 1.0f / (a * kLogOf2); });
}
template <class R>
R squareRoot(const R& x) {
    const float root = std::sqrt(valueOf(x));
    return chain(x, root, [&] { return 0.5f / root; });
}
template <class R>
R inverseSquareRoot(const R& x) {
    const float a = valueOf(x), inverse = 1.0f / std::sqrt(a);
    return chain(x, inverse, [&] { return -0.5f * inverse / a; });
}
template <class R>
R scaleByPower(const R& x, int exponent) {
    return chain(x, std::ldexp(valueOf(x), exponent), [&] { return std::ldexp(1.0f, exponent); });
}
template <class R>
R significand(const R& x) {
    int exponent = 0;
    const float value = std::frexp(valueOf(x), &exponent);
    return chain(x, value, [&] { return std::ldexp(1.0f, -exponent); });
}

} // namespace touchstone::program
