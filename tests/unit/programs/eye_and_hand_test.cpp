// The same SPIR-V on lavapipe, as the picture runs it, and in the hand's executor.

#include "conformance_expressions.h"
#include "eye_points.h"
#include "haptics/program/load_program.h"
#include "renderer/program/link_program.h"

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace touchstone::program::eye_and_hand_test {
namespace {

constexpr size_t kPlaces = 65536;
constexpr size_t kTool = 5;

EyePoints& eye() {
    static EyePoints points;
    return points;
}

struct Both {
    std::vector<uint32_t> words;
    RegisterProgram hand;
    std::vector<std::byte> parameters;
};

Both bothOf(const std::string& name, const std::string& text) {
    const ProgramSource source = readProgramSource(name, text);
    Both both;
    both.words = compileProgram(source, installedProgramCompiler(), [] { return false; });
    Translation translation = translateSpirv(both.words);
    if (translation.problem)
        throw std::runtime_error(translation.problem->what);
    both.hand = std::move(translation.program);
    setParameters(both.hand, source.parameters);
    std::vector<std::array<double, 4>> values;
    for (const ProgramParameter& parameter : source.parameters)
        values.push_back(parameter.value);
    both.parameters = parameterBlock(both.words, source.parameters, values);
    return both;
}

/// Numbers of -1 to 1, multiples of 2^-16.
float number(std::mt19937& random) {
    return static_cast<float>(static_cast<int>(random() % 131071) - 65535) / 65536.0f;
}

/// A contact on a model of 0.2 m.
Inputs anyContact(std::mt19937& random) {
    Inputs in = inputsAt(0.1f * number(random), 0.1f * number(random), 0.1f * number(random));
    const float angle = 3.0f * number(random);
    in[kTool] = {std::cos(angle), std::sin(angle), 0.0f, 0.0f};
    in[kUv] = {number(random), number(random), 0.0f, 0.0f};
    in[kTick] = {1e-4f * std::abs(number(random)), number(random), 0.0f, 0.0f};
    return in;
}

struct Compared {
    double greatest = 0.0; ///< difference in units of the output's range
    size_t atJumps = 0;    ///< places where the eye is beyond 1e-5, but no farther than the hand 1e-5 aside
    size_t differing = 0;  ///< components that are not the same bits
};

/// What the hand computes at the place and 1e-5 of it aside: its least and its greatest value.
bool besideAJump(const RegisterProgram& hand, const Inputs& in, size_t port, size_t k, float seen,
                 double allowed) {
    float least = seen, greatest = seen;
    bool first = true;
    for (size_t axis = 0; axis < 3; ++axis)
        for (const float step : {-1e-5f, 1e-5f}) {
            Inputs beside = in, out{};
            beside[kPosition][axis] += step * std::max(0.1f, std::abs(beside[kPosition][axis]));
            if (run(hand, beside, out).ending != Ending::Finished)
                continue;
            least = first ? out[port][k] : std::min(least, out[port][k]);
            greatest = first ? out[port][k] : std::max(greatest, out[port][k]);
            first = false;
        }
    return static_cast<double>(seen) >= static_cast<double>(least) - allowed &&
           static_cast<double>(seen) <= static_cast<double>(greatest) + allowed;
}

Compared compare(const Both& both, const std::vector<Inputs>& places) {
    const std::vector<EyeResult> seen = eye().run(both.words, both.parameters, places);
    std::vector<Inputs> felt(places.size());
    for (size_t i = 0; i < places.size(); ++i) {
        EXPECT_EQ(run(both.hand, places[i], felt[i]).ending == Ending::Finished, seen[i].done) << i;
    }
    Compared result;
    for (const Port& port : both.hand.outputs) {
        if (port.location > kOutMaterial)
            continue; // not felt
        for (size_t k = 0; k < port.count; ++k) {
            double least = 1e30, greatest = -1e30;
            for (const Inputs& out : felt) {
                least = std::min(least, static_cast<double>(out[port.location][k]));
                greatest = std::max(greatest, static_cast<double>(out[port.location][k]));
            }
            const double range = greatest > least ? greatest - least : std::max(std::abs(greatest), 1e-30);
            for (size_t i = 0; i < places.size(); ++i) {
                const float a = seen[i].out[port.location][k], b = felt[i][port.location][k];
                result.differing += std::bit_cast<uint32_t>(a) != std::bit_cast<uint32_t>(b) ? 1 : 0;
                const double difference = std::abs(static_cast<double>(a) - static_cast<double>(b)) / range;
                if (difference <= 1e-5) {
                    result.greatest = std::max(result.greatest, difference);
                    continue;
                }
                ++result.atJumps;
                EXPECT_TRUE(besideAJump(both.hand, places[i], port.location, k, a, 1e-5 * range))
                    << "output " << port.location << "." << k << " at place " << i << ": eye " << a
                    << ", hand " << b;
            }
        }
    }
    return result;
}

TEST(EyeAndHand, AgreeAt65536PlacesOfEachProgram) {
    size_t programs = 0;
    for (const auto& entry :
         std::filesystem::directory_iterator(std::filesystem::path(TOUCHSTONE_ASSETS) / "../programs")) {
        if (entry.path().extension() != ".glsl")
            continue;
        std::ifstream file(entry.path());
        const Both both =
            bothOf(entry.path().filename().string(), std::string((std::istreambuf_iterator<char>(file)), {}));
        std::mt19937 random(5);
        std::vector<Inputs> places;
        for (size_t i = 0; i < kPlaces; ++i)
            places.push_back(anyContact(random));
        const Compared result = compare(both, places);
        std::printf(
            "%-20s at most %.1e of the range apart, %zu values at a jump, %zu of %zu not the same bits\n",
            entry.path().filename().c_str(), result.greatest, result.atJumps, result.differing, 13 * kPlaces);
        EXPECT_LT(result.atJumps, kPlaces / 1000);
        ++programs;
    }
    EXPECT_GE(programs, 4u);
}

TEST(EyeAndHand, HashesAreTheSameBits) {
    const Both both = bothOf("hash", touchBody(R"(
        uvec3 i = uvec3(ivec3(before.position));
        uint one = hash(i.x);
        uvec2 two = hash(i.xy);
        uvec4 four = hash(uvec4(i, i.x ^ i.y));
        after.force = vec3(one & 0xffffu, one >> 16, two.x >> 16);
        after.normal = vec3(two.x & 0xffffu, two.y & 0xffffu, two.y >> 16);
        after.position = vec3(four.x >> 16, four.y & 0xffffu, four.z & 0xffffu);
        after.staticFriction = float(four.w & 0xffffu); after.dynamicFriction = float(four.w >> 16);
        after.stiffness = float(four.x & 0xffffu); after.damping = float(four.y >> 16);)"));
    std::mt19937 random(3);
    std::vector<Inputs> places;
    for (size_t i = 0; i < kPlaces; ++i)
        places.push_back(
            inputsAt(16777216.0f * number(random), 16777216.0f * number(random), static_cast<float>(i)));
    EXPECT_EQ(compare(both, places).differing, 0u);
}

/// Units in the last place between two floats of one sign.
int64_t ulps(float a, float b) {
    const auto ordered = [](float x) {
        const auto bits = std::bit_cast<int32_t>(x);
        return bits < 0 ? int64_t{INT32_MIN} - bits : int64_t{bits};
    };
    return std::abs(ordered(a) - ordered(b));
}

TEST(EyeAndHand, NoiseIsWithinTwoUnitsInTheLastPlace) {
    const Both both = bothOf("noise", touchBody(R"(
        vec3 p = before.position;
        after.force = vec3(noise(p), noise(p.xy), noise(p.x));
        after.position = noise3(p);
        after.normal = vec3(fBm(p, 4, 0.5), cellular(p), filteredNoise(p, before.filterWidth));)"));
    std::mt19937 random(9);
    std::vector<Inputs> places;
    for (size_t i = 0; i < kPlaces; ++i) {
        places.push_back(inputsAt(100.0f * number(random), 100.0f * number(random), 100.0f * number(random)));
        places.back()[kTick] = {0.5f * std::abs(number(random)), 0.0f, 0.0f, 0.0f};
    }
    const std::vector<EyeResult> seen = eye().run(both.words, both.parameters, places);
    int64_t greatest = 0;
    for (size_t i = 0; i < places.size(); ++i) {
        Inputs felt{};
        ASSERT_EQ(run(both.hand, places[i], felt).ending, Ending::Finished);
        ASSERT_TRUE(seen[i].done);
        for (size_t port = 0; port < 3; ++port)
            for (size_t k = 0; k < 3; ++k) {
                const int64_t apart = ulps(felt[port][k], seen[i].out[port][k]);
                greatest = std::max(greatest, apart);
                ASSERT_LE(apart, 2) << "output " << port << "." << k << " at " << places[i][0][0];
            }
    }
    std::printf("at most %lld ulp apart\n", static_cast<long long>(greatest));
}

/// Vulkan 1.3, "Precision and operation of SPIR-V instructions", of the functions in the text: absolute, and
/// relative to 1 + |value|. What derives from others (tan, pow, inverse) has their sum, with a factor for the
/// amplification in these expressions.
double vulkanTolerance(const std::string& glsl) {
    const auto uses = [&](const char* name) { return glsl.find(name) != std::string::npos; };
    double allowed = 0.0;
    if (uses("sin(") || uses("cos(") || uses("tan("))
        allowed = std::max(allowed, 1.0 / 2048.0); // 2^-11 absolute inside of -pi..pi
    if (uses("asin(") || uses("acos(") || uses("atan("))
        allowed = std::max(allowed, 4096.0 * 0x1p-23);
    if (uses("sinh(") || uses("cosh(") || uses("tanh(") || uses("exp") || uses("pow("))
        allowed = std::max(allowed, (3.0 + 2.0 * 8.0) * 8.0 * 0x1p-23);
    if (uses("log") || uses("pow("))
        allowed = std::max(allowed, 0x1p-21 + 3.0 * 0x1p-23);
    return allowed;
}

TEST(EyeAndHand, EveryOperationIsWithinVulkansPrecision) {
    std::mt19937 random(7);
    size_t compared = 0;
    for (size_t first = 0; first < reference::kExpressions.size(); first += kTogether) {
        const Both both = bothOf("expressions", programWith(first));
        std::vector<Inputs> places;
        for (int i = 0; i < 4096; ++i) {
            const auto coordinate = [&] {
                return static_cast<float>(static_cast<int>(random() % 32767) - 16383) / 4096.0f;
            };
            const float x = coordinate(), y = coordinate(), z = coordinate();
            places.push_back(inputsAt(x, y, z));
        }
        const std::vector<EyeResult> seen = eye().run(both.words, both.parameters, places);
        for (size_t i = 0; i < kTogether && first + i < reference::kExpressions.size(); ++i) {
            const Expression& expression = reference::kExpressions[first + i];
            double worst = 0.0;
            for (size_t place = 0; place < places.size(); ++place) {
                Inputs felt{};
                ASSERT_EQ(run(both.hand, places[place], felt).ending, Ending::Finished);
                ASSERT_TRUE(seen[place].done) << expression.glsl;
                const auto hand = static_cast<double>(felt[i / 3][i % 3]);
                worst = std::max(worst, std::abs(static_cast<double>(seen[place].out[i / 3][i % 3]) - hand) /
                                            (1.0 + std::abs(hand)));
            }
            const double allowed = expression.tolerance + vulkanTolerance(expression.glsl);
            EXPECT_LE(worst, allowed) << expression.glsl;
            if (worst > 0.0)
                std::printf("%.1e of %.1e  %s\n", worst, allowed, expression.glsl);
            ++compared;
        }
    }
    EXPECT_EQ(compared, reference::kExpressions.size());
}

/// What has no result for the hand has none for the eye.
TEST(EyeAndHand, FailAlike) {
    struct Case {
        const char* body;
        bool done;
    };
    const Case cases[] = {
        {"while (true) { after.damping += 1.0; }", false},
        {"while (true) {}", false},
        {"for (uint i = 0u; i < 4000000000u; i++) after.force *= 1.0001;", false},
        {"float t[3] = float[](1.0, 2.0, 3.0); after.damping = t[int(before.position.x)];", false},
        {"float t[9]; for (int i = 0; i < 9; i++) t[i] = float(i); after.damping = "
         "t[int(before.position.x)];",
         true},
        {"after.force[int(before.position.x)] = 1.0;", false},
        {"after.force[int(before.position.x) - 5] = 1.0;", true},
        {"after.damping = float(7 / (int(before.position.x) - 7));", false},
        {"after.damping = float(7u % uint(before.position.x - 7.0));", false},
        {"after.damping = float((-2147483647 - 1) / (6 - int(before.position.x)));", true},
        {"after.damping = sqrt(before.position.x - 20.0);", false},
        {"after.damping = 1.0 / (before.position.x - 7.0);", false},
        {"after.damping = before.position.x * 1e38;", false},
        {"after.damping = float(1 << (int(before.position.x) + 30));", true},
        {"int i = 0; do { after.damping += noise(after.position * float(i)); } while (++i < 5);", true},
        {"int i = 0; while (i < 40) { i++; if (i == 30) break; if (i % 2 == 0) continue; after.damping += "
         "1.0; }",
         true},
        {"int n = 0; for (int i = 0; i < 9; i++) for (int k = 0; k < i; k++) n += k; after.damping = "
         "float(n);",
         true},
        {"for (int i = 0; i < 9; i++) switch (i & 3) { case 0: after.damping += 1.0; break; case 2: "
         "continue; "
         "default: after.stiffness += 2.0; }",
         true},
        {"for (int i = 0; i < 9; i++) if (i == 4) return; after.damping = 3.0;", true},
    };
    for (const Case& each : cases) {
        const Both both = bothOf("case", touchBody(each.body));
        const std::vector<Inputs> places(64, inputsAt(7.0f, 0.25f, 0.5f));
        Inputs felt{};
        EXPECT_EQ(run(both.hand, places[0], felt).ending == Ending::Finished, each.done) << each.body;
        const std::vector<EyeResult> seen = eye().run(both.words, both.parameters, places);
        ASSERT_EQ(seen[0].done, each.done) << each.body;
        for (size_t port = 0; port < 4 && each.done; ++port)
            for (size_t k = 0; k < 4; ++k)
                EXPECT_NEAR(seen[63].out[port][k], felt[port][k], 1e-5f * (1.0f + std::abs(felt[port][k])))
                    << each.body << " output " << port << "." << k;
    }
}

} // namespace
} // namespace touchstone::program::eye_and_hand_test
