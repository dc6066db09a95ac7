// Limits, gradients and control flow of the executor.

#include "program_bench.h"
#include "tests/support/allocation_counter.h"

#include <cstdio>
#include <limits>

namespace touchstone::program {
namespace {

RunResult runAt(const RegisterProgram& program, const Inputs& inputs, Inputs& outputs) {
    return run(program, inputs, outputs);
}

TEST(ProgramExecutor, AProgramThatDoesNothingReturnsWhatWasThereBefore) {
    const RegisterProgram program = programOf(touchBody(""));
    Inputs out{};
    ASSERT_EQ(runAt(program, inputsAt(1, 2, 3), out).ending, Ending::Finished);
    EXPECT_EQ(out[kOutPosition], (PortValue{1, 2, 3, 0}));
    EXPECT_EQ(out[kOutForce], (PortValue{0, 0, 2, 0}));
    EXPECT_EQ(out[kOutMaterial], (PortValue{0.4f, 0.3f, 600.0f, 1.0f}));
}

TEST(ProgramExecutor, LoopsConditionsSwitchesAndArraysComputeWhatTheyDoInCpp) {
    const RegisterProgram program = programOf(R"(
float table[5] = float[](0.5, -1.0, 2.0, 4.0, 0.25);
float choose(int i) {
    switch (i) {
    case 0: return 1.0;
    case 1:
    case 2: return table[i] * 3.0;
    default: break;
    }
    return -1.0;
}
void touch(const in Touch before, inout Surface after) {
    float a = 1.0, b = 0.0;
    int n = int(before.position.x);
    for (int i = 0; i < n; i++) {
        if (i == 7) continue;
        float swap = a; a = b + a; b = swap;            // two values that follow each other
        b += choose(i % 4) * table[i % 5];
        if (a > 1e6) break;
    }
    after.force = vec3(a, b, table[n % 5]);
})");
    const float table[5] = {0.5f, -1.0f, 2.0f, 4.0f, 0.25f};
    for (int n = 0; n < 60; ++n) {
        float a = 1.0f, b = 0.0f;
        for (int i = 0; i < n; ++i) {
            if (i == 7)
                continue;
            const float swap = a;
            a = b + a;
            b = swap;
            const int k = i % 4;
            b += (k == 0 ? 1.0f : k == 3 ? -1.0f : table[k] * 3.0f) * table[i % 5];
            if (a > 1e6f)
                break;
        }
        Inputs out{};
        ASSERT_EQ(runAt(program, inputsAt(static_cast<float>(n), 0, 0), out).ending, Ending::Finished);
        EXPECT_NEAR(out[kOutForce][0], a, 1e-5f * std::abs(a)) << n;
        EXPECT_NEAR(out[kOutForce][1], b, 1e-5f * (std::abs(b) + std::abs(a))) << n;
        EXPECT_EQ(out[kOutForce][2], table[n % 5]);
    }
}

TEST(ProgramExecutor, EveryProgramThatDoesNotEndIsEndedAtTheBudget) {
    for (const char* body :
         {"for (;;) { if (before.force.x > 1e9) break; after.force.y += sin(after.force.x); }",
          "for (int i = 0; i < 2000000000; i++) after.force.x += before.force.z;",
          "int i = 0; do { for (int k = 0; k < 100000; k++) { i ^= k; } } while (i >= -5 || i < -5);"
          " after.force.x = float(i);"}) {
        const RegisterProgram program = programOf(touchBody(body));
        Inputs out{};
        const RunResult result = runAt(program, inputsAt(0, 0, 0), out);
        EXPECT_EQ(result.ending, Ending::BudgetReached) << body;
        EXPECT_LE(result.cost, 2 * kBudget) << body;
    }
}

TEST(ProgramExecutor, WhatHasNoResultEndsTheRun) {
    const struct {
        const char* body;
        Ending ending;
    } cases[] = {
        {"while (true) { after.force.x += 1.0; }", Ending::NotFinite}, // the compiler leaves nothing of it
        {"float a[4]; a[int(before.position.x)] = 1.0; after.force.x = a[2];", Ending::BadIndex},
        {"float a[4] = float[](1.,2.,3.,4.); after.force.x = a[int(-before.position.x)];", Ending::BadIndex},
        {"after.force[int(before.position.x)] = 1.0;", Ending::BadIndex},
        {"mat3 m = mat3(before.position.y); after.force = m[int(before.position.x)];", Ending::BadIndex},
        {"after.force.x = float(7 / int(before.position.y));", Ending::DivisionByZero},
        {"after.force.x = float(7 % int(before.position.y));", Ending::DivisionByZero},
        {"after.force.x = float(7u / uint(before.position.y));", Ending::DivisionByZero},
        {"after.force.x = 1.0 / before.position.y;", Ending::NotFinite},
        {"after.force.x = before.position.y / before.position.y;", Ending::NotFinite},
        {"after.force.x = sqrt(-before.position.x);", Ending::NotFinite},
        {"after.staticFriction = before.position.x * 1e38 * 1e38;", Ending::NotFinite},
        {"after.position = normalize(vec3(before.position.y));", Ending::NotFinite},
    };
    for (const auto& one : cases) {
        const RegisterProgram program = programOf(touchBody(one.body));
        Inputs out{};
        EXPECT_EQ(runAt(program, inputsAt(9, 0, 0), out).ending, one.ending) << one.body;
        DualInputs dual{};
        EXPECT_EQ(runDual(program, dualInputs(inputsAt(9, 0, 0)), dual).ending, one.ending) << one.body;
    }
}

TEST(ProgramExecutor, ArraysInsideTheirBoundsAreReadAndWritten) {
    const RegisterProgram program = programOf(touchBody(R"(
    vec2 a[3][2];
    for (int i = 0; i < 3; i++)
        for (int k = 0; k < 2; k++)
            a[i][k] = vec2(10 * i + k, -i);
    int i = int(before.position.x);
    after.force = vec3(a[i][1].x, a[2 - i][0].y, a[i][i / 2][1]);)"));
    for (int i = 0; i < 3; ++i) {
        Inputs out{};
        ASSERT_EQ(runAt(program, inputsAt(static_cast<float>(i), 0, 0), out).ending, Ending::Finished);
        EXPECT_EQ(out[kOutForce][0], static_cast<float>(10 * i + 1));
        EXPECT_EQ(out[kOutForce][1], static_cast<float>(i - 2));
        EXPECT_EQ(out[kOutForce][2], static_cast<float>(-i));
    }
}

TEST(ProgramExecutor, GradientsOfASineDisplacementAreThoseOfTheClosedForm) {
    const RegisterProgram program = programOf(
        touchBody("after.position.z += 1e-3 * sin(400.0 * before.position.x + 100.0 * before.position.y);"));
    double dual = 0.0, central = 0.0;
    for (int i = 0; i < 200; ++i) {
        const float x = 0.0001f * static_cast<float>(i), y = 0.003f - 0.5f * x;
        DualInputs out{};
        ASSERT_EQ(runDual(program, dualInputs(inputsAt(x, y, 0.01f)), out).ending, Ending::Finished);
        const double phase = 400.0 * static_cast<double>(x) + 100.0 * static_cast<double>(y);
        const double slope = 0.4 * std::cos(phase);
        EXPECT_NEAR(out[kOutPosition].d[2][0], slope, 1e-6);
        EXPECT_NEAR(out[kOutPosition].d[2][1], 0.1 * std::cos(phase), 1e-6);
        EXPECT_EQ(out[kOutPosition].d[2][2], 1.0f);
        dual = std::max(dual, std::abs(static_cast<double>(out[kOutPosition].d[2][0]) - slope));
        constexpr float kStep = 1e-4f; // ProgramContact::differenceStep
        const auto height = [&](float at) {
            return static_cast<double>(outputAt(program, inputsAt(at, y, 0.01f), kOutPosition)[2]);
        };
        const float low = x - kStep, high = x + kStep;
        const double quotient =
            (height(high) - height(low)) / (static_cast<double>(high) - static_cast<double>(low));
        central = std::max(central, std::abs(quotient - slope));
    }
    std::printf("greatest error of a slope of 0.4: dual numbers %.1e, central differences over 0.2 mm %.1e\n",
                dual, central);
}

TEST(ProgramExecutor, DualNumbersHaveTheValuesOfNumbersToTheBit) {
    const RegisterProgram program = programOf(touchBody(
        "float n = fBm(before.position * 300.0, 4, 0.5); after.position += 1e-3 * n * before.normal;"
        "after.staticFriction = 0.3 + 0.2 * cellular(before.position * 100.0);"
        "after.force = mat3(0.5) * before.force * pow(1.1, n) + cross(before.position, before.normal);"));
    for (int i = 0; i < 100; ++i) {
        const float t = 0.001f * static_cast<float>(i);
        const Inputs in = inputsAt(t, 0.01f - t, 3.0f * t);
        Inputs out{};
        DualInputs dual{};
        ASSERT_EQ(runAt(program, in, out).ending, Ending::Finished);
        ASSERT_EQ(runDual(program, dualInputs(in), dual).ending, Ending::Finished);
        for (size_t port = 0; port < 4; ++port)
            EXPECT_EQ(out[port], dual[port].v);
    }
}

TEST(ProgramExecutor, ARunAllocatesNothing) {
    const RegisterProgram program =
        programOf(touchBody("after.force *= 1.0 + fBm(before.position, 3, 0.5);"));
    const Inputs in = inputsAt(0.1f, 0.2f, 0.3f);
    const DualInputs dual = dualInputs(in);
    Inputs out{};
    DualInputs dualOut{};
    const uint64_t before = test::allocationsOnThisThread();
    (void)run(program, in, out);
    (void)runDual(program, dual, dualOut);
    EXPECT_EQ(test::allocationsOnThisThread(), before);
}

} // namespace
} // namespace touchstone::program
