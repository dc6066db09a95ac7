#pragma once
// Every operation that programs have, as GLSL and as C++ of GLM in double precision: the same text is
// compiled as both.

#include "program_bench.h"

#include <glm/glm.hpp>
#include <glm/gtc/integer.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <cmath>
#include <string>
#include <vector>

namespace touchstone::program {

struct Expression {
    const char* glsl;
    double (*reference)(double x, double y, double z);
    double tolerance; ///< absolute, and relative to the value
};

namespace reference {

using vec2 = glm::dvec2;
using vec3 = glm::dvec3;
using vec4 = glm::dvec4;
using mat2 = glm::dmat2;
using mat3 = glm::dmat3;
using mat4 = glm::dmat4;
using glm::bvec3;
using glm::ivec3;
using glm::uint;
using glm::uvec3;
using namespace glm; // NOLINT: GLSL's names
inline double trunc(double x) {
    return std::trunc(x);
}
/// GLM's does not extend the sign.
inline int bitfieldExtract(int x, int offset, int bits) {
    return static_cast<int>(static_cast<uint>(x) << (32 - offset - bits)) >> (32 - bits);
}
inline uint bitfieldExtract(uint x, int offset, int bits) {
    return glm::bitfieldExtract(x, offset, bits);
}
/// GLM gives 31 for every negative number; GLSL asks for the highest bit that differs from the sign.
inline int findMSB(int x) {
    return glm::findMSB(x < 0 ? ~x : x);
}
inline int findMSB(uint x) {
    return glm::findMSB(x);
}
inline double roundEven(double x) {
    return std::nearbyint(x);
}
inline double ldexp(double x, int n) {
    return std::ldexp(x, n);
}
inline double fma(double a, double b, double c) {
    return std::fma(a, b, c);
}
inline double atan(double y, double x) {
    return std::atan2(y, x);
}
inline double atan(double x) {
    return std::atan(x);
}

// x, y, z: -4 to 4. a, b, c: integers out of them.
#define BOTH(expression, tolerance)                                                                            \
    Expression {                                                                                               \
#expression,                                                                                                 \
            [](double x, double y, double z) {                                                               \
                const int a = int(x * 1000.0), b = int(y * 1000.0), c = int(z * 1000.0);                     \
                const uint u = uint(x * 1000.0 + 4000.0), v = uint(y * 1000.0 + 4001.0);                     \
                (void)a, (void)b, (void)c, (void)u, (void)v, (void)z;                                        \
                return double(expression);                                                                   \
            },                                                                                               \
            tolerance \
    }

inline const std::vector<Expression> kExpressions = {
    BOTH(x + y * z - x / (y + 10.0), 1e-6),
    BOTH(-x, 0),
    BOTH(mod(x, y + 10.0), 1e-6),
    BOTH(mod(x, y - 10.0), 1e-6),
    BOTH(abs(x), 0),
    BOTH(sign(x), 0),
    BOTH(floor(x), 0),
    BOTH(ceil(x), 0),
    BOTH(fract(x), 1e-6),
    BOTH(trunc(x), 0),
    BOTH(round(x), 0),
    BOTH(roundEven(x), 0),
    BOTH(radians(x * 100.0), 1e-6),
    BOTH(degrees(x), 1e-6),
    BOTH(sin(x), 1e-6),
    BOTH(cos(x), 1e-6),
    BOTH(tan(x * 0.3), 1e-6),
    BOTH(asin(x * 0.25), 1e-6),
    BOTH(acos(x * 0.25), 1e-6),
    BOTH(atan(x), 1e-6),
    BOTH(atan(x, y), 1e-6),
    BOTH(sinh(x), 1e-6),
    BOTH(cosh(x), 1e-6),
    BOTH(tanh(x), 1e-6),
    BOTH(asinh(x), 1e-6),
    BOTH(acosh(x + 5.5), 1e-6),
    BOTH(atanh(x * 0.24), 1e-5),
    BOTH(pow(x + 4.5, y), 3e-6),
    BOTH(exp(x), 1e-6),
    BOTH(log(x + 4.5), 1e-6),
    BOTH(exp2(x), 1e-6),
    BOTH(log2(x + 4.5), 1e-6),
    BOTH(sqrt(x + 4.5), 1e-6),
    BOTH(inversesqrt(x + 4.5), 1e-6),
    BOTH(min(x, y), 0),
    BOTH(max(x, y), 0),
    BOTH(clamp(x, -1.0, y + 5.0), 1e-6),
    BOTH(mix(x, y, z), 3e-6),
    BOTH(step(x, y), 0),
    BOTH(smoothstep(-1.0, y + 4.5, x), 1e-6),
    BOTH(fma(x, y, z), 1e-6),
    BOTH(ldexp(x, 5), 0),
    BOTH(length(vec3(x, y, z)), 1e-6),
    BOTH(distance(vec2(x, y), vec2(y, z)), 1e-6),
    BOTH(length(vec4(x, y, z, x)), 1e-6),
    BOTH(dot(vec3(x, y, z), vec3(z, x, 1.0)), 2e-6),
    BOTH(cross(vec3(x, y, z), vec3(z, 2.0, x)).y, 3e-6),
    BOTH(normalize(vec3(x, y, 5.0)).x, 1e-6),
    BOTH(faceforward(vec3(x, y, 1.0), vec3(z, 1.0, 0.1), vec3(1.0, 0.3, x)).y, 1e-6),
    BOTH(reflect(vec3(x, y, z), normalize(vec3(1.0, z, 2.0))).z, 5e-6),
    BOTH(refract(normalize(vec3(x, 1.0, z)), normalize(vec3(1.0, y, 2.0)), 0.7).x, 1e-5),
    BOTH(refract(normalize(vec3(x, 5.0, z)), vec3(0.0, 0.0, 1.0), 1.6).y, 2e-5),
    BOTH((mat3(x, y, z, 1.0, 2.0, 3.0, z, x, y) * vec3(y, z, x)).y, 1e-5),
    BOTH((vec3(y, z, x) * mat3(x, y, z, 1.0, 2.0, 3.0, z, x, y)).z, 1e-5),
    BOTH((mat2(x, y, z, 1.0) * mat2(2.0, x, y, z))[1].x, 1e-5),
    BOTH((mat3(x, y, z, 1.0, 2.0, 3.0, z, x, y) * 2.0)[2].y, 1e-6),
    BOTH(transpose(mat3(x, y, z, 1.0, 2.0, 3.0, z, x, y))[0].z, 0),
    BOTH(outerProduct(vec3(x, y, z), vec3(y, z, 2.0))[2].y, 1e-6),
    BOTH(determinant(mat3(x, y, z, 1.0, 2.0, 3.0, z, x, 9.0)), 1e-4),
    BOTH(determinant(mat4(x, y, z, 1.0, 2.0, 3.0, z, x, 9.0, 1.0, y, 7.0, 5.0, x, 2.0, 1.0)), 1e-3),
    BOTH(inverse(mat2(x, 6.0, 7.0, y))[1].x, 1e-5),
    BOTH(inverse(mat3(x, 6.0, 7.0, 8.0, y, 1.0, 6.0, 9.0, z) + mat3(12.0))[1].z, 1e-5),
    BOTH(inverse(mat4(20.0 + x, y, z, 1.0, 2.0, 30.0, z, x, 9.0, 1.0, 40.0 + y, 7.0, 5.0, x, 2.0, 25.0))[2].w,
         1e-5),
    BOTH(x < y ? z : x, 0),
    BOTH(x > y ? z : x, 0),
    BOTH(x <= y ? z : x, 0),
    BOTH(x >= y ? z : x, 0),
    BOTH(x == floor(x) ? 1.0 : 2.0, 0),
    BOTH(x != floor(x) ? 1.0 : 2.0, 0),
    BOTH((x < 1.0 && !(y > 0.5)) || z > 1.0 ? 1.0 : 0.0, 0),
    BOTH((x < 1.0) == (y < 1.0) ? 1.0 : 0.0, 0),
    BOTH((x < 1.0) != (y < 1.0) ? 1.0 : 0.0, 0),
    BOTH(any(lessThan(vec3(x, y, z), vec3(-1.0))) ? 1.0 : 0.0, 0),
    BOTH(all(greaterThanEqual(vec3(x, y, z), vec3(-1.0, 0.0, -2.0))) ? 1.0 : 0.0, 0),
    BOTH(mix(vec3(x, y, z), vec3(1.0), lessThan(vec3(x, y, z), vec3(0.0))).y, 0),
    BOTH(isinf(x) || isnan(y) ? 1.0 : 0.0, 0),
    BOTH(vec4(vec2(x, y), vec2(z, 1.0)).z, 0),
    BOTH(a + b * c - 7, 0),
    BOTH(a / (abs(b) + 1), 0),
    BOTH(abs(a) % (abs(b) + 1), 0),
    BOTH(u / v + u % v, 0),
    BOTH(-a, 0),
    BOTH(abs(a) + sign(b), 0),
    BOTH(min(a, b) + 2 * max(a, c), 0),
    BOTH(clamp(a, -100, 1000), 0),
    BOTH(min(u, v) + 2u * max(u, v), 0),
    BOTH(clamp(u, 10u, 5000u), 0),
    BOTH(a << 3, 0),
    BOTH(a >> 2, 0),
    BOTH(u >> 2u, 0),
    BOTH((a & b) + (a | c) - (a ^ b), 0),
    BOTH(~a, 0),
    BOTH(float(u * 0x9e3779b9u >> 8u), 0),
    BOTH(bitfieldReverse(u) >> 12u, 0),
    BOTH(bitCount(u), 0),
    BOTH(bitfieldExtract(a, 3, 7), 0),
    BOTH(bitfieldExtract(u, 3, 7), 0),
    BOTH(bitfieldInsert(u, v, 4, 6), 0),
    BOTH(findLSB(v), 0),
    BOTH(findMSB(v), 0),
    BOTH(findMSB(a), 0),
    BOTH(a < b ? 1 : 0, 0),
    BOTH(a <= b ? 1 : 0, 0),
    BOTH(a > b ? 1 : 0, 0),
    BOTH(a >= b ? 1 : 0, 0),
    BOTH(a == b || a != c ? 1 : 0, 0),
    BOTH(u < v ? 1 : 0, 0),
    BOTH(u <= v ? 1 : 0, 0),
    BOTH(u > v ? 1 : 0, 0),
    BOTH(u >= v ? 1 : 0, 0),
};
#undef BOTH

} // namespace reference

/// Twelve expressions in one program: the outputs' components.
constexpr size_t kTogether = 12;

inline std::string programWith(size_t first) {
    std::string body = "float x = before.position.x, y = before.position.y, z = before.position.z;\n"
                       "int a = int(x * 1000.0), b = int(y * 1000.0), c = int(z * 1000.0);\n"
                       "uint u = uint(x * 1000.0 + 4000.0), v = uint(y * 1000.0 + 4001.0);\n";
    const std::array<const char*, kTogether> places = {
        "after.position.x", "after.position.y",     "after.position.z",      "after.normal.x",
        "after.normal.y",   "after.normal.z",       "after.force.x",         "after.force.y",
        "after.force.z",    "after.staticFriction", "after.dynamicFriction", "after.stiffness"};
    for (size_t i = 0; i < kTogether && first + i < reference::kExpressions.size(); ++i)
        body += std::string(places[i]) + " = float(" + reference::kExpressions[first + i].glsl + ");\n";
    return touchBody(body);
}

} // namespace touchstone::program
