// Every operation that programs have, against GLM in double precision: the same text is compiled as GLSL for
// the executor and as C++ for the reference.

#include "program_bench.h"

#include <glm/glm.hpp>
#include <glm/gtc/integer.hpp>
#include <glm/gtc/matrix_transform.hpp>

#include <random>

namespace touchstone::program {
namespace {

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
double trunc(double x) {
    return std::trunc(x);
}
/// GLM's does not extend the sign.
int bitfieldExtract(int x, int offset, int bits) {
    return static_cast<int>(static_cast<uint>(x) << (32 - offset - bits)) >> (32 - bits);
}
uint bitfieldExtract(uint x, int offset, int bits) {
    return glm::bitfieldExtract(x, offset, bits);
}
/// GLM gives 31 for every negative number; GLSL asks for the highest bit that differs from the sign.
int findMSB(int x) {
    return glm::findMSB(x < 0 ? ~x : x);
}
int findMSB(uint x) {
    return glm::findMSB(x);
}
double roundEven(double x) {
    return std::nearbyint(x);
}
double ldexp(double x, int n) {
    return std::ldexp(x, n);
}
double fma(double a, double b, double c) {
    return std::fma(a, b, c);
}
double atan(double y, double x) {
    return std::atan2(y, x);
}
double atan(double x) {
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

const std::vector<Expression> kExpressions = {
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

std::string programWith(size_t first) {
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

TEST(ProgramConformance, EveryOperationComputesWhatGlmDoesInDoublePrecision) {
    std::mt19937 random(7);
    for (size_t first = 0; first < reference::kExpressions.size(); first += kTogether) {
        const RegisterProgram program = programOf(programWith(first));
        for (int trial = 0; trial < 2000; ++trial) {
            // Multiples of 2^-12, whose thousandths a float holds exactly: no integer is on the edge.
            const auto coordinate = [&] {
                return static_cast<float>(static_cast<int>(random() % 32767) - 16383) / 4096.0f;
            };
            const float x = coordinate(), y = coordinate(), z = coordinate();
            Inputs out{};
            const RunResult result = run(program, inputsAt(x, y, z), out);
            for (size_t i = 0; i < kTogether && first + i < reference::kExpressions.size(); ++i) {
                const Expression& expression = reference::kExpressions[first + i];
                const double wanted = expression.reference(static_cast<double>(x), static_cast<double>(y),
                                                           static_cast<double>(z));
                const double got = static_cast<double>(out[i / 3][i % 3]);
                ASSERT_NEAR(got, static_cast<double>(static_cast<float>(wanted)),
                            expression.tolerance * (1.0 + std::abs(wanted)))
                    << expression.glsl << " at " << x << ", " << y << ", " << z;
            }
            ASSERT_EQ(result.ending, Ending::Finished);
        }
    }
}

/// Derivatives against central differences of the same expressions in double precision.
TEST(ProgramConformance, DualNumbersDifferentiateEveryOperation) {
    std::mt19937 random(11);
    constexpr double kStep = 1e-6;
    for (size_t first = 0; first < reference::kExpressions.size(); first += kTogether) {
        const RegisterProgram program = programOf(programWith(first));
        for (int trial = 0; trial < 300; ++trial) {
            const auto coordinate = [&] {
                return static_cast<float>(static_cast<int>(random() % 32767) - 16383) / 4096.0f + 1.2345e-4f;
            };
            const std::array<float, 3> at = {coordinate(), coordinate(), coordinate()};
            DualInputs out{};
            (void)runDual(program, dualInputs(inputsAt(at[0], at[1], at[2])), out);
            for (size_t i = 0; i < kTogether && first + i < reference::kExpressions.size(); ++i) {
                const Expression& expression = reference::kExpressions[first + i];
                for (size_t k = 0; k < 3; ++k) {
                    std::array<double, 3> low{}, high{};
                    for (size_t j = 0; j < 3; ++j)
                        low[j] = high[j] = static_cast<double>(at[j]);
                    low[k] -= kStep;
                    high[k] += kStep;
                    const auto value = [&](const std::array<double, 3>& p) {
                        return expression.reference(p[0], p[1], p[2]);
                    };
                    const double slope = (value(high) - value(low)) / (2.0 * kStep);
                    if (std::abs(slope) > 1e3)
                        continue; // a jump lies between
                    ASSERT_NEAR(static_cast<double>(out[i / 3].d[i % 3][k]), slope,
                                2e-3 * (1.0 + std::abs(slope)))
                        << expression.glsl << " by " << k << " at " << at[0] << ", " << at[1] << ", "
                        << at[2];
                }
            }
        }
    }
}

TEST(ProgramConformance, StructResultsHaveBothParts) {
    const RegisterProgram program = programOf(touchBody(
        "int e; vec3 whole; float s = frexp(before.position.x, e); vec3 part = modf(before.position, whole);"
        "after.force = vec3(s, float(e), part.y); after.normal = whole;"
        "uint high, low; umulExtended(0xdeadbeefu, uint(before.position.z), high, low);"
        "uint carry, borrow; uint sum = uaddCarry(0xfffffff0u, uint(before.position.z), carry);"
        "uint less = usubBorrow(5u, uint(before.position.z), borrow);"
        "after.staticFriction = float(high); after.dynamicFriction = float(low & 0xffffu);"
        "after.stiffness = float(sum) + 1000.0 * float(carry);"
        "after.damping = float(less & 0xffffu) + 100000.0 * float(borrow);"));
    Inputs out{};
    ASSERT_EQ(run(program, inputsAt(12.5f, -3.75f, 300.0f), out).ending, Ending::Finished);
    EXPECT_EQ(out[kOutForce], (PortValue{0.78125f, 4.0f, -0.75f, 0.0f}));
    EXPECT_EQ(out[kOutNormal], (PortValue{12.0f, -3.0f, 300.0f, 0.0f}));
    const uint64_t product = uint64_t{0xdeadbeefu} * 300u;
    EXPECT_EQ(out[kOutMaterial][0], static_cast<float>(product >> 32));
    EXPECT_EQ(out[kOutMaterial][1], static_cast<float>(product & 0xffffu));
    EXPECT_EQ(out[kOutMaterial][2], 284.0f + 1000.0f);
    EXPECT_EQ(out[kOutMaterial][3], static_cast<float>((5u - 300u) & 0xffffu) + 100000.0f);
}

TEST(ProgramConformance, ConversionsThatCppLeavesOpenSaturate) {
    const RegisterProgram program = programOf(
        touchBody("after.force = vec3(float(int(before.position.x)), float(uint(before.position.x)), 0.0);"));
    const auto at = [&](float x) {
        Inputs out{};
        (void)run(program, inputsAt(x, 0, 0), out);
        return out[kOutForce];
    };
    EXPECT_EQ(at(1e20f), (PortValue{2147483648.0f, 4294967296.0f, 0.0f, 0.0f}));
    EXPECT_EQ(at(-1e20f), (PortValue{-2147483648.0f, 0.0f, 0.0f, 0.0f}));
    EXPECT_EQ(at(std::nanf("")), (PortValue{0.0f, 0.0f, 0.0f, 0.0f}));
}

} // namespace
} // namespace touchstone::program
