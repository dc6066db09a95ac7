// touchstone_program_compiler: reads a haptic program from standard input and writes its SPIR-V to standard
// output, with functions inlined. Exit status 1: standard output has the compiler's messages instead.
//
// Standard input: the name of the source, the declaration of its parameters and the source, each ended by a
// zero.
//
// Compilers crash on hostile text. So this one runs in a process of its own: the parent limits memory and
// time, and the sandbox leaves it no file, network or process.

#include "engine/import/program_compiler/endless_loop.h"
#include "engine/import/program_compiler/material_shaders.h"
#include "engine/import/reader_child/own_copies.h"
#include "engine/import/reader_child/sandbox.h"
#include "engine/import/reader_child/standard_streams.h"

#include <glslang/Public/ShaderLang.h>
#include <glslang/SPIRV/GlslangToSpv.h>
#include <spirv-tools/optimizer.hpp>
#include <unistd.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <new>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {
namespace {

constexpr std::string_view kVersion = "#version 450\n",
                           kPersistentVersion = "#version 450\n#define TOUCHSTONE_PERSISTENT\n";

/// The next text, up to its zero.
std::string take(std::span<const uint8_t>& input) {
    size_t length = 0;
    while (length < input.size() && input[length] != 0)
        ++length;
    if (length == input.size())
        throw std::runtime_error("the input is incomplete");
    std::string text(input.begin(), input.begin() + static_cast<std::ptrdiff_t>(length));
    input = input.subspan(length + 1);
    return text;
}

/// What a program has of the graphics pipeline: nothing but inputs, outputs and a block of numbers.
TBuiltInResource limits() {
    TBuiltInResource resources{};
    resources.maxVertexAttribs = 64;
    resources.maxVertexUniformComponents = 4096;
    resources.maxVertexOutputComponents = 128;
    resources.maxVertexOutputVectors = 64;
    resources.maxCombinedTextureImageUnits = 0;
    resources.maxDrawBuffers = 1;
    resources.limits.nonInductiveForLoops = true;
    resources.limits.whileLoops = true;
    resources.limits.doWhileLoops = true;
    resources.limits.generalUniformIndexing = true;
    resources.limits.generalAttributeMatrixVectorIndexing = true;
    resources.limits.generalVaryingIndexing = true;
    resources.limits.generalVariableIndexing = true;
    resources.limits.generalConstantMatrixVectorIndexing = true;
    return resources;
}

constexpr auto kMessages = static_cast<EShMessages>(EShMsgSpvRules | EShMsgVulkanRules | EShMsgDebugInfo);

void setTarget(glslang::TShader& shader) {
    shader.setEnvInput(glslang::EShSourceGlsl, EShLangVertex, glslang::EShClientVulkan, 100);
    shader.setEnvClient(glslang::EShClientVulkan, glslang::EShTargetVulkan_1_0);
    shader.setEnvTarget(glslang::EShTargetSpv, glslang::EShTargetSpv_1_0);
}

std::vector<uint32_t> compile(const std::string& name, const std::string& parameters,
                              const std::string& source) {
    // Programs that do not name the persistent texture have no input and output for it.
    const bool persistent = source.find("persistent") != std::string::npos;
    const std::array<std::string_view, 6> texts = {
        persistent ? kPersistentVersion : kVersion, kInterface, parameters, kLibrary, source, kEntry};
    std::array<const char*, 6> starts{};
    std::array<int, 6> lengths{};
    for (size_t i = 0; i < texts.size(); ++i) {
        starts[i] = texts[i].data();
        lengths[i] = static_cast<int>(texts[i].size());
    }
    const std::array<const char*, 6> names = {"version",      "interface.glsl", "parameters",
                                              "library.glsl", name.c_str(),     "entry.glsl"};
    const TBuiltInResource resources = limits();
    glslang::TShader shader(EShLangVertex);
    shader.setStringsWithLengthsAndNames(starts.data(), lengths.data(), names.data(), texts.size());
    setTarget(shader);
    if (!shader.parse(&resources, 450, ECoreProfile, false, true, kMessages))
        throw std::runtime_error(shader.getInfoLog());
    glslang::TProgram program;
    program.addShader(&shader);
    if (!program.link(kMessages))
        throw std::runtime_error(std::string(shader.getInfoLog()) + program.getInfoLog());
    glslang::SpvOptions options;
    options.generateDebugInfo = true;
    options.disableOptimizer = true;
    std::vector<uint32_t> words;
    glslang::GlslangToSpv(*program.getIntermediate(EShLangVertex), words, &options);
    return words;
}

/// Passes that inline and shorten, none that contracts a product and a sum or reorders arithmetic: eye and
/// hand compute the same.
std::vector<uint32_t> inlined(const std::vector<uint32_t>& words) {
    std::string problems;
    spvtools::Optimizer optimizer(SPV_ENV_VULKAN_1_0);
    optimizer.SetMessageConsumer(
        [&](spv_message_level_t level, const char*, const spv_position_t&, const char* text) {
            if (level <= SPV_MSG_ERROR)
                problems += std::string("ERROR: ") + text + "\n";
        });
    optimizer.RegisterPass(spvtools::CreateMergeReturnPass())
        .RegisterPass(spvtools::CreateInlineExhaustivePass())
        .RegisterPass(spvtools::CreateEliminateDeadFunctionsPass())
        .RegisterPass(spvtools::CreatePrivateToLocalPass())
        .RegisterPass(spvtools::CreateScalarReplacementPass(0))
        .RegisterPass(spvtools::CreateLocalAccessChainConvertPass())
        .RegisterPass(spvtools::CreateLocalSingleBlockLoadStoreElimPass())
        .RegisterPass(spvtools::CreateLocalSingleStoreElimPass())
        .RegisterPass(spvtools::CreateSSARewritePass())
        .RegisterPass(spvtools::CreateCCPPass())
        .RegisterPass(spvtools::CreateDeadBranchElimPass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateRedundancyEliminationPass())
        .RegisterPass(spvtools::CreateDeadInsertElimPass())
        .RegisterPass(spvtools::CreateBlockMergePass())
        .RegisterPass(spvtools::CreateAggressiveDCEPass())
        .RegisterPass(spvtools::CreateCompactIdsPass());
    std::vector<uint32_t> result;
    spvtools::OptimizerOptions options; // validates what it is given
    if (!optimizer.Run(words.data(), words.size(), &result, options))
        throw std::runtime_error(problems.empty() ? "ERROR: the program cannot be inlined" : problems);
    return result;
}

/// What glslang makes once for all programs, five sixths of the time.
void prepare() {
    const TBuiltInResource resources = limits();
    glslang::TShader shader(EShLangVertex);
    const char* const nothing = "#version 450\nvoid main() {}\n";
    shader.setStrings(&nothing, 1);
    setTarget(shader);
    (void)shader.parse(&resources, 450, ECoreProfile, false, true, kMessages);
}

/// `copySeconds`: of a processor, for each copy; none: there are no copies.
void work(std::optional<unsigned> copySeconds) {
    glslang::InitializeProcess();
    if (copySeconds) {
        prepare();
        becomeCopies(*copySeconds);
    }
    std::span<const uint8_t> input = standardInput();
    enterSandbox();
    const std::string name = take(input), parameters = take(input), source = take(input);
    const std::vector<uint32_t> whole = compile(name, parameters, source);
    const std::vector<uint32_t> words = withEndlessLoop(inlined(whole), whole, name);
    writeOutput(words.data(), 4 * words.size());
    _exit(0); // memory is the system's to tidy
}

} // namespace
} // namespace touchstone

/// --copies SECONDS: gets ready, and compiles in copies of itself, one for each question.
int main(int count, char** words) {
    try {
        const bool copies = count > 2 && std::string_view(words[1]) == "--copies";
        touchstone::work(copies ? std::optional(static_cast<unsigned>(std::strtoul(words[2], nullptr, 10)))
                                : std::nullopt);
    } catch (const std::bad_alloc&) {
        touchstone::endWith(1, "ERROR: it needs more memory than it may have");
    } catch (const std::exception& error) {
        touchstone::endWith(1, error.what());
    }
}
