// The programs of surfaces.glb and heights.glb, each against its formula in long double.

#include "engine/program/surface_program.h"
#include "haptics/program/felt_program.h"
#include "noise_reference.h"
#include "program_bench.h"

#include <nlohmann/json.hpp>

namespace touchstone::program {
namespace {

constexpr long double kFullTurn = 6.28318530717958647692L;

/// The displacement along z that the program returns at a place.
long double heightAt(const RegisterProgram& program, const Inputs& in) {
    return exact(outputAt(program, in, kOutPosition)[2]) - exact(in[kPosition][2]);
}

TEST(SurfacePrograms, SandpaperIsItsFormula) {
    RegisterProgram program = paperProgram("sandpaper.glsl");
    setParameter(program, "height", 1.0f);
    for (int i = 0; i < 2000; ++i) {
        const auto [x, y, z] = placeOf(i);
        const auto octave = [&](long double f) { return noiseAt(exact(x) * f, exact(y) * f, exact(z) * f); };
        const Inputs in = inputsAt(x, y, z);
        ASSERT_NEAR(static_cast<double>(heightAt(program, in)),
                    static_cast<double>(octave(1200.0L) + 0.5L * octave(2400.0L)), 3e-5);
        const PortValue material = outputAt(program, in, kOutMaterial);
        ASSERT_EQ(material[0], 0.7f);
        ASSERT_NEAR(static_cast<double>(material[1]), 0.56, 1e-6);
    }
}

TEST(SurfacePrograms, KnurlIsItsFormula) {
    RegisterProgram program = paperProgram("knurl.glsl");
    setParameter(program, "pitch", 0.01f);
    setParameter(program, "depth", 0.005f);
    for (int i = 0; i < 2000; ++i) {
        const auto [x, y, z] = placeOf(i);
        const auto ridge = [&](long double across) {
            return 0.5L + 0.5L * std::cos(kFullTurn * across * std::sqrt(0.5L) / exact(0.01f));
        };
        const long double wanted =
            exact(0.005f) * (ridge(exact(x) + exact(y)) * ridge(exact(x) - exact(y)) - 0.25L);
        ASSERT_NEAR(static_cast<double>(heightAt(program, inputsAt(x, y, 0.0f))), static_cast<double>(wanted),
                    5e-8);
        (void)z;
    }
}

TEST(SurfacePrograms, BrushedMetalIsItsFormula) {
    RegisterProgram program = paperProgram("brushed_metal.glsl");
    setParameter(program, "depth", 0.001f);
    for (int i = 0; i < 2000; ++i) {
        const auto [x, y, z] = placeOf(i);
        Inputs in = inputsAt(x, y, 0.0f);
        const long double angle = 0.01L * static_cast<long double>(i);
        in[kToolDirection] = {static_cast<float>(std::cos(angle)), static_cast<float>(std::sin(angle))};
        const long double share = std::abs(exact(in[kToolDirection][0]));
        const PortValue material = outputAt(program, in, kOutMaterial);
        ASSERT_NEAR(static_cast<double>(material[0]), static_cast<double>(0.45L + (0.08L - 0.45L) * share),
                    1e-6);
        ASSERT_NEAR(static_cast<double>(material[1]), 0.8 * static_cast<double>(material[0]), 1e-6);
        // Across the x axis under the normal z: along y.
        ASSERT_NEAR(static_cast<double>(heightAt(program, in)),
                    static_cast<double>(exact(0.001f) * noiseAt(exact(y) * 900.0L)), 1e-7);
        (void)z;
    }
}

TEST(SurfacePrograms, FabricIsItsFormula) {
    RegisterProgram program = paperProgram("fabric.glsl");
    setParameter(program, "height", 0.003f);
    for (int i = 0; i < 2000; ++i) {
        const auto [x, y, z] = placeOf(i);
        const auto thread = [](float at) { return std::sin(exact(at) * kFullTurn / 2.0L / exact(0.002f)); };
        const long double weave = thread(x) * thread(y);
        const Inputs in = inputsAt(x, y, 0.0f);
        ASSERT_NEAR(static_cast<double>(heightAt(program, in)),
                    static_cast<double>(exact(0.003f) * weave * weave), 5e-8);
        const PortValue material = outputAt(program, in, kOutMaterial);
        ASSERT_NEAR(static_cast<double>(material[0]),
                    static_cast<double>(0.5L * (0.7L + 0.3L * std::abs(weave))), 1e-5);
        ASSERT_NEAR(static_cast<double>(material[2]), 240.0, 1e-3);
        ASSERT_NEAR(static_cast<double>(material[3]), 2.5, 1e-6);
        (void)z;
    }
}

TEST(SurfacePrograms, WetIceIsItsFormula) {
    RegisterProgram program = paperProgram("wet_ice.glsl");
    setParameter(program, "uneven", 0.01f);
    for (int i = 0; i < 2000; ++i) {
        const auto [x, y, z] = placeOf(i);
        Inputs in = inputsAt(x, y, z);
        const float speed = 0.0001f * static_cast<float>(i);
        in[kToolVelocity] = {speed, 0.0f, 3.0f}; // what goes into the surface does not melt it
        const long double t = std::min(exact(speed) / exact(0.08f), 1.0L);
        const long double wet = t * t * (3.0L - 2.0L * t);
        const PortValue material = outputAt(program, in, kOutMaterial);
        ASSERT_NEAR(static_cast<double>(material[0]), static_cast<double>(0.12L + (0.01L - 0.12L) * wet),
                    1e-6);
        ASSERT_NEAR(static_cast<double>(material[1]), static_cast<double>(0.072L + (0.01L - 0.072L) * wet),
                    1e-6);
        ASSERT_NEAR(static_cast<double>(material[3]), static_cast<double>(1.0L + 0.8L * wet), 1e-6);
        ASSERT_NEAR(
            static_cast<double>(heightAt(program, in)),
            static_cast<double>(exact(0.01f) * noiseAt(exact(x) * 30.0L, exact(y) * 30.0L, exact(z) * 30.0L)),
            1e-7);
    }
}

TEST(SurfacePrograms, ButtonIsItsFormulaAndGivesWayOnce) {
    const RegisterProgram program = paperProgram("button.glsl");
    float last = 0.0f;
    int turns = 0;
    bool rising = true;
    for (int i = 1; i <= 5000; ++i) {
        Inputs in = inputsAt(0.003f, 0.002f, 0.0f); // in the disc
        const float depth = 1e-6f * static_cast<float>(i);
        in[kForce] = {0.0f, 0.0f, 600.0f * depth};
        const long double d = exact(in[kForce][2]) / 600.0L;
        const long double t = std::clamp((d - exact(0.002f)) / exact(0.0006f), 0.0L, 1.0L);
        const long double wanted = 600.0L * (d - 0.6L * exact(0.002f) * t * t * (3.0L - 2.0L * t));
        const float force = outputAt(program, in, kOutForce)[2];
        ASSERT_NEAR(static_cast<double>(force), static_cast<double>(wanted), 2e-5) << depth;
        ASSERT_GE(force, 0.0f);
        if ((force > last) != rising && std::abs(force - last) > 1e-6f) {
            rising = !rising;
            ++turns;
        }
        last = force;
    }
    EXPECT_EQ(turns, 2) << "it gives way and holds again";
    Inputs beside = inputsAt(0.02f, 0.0f, 0.0f);
    beside[kForce] = {0.0f, 0.0f, 2.0f};
    EXPECT_EQ(outputAt(program, beside, kOutForce)[2], 2.0f);
}

/// Worley's distance by its definition.
long double cellularAt(long double x, long double y, long double z) {
    const long double p[3] = {x, y, z};
    int64_t cell[3];
    for (int k = 0; k < 3; ++k)
        cell[k] = static_cast<int64_t>(std::floor(p[k]));
    long double nearest = 16.0L;
    for (int i = 0; i < 27; ++i) {
        const int64_t at[3] = {cell[0] + i % 3 - 1, cell[1] + i / 3 % 3 - 1, cell[2] + i / 9 - 1};
        const uint32_t bits =
            hashOf(static_cast<uint32_t>(at[0]) +
                   hashOf(static_cast<uint32_t>(at[1]) + hashOf(static_cast<uint32_t>(at[2]))));
        long double squared = 0.0L;
        for (unsigned k = 0; k < 3; ++k) {
            const long double strewn = static_cast<long double>((bits >> 10u * k) & 1023u) / 1023.0L;
            const long double offset = static_cast<long double>(at[k]) + strewn - p[k];
            squared += offset * offset;
        }
        nearest = std::min(nearest, squared);
    }
    return std::sqrt(nearest);
}

TEST(SurfacePrograms, HeightsAreTheirFormulas) {
    for (uint32_t kind = 0; kind < 3; ++kind) {
        RegisterProgram program = paperProgram("heights.glsl");
        setInteger(program, "kind", kind);
        setParameter(program, "height", 0.01f);
        for (int i = 0; i < 2000; ++i) {
            const auto [x, y, z] = placeOf(i);
            const long double p[3] = {exact(x) * 60.0L, exact(y) * 60.0L, exact(z) * 60.0L};
            const long double h =
                kind == 0
                    ? (std::sin(kFullTurn * p[0]) + std::sin(kFullTurn * p[1]) + std::sin(kFullTurn * p[2])) /
                          3.0L
                : kind == 1 ? cellularAt(p[0], p[1], p[2]) - 0.5L
                            : noiseAt(p[0], p[1], p[2]);
            ASSERT_NEAR(static_cast<double>(heightAt(program, inputsAt(x, y, z))),
                        static_cast<double>(exact(0.01f) * h), 1e-7)
                << kind << " at " << x << ", " << y << ", " << z;
        }
    }
}

/// Waves that a stroke would alias are left out.
TEST(SurfacePrograms, AFastStrokeFeelsNoFineWaves) {
    for (const char* name : {"sandpaper.glsl", "knurl.glsl", "fabric.glsl", "wet_ice.glsl", "heights.glsl"}) {
        const RegisterProgram program = paperProgram(name);
        Inputs in = inputsAt(0.0031f, 0.0017f, 0.0023f);
        in[kTick] = {0.1f, 0.0f};
        EXPECT_EQ(heightAt(program, in), 0.0L) << name;
        in[kTick] = {0.0f, 0.0f};
        EXPECT_NE(heightAt(program, in), 0.0L) << name;
    }
}

TEST(SurfacePrograms, CostLessThanHalfTheBudget) {
    for (const char* name : {"sandpaper.glsl", "knurl.glsl", "brushed_metal.glsl", "fabric.glsl",
                             "wet_ice.glsl", "button.glsl", "heights.glsl"}) {
        const RegisterProgram program = paperProgram(name);
        Inputs out{};
        EXPECT_LT(run(program, inputsAt(0.01f, 0.02f, 0.03f), out).cost, kBudget / 2) << name;
    }
}

/// Only these need gradients.
TEST(SurfacePrograms, WhatNeverDisplacesIsKnown) {
    const auto displaces = [](const std::string& text) {
        return feltProgram(
                   materialProgram(compileSurfaceProgram("test.glsl", text, {}, [] { return false; }), {}))
            .displaces;
    };
    for (const auto& [name, expected] :
         {std::pair{"wood.glsl", false}, std::pair{"simple_noise.glsl", false},
          std::pair{"anisotropic.glsl", false}, std::pair{"circles.glsl", false},
          std::pair{"button.glsl", false}, std::pair{"sandpaper.glsl", true}, std::pair{"knurl.glsl", true},
          std::pair{"fabric.glsl", true}, std::pair{"heights.glsl", true}}) {
        std::ifstream file(std::string(TOUCHSTONE_ASSETS) + "/../programs/" + name);
        EXPECT_EQ(displaces({std::istreambuf_iterator<char>(file), {}}), expected) << name;
    }
    EXPECT_FALSE(displaces(touchBody("vec3 p = before.position; after.position = p;")));
    EXPECT_TRUE(displaces(touchBody("after.position = before.position.yxz;")));
    EXPECT_TRUE(displaces(touchBody("if (before.time > 1.0) after.position.x += 1e-4;")));
    EXPECT_TRUE(displaces(touchBody("for (int i = 0; i < int(before.time); ++i) after.position *= 1.01;")));
    EXPECT_TRUE(displaces(touchBody("after.position[int(before.time) % 3] = 0.0;")));
}

} // namespace
} // namespace touchstone::program
