// The library of functions: noise against the same in long double with the same integers.

#include "noise_reference.h"
#include "program_bench.h"

#include <cstdint>

namespace touchstone::program {
namespace {

TEST(ProgramLibrary, NoiseIsThatOfItsDefinition) {
    const RegisterProgram program =
        programOf(touchBody("after.force = vec3(noise(before.position), noise(before.position.xy), "
                            "noise(before.position.x));"));
    double least = 1.0, greatest = -1.0, worst = 0.0;
    for (int i = 0; i < 20000; ++i) {
        const float x = static_cast<float>(i % 271) * 0.137f - 18.0f,
                    y = static_cast<float>(i % 97) * 0.291f - 12.0f,
                    z = static_cast<float>(i) * 0.0013f - 9.0f;
        Inputs out{};
        ASSERT_EQ(run(program, inputsAt(x, y, z), out).ending, Ending::Finished);
        const double n = static_cast<double>(out[kOutForce][0]);
        worst = std::max(worst, std::abs(n - static_cast<double>(noiseAt(x, y, z))));
        least = std::min(least, n);
        greatest = std::max(greatest, n);
        for (size_t k = 0; k < 3; ++k)
            ASSERT_LE(std::abs(out[kOutForce][k]), 1.0f);
    }
    EXPECT_LT(worst, 1e-6);
    EXPECT_LT(least, -0.4);
    EXPECT_GT(greatest, 0.4);
}

TEST(ProgramLibrary, NoiseIsZeroAtIntegersAndSmoothAcrossThem) {
    const RegisterProgram program = programOf(touchBody(
        "after.force = vec3(noise(before.position), noise(before.position.xy), noise(before.position.x));"));
    for (int i = -20; i < 20; ++i) {
        Inputs out{};
        ASSERT_EQ(run(program, inputsAt(static_cast<float>(i), 3.0f, -5.0f), out).ending, Ending::Finished);
        EXPECT_EQ(out[kOutForce], (PortValue{0, 0, 0, 0}));
        DualInputs before{}, after{};
        (void)runDual(program, dualInputs(inputsAt(static_cast<float>(i) - 1e-4f, 3.3f, -5.2f)), before);
        (void)runDual(program, dualInputs(inputsAt(static_cast<float>(i) + 1e-4f, 3.3f, -5.2f)), after);
        for (size_t port = 0; port < 3; ++port)
            EXPECT_NEAR(before[kOutForce].d[port][0], after[kOutForce].d[port][0], 0.01);
    }
}

TEST(ProgramLibrary, TheFilterLeavesOutWhatSamplingCannotShow) {
    const RegisterProgram program = programOf(touchBody(
        "after.force = vec3(filteredNoise(before.position, 0.2), filteredNoise(before.position, 0.51), "
        "filteredFBm(before.position, 8, 0.5, 0.3));"
        "after.normal = vec3(noise(before.position), 0.0, kept(0.3) * noise(before.position));"));
    Inputs out{};
    ASSERT_EQ(run(program, inputsAt(0.3f, 0.6f, 0.2f), out).ending, Ending::Finished);
    EXPECT_EQ(out[kOutForce], out[kOutNormal]);
}

TEST(ProgramLibrary, CellularNoiseIsTheDistanceToTheNearestPoint) {
    const RegisterProgram program = programOf(touchBody("after.force.x = cellular(before.position);"));
    for (int i = 0; i < 500; ++i) {
        const float p[3] = {0.37f * static_cast<float>(i % 23) - 4.0f, 0.11f * static_cast<float>(i) - 20.0f,
                            0.73f * static_cast<float>(i % 7)};
        double nearest = 1e9;
        for (int z = -2; z <= 2; ++z)
            for (int y = -2; y <= 2; ++y)
                for (int x = -2; x <= 2; ++x) {
                    const int cell[3] = {static_cast<int>(std::floor(p[0])) + x,
                                         static_cast<int>(std::floor(p[1])) + y,
                                         static_cast<int>(std::floor(p[2])) + z};
                    const uint32_t bits = hashOf(
                        static_cast<uint32_t>(cell[0]) +
                        hashOf(static_cast<uint32_t>(cell[1]) + hashOf(static_cast<uint32_t>(cell[2]))));
                    double square = 0.0;
                    for (unsigned k = 0; k < 3; ++k) {
                        const double strewn = static_cast<double>((bits >> (10 * k)) & 1023u) / 1023.0;
                        const double offset = cell[k] + strewn - static_cast<double>(p[k]);
                        square += offset * offset;
                    }
                    nearest = std::min(nearest, std::sqrt(square));
                }
        Inputs out{};
        ASSERT_EQ(run(program, inputsAt(p[0], p[1], p[2]), out).ending, Ending::Finished);
        EXPECT_NEAR(static_cast<double>(out[kOutForce][0]), nearest, 3e-6);
    }
}

} // namespace
} // namespace touchstone::program
