// Feeds the translator of haptic programs SPIR-V that is nearly right or random, and runs what it accepts: no
// crash, no run beyond its budget, no finished run with an output that is not finite, no force beyond its
// bounds. The same modules are linked into a shader for the eye. This target alone is compiled under the
// address and undefined behaviour sanitizers in every preset.
#include "engine/core/error.h"
#include "engine/program/program_compiler.h"
#include "engine/program/spirv_reader.h"
#include "haptics/program/executor.h"
#include "haptics/program/load_program.h"
#include "haptics/program/program_touch.h"
#include "haptics/program/translator.h"
#include "renderer/program/link_program.h"

#include <glslang/SPIRV/spirv.hpp>
#include <gtest/gtest.h>
#include <spirv-tools/libspirv.hpp>

#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>

namespace touchstone::program {
namespace {

#include "shaders/program_points_comp.h"

using Words = std::vector<uint32_t>;

bool isValid(spv_target_env environment, const Words& words) {
    return spvtools::SpirvTools(environment).Validate(words);
}

/// What goes to the eye's driver is valid wherever the program is.
void linkHere(const Words& words) {
    const LinkedProgram linked = linkProgram(program_points_comp, words, 1);
    ASSERT_NE(linked.words.empty(), linked.problem.empty());
    if (!linked.words.empty() && isValid(SPV_ENV_VULKAN_1_0, words)) {
        ASSERT_TRUE(isValid(SPV_ENV_VULKAN_1_3, linked.words));
    }
}

constexpr const char* kSources[] = {
    R"(parameter float ringscale = 10; // 1..100
void touch(const in Touch before, inout Surface after) {
    vec3 p = before.position + noise(before.position);
    float r = length(p.yz) * ringscale;
    r += abs(noise(r));
    after.staticFriction = mix(0.02, 0.5, fract(r));
})",
    R"(float table[4] = float[](0.1, 0.2, 0.3, 0.4);
void touch(const in Touch before, inout Surface after) {
    float sum = 0.0;
    mat3 m = mat3(before.normal, before.tangent, before.force);
    for (int i = 0; i < int(before.uv.x); i++) {
        switch (i & 3) {
        case 0: sum += table[i]; break;
        case 2: table[i] = sum; continue;
        default: sum -= m[i % 3][i & 1];
        }
        if (sum > 3.0) break;
    }
    after.force = inverse(m) * before.force * sum;
    after.position[int(before.uv.y)] += 1e-3;
})",
    R"(parameter int octaves = 3; // 1..8
void touch(const in Touch before, inout Surface after) {
    float u = 0.0, f = 1.0;
    int n = octaves;
    while (n-- > 0) { u += noise(before.position * f) / f; f *= 2.0; }
    after.force = before.force * (1.0 + u) + refract(before.force, before.normal, 0.9);
    after.normal = normalize(mix(before.normal, vec3(u), bvec3(u > 0.1)));
    after.damping = float((octaves / (n + 2)) << bitCount(uint(f)));
})"};

std::vector<Words> seeds() {
    std::vector<Words> all;
    for (const char* source : kSources)
        all.push_back(compileProgram(readProgramSource("seed", source), installedProgramCompiler(),
                                     [] { return false; }));
    return all;
}

constexpr size_t kHeaderWords = 5;

Words mutant(const Words& seed, std::mt19937& random) {
    Words words = seed;
    for (size_t changes = 1 + random() % 4; changes > 0; --changes) {
        const size_t at = kHeaderWords + random() % (words.size() - kHeaderWords);
        const auto place = words.begin() + static_cast<std::ptrdiff_t>(at);
        switch (random() % 7) {
        case 0:
            words[at] = static_cast<uint32_t>(random());
            break;
        case 1:
            words[at] ^= 1u << random() % 32;
            break;
        case 2:
            words[at] = static_cast<uint32_t>(random() % 400); // another id, another opcode
            break;
        case 3:
            words[at] = words[kHeaderWords + random() % (words.size() - kHeaderWords)];
            break;
        case 4:
            words.erase(place, place + std::min<std::ptrdiff_t>(words.end() - place,
                                                                1 + static_cast<int>(random() % 6)));
            break;
        case 5:
            words[at] = (words[at] & 0xffff0000u) | static_cast<uint32_t>(random() % 330);
            break;
        default:
            words[random() % kHeaderWords] = static_cast<uint32_t>(random() % 70000);
            break;
        }
        if (words.size() <= kHeaderWords + 1)
            return seed;
    }
    return words;
}

constexpr float kStrange[] = {0.0f,
                              1.0f,
                              -1.0f,
                              1e38f,
                              -1e38f,
                              1e-40f,
                              std::numeric_limits<float>::quiet_NaN(),
                              std::numeric_limits<float>::infinity(),
                              3.7f,
                              2147483648.0f,
                              0.5f,
                              17.0f};

void runHere(const RegisterProgram& program, std::mt19937& random) {
    std::array<PortValue, kMaxLocations> in{}, out{};
    std::array<DualPortValue, kMaxLocations> dual{}, dualOut{};
    for (size_t i = 0; i < kMaxLocations; ++i)
        for (size_t k = 0; k < 4; ++k) {
            in[i][k] = dual[i].v[k] = kStrange[random() % std::size(kStrange)];
            dual[i].d[k][random() % 3] = kStrange[random() % std::size(kStrange)];
        }
    const RunResult result = run(program, in, out);
    ASSERT_LE(result.cost, 2 * kBudget);
    for (const Port& port : program.outputs)
        for (size_t k = 0; k < port.count && result.ending == Ending::Finished; ++k)
            ASSERT_TRUE(std::isfinite(out[port.location][k]));
    ASSERT_LE(runDual(program, dual, dualOut).cost, 2 * kBudget);
}

/// What a contact feels of it is within the bounds of program_touch.h, wherever it lies.
void feelHere(const RegisterProgram& program, std::mt19937& random) {
    const auto number = [&] {
        for (;;)
            if (const float value = kStrange[random() % std::size(kStrange)]; std::isfinite(value))
                return static_cast<double>(value);
    };
    const auto vector = [&] { return glm::dvec3(number(), number(), number()); };
    const ProgramContact contact{.position = vector(),
                                 .uv = {number(), number()},
                                 .toolDirection = {1.0, 0.0, 0.0},
                                 .toolVelocity = vector(),
                                 .toolAcceleration = vector(),
                                 .depth = 1e-5 * static_cast<double>(random() % 1000),
                                 .stiffness = 600.0,
                                 .damping = 1.0,
                                 .staticFriction = 0.4,
                                 .dynamicFriction = 0.3,
                                 .time = number(),
                                 .maxStiffness = 3000.0};
    for (const ProgramGradient gradient :
         {ProgramGradient::Dual, ProgramGradient::Central, ProgramGradient::None}) {
        const ProgramFelt felt = feelProgram(program, gradient, contact);
        const double greatest = kMaxProgramGain * contact.maxStiffness * contact.depth;
        ASSERT_LE(felt.cost, 2 * kBudget);
        ASSERT_LE(glm::length(felt.force), greatest * (1.0 + 1e-9)); // not so of a NaN, either
        ASSERT_GE(glm::dot(felt.force, contact.normal), -1e-9);
        ASSERT_GE(felt.stiffness, 0.0);
        ASSERT_LE(felt.stiffness, contact.maxStiffness);
        ASSERT_GE(felt.dynamicFriction, 0.0);
        ASSERT_GE(felt.staticFriction, felt.dynamicFriction);
        ASSERT_TRUE(std::isfinite(felt.staticFriction) && std::isfinite(felt.damping));
        ASSERT_GE(felt.damping, 0.0);
        ASSERT_LE(std::abs(felt.height), contact.depth);
    }
}

/// Words that are at most instructions.
Words randomModule(std::mt19937& random) {
    Words words = {0x07230203, 0x00010000, 0, static_cast<uint32_t>(1 + random() % 100), 0};
    for (size_t instructions = random() % 60; instructions > 0; --instructions) {
        const auto count = static_cast<uint32_t>(1 + random() % 6);
        words.push_back(count << 16 | static_cast<uint32_t>(random() % 330));
        for (uint32_t k = 1; k < count; ++k)
            words.push_back(static_cast<uint32_t>(random() % (random() % 8 == 0 ? 0x80000000u : 100u)));
    }
    return words;
}

/// Whatever the compiler makes of what people write is valid for the eye.
TEST(ProgramFuzz, LinkedProgramsAreValid) {
    for (const Words& words : seeds()) {
        ASSERT_TRUE(isValid(SPV_ENV_VULKAN_1_0, words));
        const LinkedProgram linked = linkProgram(program_points_comp, words, 1);
        ASSERT_EQ(linked.problem, "");
        ASSERT_TRUE(isValid(SPV_ENV_VULKAN_1_3, linked.words));
    }
    ASSERT_FALSE(linkProgram(program_points_comp, Words{1, 2, 3}, 1).problem.empty());
}

/// A block of parameters among the instructions of the entry function, where registers are given out.
TEST(ProgramFuzz, ParametersInsideAFunctionAreRefused) {
    Words words = seeds()[0], variable;
    size_t place = 0;
    for (size_t i = kHeaderWords; i < words.size(); i += words[i] >> 16) {
        if ((words[i] & 0xffffu) == 59 && words[i + 3] == 2) // OpVariable, Uniform
            variable.assign(words.begin() + static_cast<std::ptrdiff_t>(i),
                            words.begin() + static_cast<std::ptrdiff_t>(i + (words[i] >> 16)));
        if ((words[i] & 0xffffu) == 248 && place == 0) // after the first OpLabel
            place = i + 2;
    }
    ASSERT_FALSE(variable.empty());
    ASSERT_GT(place, 0u);
    words.insert(words.begin() + static_cast<std::ptrdiff_t>(place), variable.begin(), variable.end());
    const Translation translation = translateSpirv(words);
    ASSERT_TRUE(translation.problem.has_value());
    EXPECT_NE(translation.problem->what.find("wrong place"), std::string::npos);
}

/// Some are accepted and run, some are refused.
void fuzz(unsigned seed, int trials) {
    std::mt19937 random(seed);
    const std::vector<Words> from = seeds();
    int accepted = 0;
    for (int i = 0; i < trials; ++i) {
        const size_t source = random() % from.size();
        const Words words = i % 10 == 9 ? randomModule(random) : mutant(from[source], random);
        linkHere(words);
        Translation translation = translateSpirv(words);
        if (translation.problem) {
            ASSERT_FALSE(translation.problem->remedy.empty());
            continue;
        }
        ++accepted;
        setParameters(translation.program, readProgramSource("seed", kSources[source]).parameters);
        for (int k = 0; k < 4; ++k) {
            runHere(translation.program, random);
            feelHere(translation.program, random);
        }
        if (::testing::Test::HasFatalFailure())
            return;
    }
    std::printf("%d of %d modules accepted and run\n", accepted, trials);
    ASSERT_GT(accepted, 0);
    ASSERT_LT(accepted, trials);
}

/// Names, places and entries without their operands at the very end of a module, where reading on is an error
/// of memory.
TEST(ProgramFuzz, InstructionsThatAreCutOffAreRefused) {
    for (const uint32_t code : {spv::OpLine, spv::OpString, spv::OpName, spv::OpMemberName, spv::OpDecorate,
                                spv::OpExtInstImport, spv::OpEntryPoint})
        for (uint32_t count = 1; count <= 2; ++count) {
            std::vector<uint32_t> words{spv::MagicNumber, 0x10000u, 0, 64, 0, count << 16 | code};
            words.resize(words.size() + count - 1, 1u);
            words.shrink_to_fit();
            EXPECT_THROW((void)readSpirv(words), Refusal) << code << " of " << count;
        }
}

TEST(ProgramFuzz, MutatedModulesAreRefusedOrRunWithinTheBudget) {
    fuzz(1, 2000);
}

TEST(ProgramSweep, TenThousandMutatedModulesAreRefusedOrRunWithinTheBudget) {
    if (std::getenv("TOUCHSTONE_SWEEP") == nullptr)
        GTEST_SKIP() << "set TOUCHSTONE_SWEEP=1 for the long form";
    fuzz(2, 10000);
}

/// Lines out of the sources above in another order, with other words.
TEST(ProgramSweep, AThousandRandomSourcesAreRefusedWithAMessageOrRun) {
    if (std::getenv("TOUCHSTONE_SWEEP") == nullptr)
        GTEST_SKIP() << "set TOUCHSTONE_SWEEP=1 for the long form";
    constexpr const char* kPieces[] = {"sin(",    "vec3(",       "before.position",
                                       ")",       "*",           "+",
                                       "1.0",     "after.force", "=",
                                       ";",       "{",           "}",
                                       "for(;;)", "while(true)", "int i",
                                       "i",       "/",           "0",
                                       "noise(",  "if(",         "[",
                                       "]",       "<",           "float f",
                                       "f",       "mat3("};
    std::mt19937 random(3);
    int accepted = 0;
    for (int i = 0; i < 1000; ++i) {
        std::string body =
            i % 2 == 0 ? kSources[random() % 3] : "void touch(const in Touch before, inout Surface after){";
        for (size_t k = 1 + random() % 12; k > 0; --k) {
            const std::string piece = kPieces[random() % std::size(kPieces)];
            body.insert(i % 2 == 0 ? random() % body.size() : body.size(), " " + piece + " ");
        }
        if (i % 2 == 1)
            body += ";}";
        try {
            const Words words = compileProgram(readProgramSource("random", body), installedProgramCompiler(),
                                               [] { return false; });
            linkHere(words);
            const Translation translation = translateSpirv(words);
            if (!translation.problem) {
                ++accepted;
                runHere(translation.program, random);
                feelHere(translation.program, random);
            }
        } catch (const Error& error) {
            ASSERT_FALSE(error.remedy().empty());
        }
    }
    std::printf("%d of 1000 sources accepted and run\n", accepted);
}

} // namespace
} // namespace touchstone::program
