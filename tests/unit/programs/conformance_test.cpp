// Every operation that programs have, against GLM in double precision: the same text is compiled as GLSL for
// the executor and as C++ for the reference.

#include "conformance_expressions.h"

#include <glslang/SPIRV/spirv.hpp>

#include <random>
#include <set>

namespace touchstone::program {
namespace {

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

constexpr const char* kOperationNames[] = {
#define TOUCHSTONE_OPERATION(name, cost) #name,
    TOUCHSTONE_PROGRAM_OPERATIONS(TOUCHSTONE_OPERATION)
#undef TOUCHSTONE_OPERATION
};

/// Operations of SPIR-V that glslang makes of no GLSL: in place of those that it makes.
struct Replaced {
    const char* body; ///< before.uv has the operands
    spv::Op from, to;
    double (*reference)(double x, double y);
};
const Replaced kReplaced[] = {
    {"after.damping = mod(before.uv.x, before.uv.y);", spv::OpFMod, spv::OpFRem,
     [](double x, double y) { return std::fmod(x, y); }},
    {"after.damping = float(int(before.uv.x) % int(before.uv.y));", spv::OpSMod, spv::OpSRem,
     [](double x, double y) { return double(int(x) % int(y)); }},
    {"after.damping = before.uv.x == before.uv.y ? 1.0 : 0.0;", spv::OpFOrdEqual, spv::OpFUnordEqual,
     [](double x, double y) { return !(x < y || x > y) ? 1.0 : 0.0; }},
    {"after.damping = before.uv.x == before.uv.y ? 1.0 : 0.0;", spv::OpFOrdEqual, spv::OpFOrdNotEqual,
     [](double x, double y) { return x < y || x > y ? 1.0 : 0.0; }},
    {"after.damping = before.uv.x < before.uv.y ? 1.0 : 0.0;", spv::OpFOrdLessThan, spv::OpFUnordLessThan,
     [](double x, double y) { return !(x >= y) ? 1.0 : 0.0; }},
    {"after.damping = before.uv.x < before.uv.y ? 1.0 : 0.0;", spv::OpFOrdLessThan,
     spv::OpFUnordLessThanEqual, [](double x, double y) { return !(x > y) ? 1.0 : 0.0; }},
    {"after.damping = before.uv.x < before.uv.y ? 1.0 : 0.0;", spv::OpFOrdLessThan, spv::OpFUnordGreaterThan,
     [](double x, double y) { return !(x <= y) ? 1.0 : 0.0; }},
};

TEST(ProgramConformance, OperationsThatGlslangMakesOfNoGlslComputeWhatSpirvSays) {
    const float nan = std::nanf("");
    for (const Replaced& each : kReplaced) {
        const std::vector<uint32_t> words = spirvOf(touchBody(each.body)),
                                    other = replaced(words, each.from, each.to);
        ASSERT_NE(words, other) << each.body;
        const Translation translation = translateSpirv(other);
        ASSERT_FALSE(translation.problem) << each.body;
        const bool ofNumbers = each.to == spv::OpFRem || each.to == spv::OpSRem;
        for (const float x : {-7.5f, -2.0f, 0.0f, 3.0f, 7.5f, nan})
            for (const float y : {-3.0f, 2.0f, 3.0f, nan}) {
                if (ofNumbers && (std::isnan(x) || std::isnan(y)))
                    continue;
                Inputs in = inputsAt(0.0f, 0.0f, 0.0f);
                in[kUv] = {x, y, 0.0f, 0.0f};
                EXPECT_EQ(static_cast<double>(outputAt(translation.program, in, kOutMaterial)[3]),
                          each.reference(static_cast<double>(x), static_cast<double>(y)))
                    << each.body << " " << each.to << " at " << x << ", " << y;
            }
    }
}

constexpr const char* kStructBody =
    "int e; vec3 whole; float s = frexp(before.position.x, e); vec3 part = modf(before.position, whole);"
    "after.force = vec3(s, float(e), part.y); after.normal = whole;"
    "uint high, low; umulExtended(0xdeadbeefu, uint(before.position.z), high, low);"
    "uint carry, borrow; uint sum = uaddCarry(0xfffffff0u, uint(before.position.z), carry);"
    "uint less = usubBorrow(5u, uint(before.position.z), borrow);"
    "after.staticFriction = float(high); after.dynamicFriction = float(low & 0xffffu);"
    "after.stiffness = float(sum) + 1000.0 * float(carry);"
    "after.damping = float(less & 0xffffu) + 100000.0 * float(borrow);"
    "int signedHigh, signedLow; imulExtended(-1234567890, int(before.position.z), signedHigh, signedLow);"
    "after.position = vec3(float(signedHigh), float(signedLow & 0xffff), 0.0);";

TEST(ProgramConformance, StructResultsHaveBothParts) {
    const RegisterProgram program = programOf(touchBody(kStructBody));
    Inputs out{};
    ASSERT_EQ(run(program, inputsAt(12.5f, -3.75f, 300.0f), out).ending, Ending::Finished);
    EXPECT_EQ(out[kOutForce], (PortValue{0.78125f, 4.0f, -0.75f, 0.0f}));
    EXPECT_EQ(out[kOutNormal], (PortValue{12.0f, -3.0f, 300.0f, 0.0f}));
    const uint64_t product = uint64_t{0xdeadbeefu} * 300u;
    EXPECT_EQ(out[kOutMaterial][0], static_cast<float>(product >> 32));
    EXPECT_EQ(out[kOutMaterial][1], static_cast<float>(product & 0xffffu));
    EXPECT_EQ(out[kOutMaterial][2], 284.0f + 1000.0f);
    EXPECT_EQ(out[kOutMaterial][3], static_cast<float>((5u - 300u) & 0xffffu) + 100000.0f);
    const int64_t signedProduct = int64_t{-1234567890} * 300;
    EXPECT_EQ(out[kOutPosition][0], static_cast<float>(signedProduct >> 32));
    EXPECT_EQ(out[kOutPosition][1], static_cast<float>(signedProduct & 0xffff));
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

/// No operation of the executor is without a comparison in these files.
TEST(ProgramConformance, EveryOperationIsMet) {
    std::set<Operation> met;
    const auto meet = [&](const RegisterProgram& program) {
        for (const Instruction& each : program.instructions)
            met.insert(each.operation);
    };
    for (size_t first = 0; first < reference::kExpressions.size(); first += kTogether)
        meet(programOf(programWith(first)));
    meet(programOf(touchBody(kStructBody)));
    for (const Replaced& each : kReplaced)
        meet(translateSpirv(replaced(spirvOf(touchBody(each.body)), each.from, each.to)).program);
    // ProgramExecutor.LoopsConditionsSwitchesAndArraysComputeWhatTheyDoInCpp, in short.
    meet(programOf(
        touchBody("float t[3] = float[](1.0, 2.0, 3.0); int n = int(before.position.x);\n"
                  "for (int i = 0; i < n; i++) switch (i & 3) { case 0: t[i % 3] += 1.0; break;\n"
                  "case 2: if (t[1] > 4.0) return; continue; default: after.damping += t[i % 3]; }")));
    for (size_t i = 0; i < std::size(kOperationNames); ++i)
        EXPECT_TRUE(met.contains(static_cast<Operation>(i))) << kOperationNames[i];
}

} // namespace
} // namespace touchstone::program
