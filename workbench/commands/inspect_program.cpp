#include "workbench/commands/inspect_program.h"

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/output_file.h"
#include "haptics/program/load_program.h"
#include "haptics/program/program_touch.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;
using program::ProgramGradient;

std::string textOf(const std::filesystem::path& file) {
    requireFile(file, file.string(), "name a program, a file of GLSL");
    std::ifstream stream(file, std::ios::binary);
    std::string text(kMaxProgramBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (stream.bad() || (!stream && !stream.eof()))
        throw Error(file.string(), "", "cannot be read", "check the permissions of the file");
    text.resize(static_cast<size_t>(stream.gcount()));
    return text;
}

struct Figures {
    double ns = 0.0; ///< of one call, of the fastest batch
    uint32_t cost = 0;
    int flagged = 0; ///< calls without a result
};

/// Touches a stroke over a patch of 50 mm, 2 mm deep.
Figures measure(const program::RegisterProgram& compiled, ProgramGradient gradient) {
    constexpr int kBatches = 20, kCalls = 500;
    Figures figures{.ns = INFINITY};
    for (int batch = 0; batch < kBatches; ++batch) {
        const auto start = std::chrono::steady_clock::now();
        int flagged = 0;
        for (int i = 0; i < kCalls; ++i) {
            const double t = static_cast<double>(i) / kCalls;
            const program::ProgramContact contact{
                .position = {0.05 * t, 0.01 + 0.02 * std::sin(20.0 * t), 0.01 * t},
                .toolDirection = {1.0, 0.0, 0.0},
                .toolVelocity = {0.1, 0.0, 0.0},
                .depth = 0.002,
                .stiffness = 600.0,
                .staticFriction = 0.5,
                .dynamicFriction = 0.4,
                .filterWidth = 1e-4,
                .time = t,
                .maxStiffness = 3000.0};
            const program::ProgramFelt felt = feelProgram(compiled, gradient, contact);
            figures.cost = std::max(figures.cost, felt.cost);
            flagged += felt.ending != program::Ending::Finished ? 1 : 0;
        }
        const std::chrono::duration<double, std::nano> time = std::chrono::steady_clock::now() - start;
        figures.ns = std::min(figures.ns, time.count() / kCalls);
        figures.flagged = flagged;
    }
    return figures;
}

Json parametersOf(const ProgramSource& source) {
    Json all = Json::array();
    for (const ProgramParameter& parameter : source.parameters)
        all.push_back({{"name", parameter.name},
                       {"default", std::vector<double>(parameter.value.begin(),
                                                       parameter.value.begin() + static_cast<std::ptrdiff_t>(
                                                                                     parameter.components))},
                       {"least", parameter.least},
                       {"greatest", parameter.greatest},
                       {"unit", parameter.unit},
                       {"text", parameter.text}});
    return all;
}

void print(const Json& json) {
    const auto number = [&](const char* name) { return json[name].get<double>(); };
    std::printf("%s\n  %.0f instructions, %.0f registers\n", json["program"].get<std::string>().c_str(),
                number("instructions"), number("registers"));
    std::printf("  a tick takes %.0f ns, with gradients %.0f ns (by central differences %.0f ns); it spends "
                "%.0f of its budget of %.0f\n",
                number("ns_per_tick"), number("ns_with_gradients"), number("ns_with_differences"),
                number("cost"), number("budget"));
    if (const double flagged = number("flagged_share"); flagged > 0.0)
        std::printf("  without a result at %.0f %% of the places tried: plain there\n", 100.0 * flagged);
    for (const Json& parameter : json["parameters"])
        std::printf("  parameter %s = %s, %g to %g %s  %s\n", parameter["name"].get<std::string>().c_str(),
                    parameter["default"].dump().c_str(), parameter["least"].get<double>(),
                    parameter["greatest"].get<double>(), parameter["unit"].get<std::string>().c_str(),
                    parameter["text"].get<std::string>().c_str());
}

} // namespace

bool isProgramFile(const std::filesystem::path& file) {
    return file.extension() == ".glsl";
}

int inspectProgram(const std::filesystem::path& file, const std::filesystem::path& json) {
    const ProgramSource source = readProgramSource(file.string(), textOf(file));
    const program::RegisterProgram compiled =
        program::loadProgram(source, installedProgramCompiler(), [] { return false; });
    const Figures plain = measure(compiled, ProgramGradient::None),
                  dual = measure(compiled, ProgramGradient::Dual),
                  central = measure(compiled, ProgramGradient::Central);
    const Json figures{{"program", file.string()},
                       {"instructions", compiled.instructions.size()},
                       {"registers", compiled.registers},
                       {"ns_per_tick", std::round(plain.ns)},
                       {"ns_with_gradients", std::round(dual.ns)},
                       {"ns_with_differences", std::round(central.ns)},
                       {"cost", plain.cost},
                       {"budget", program::kBudget},
                       {"flagged_share", static_cast<double>(dual.flagged) / 500.0},
                       {"parameters", parametersOf(source)}};
    // A name that is not UTF-8 is replaced, so that the output stays valid.
    if (!json.empty())
        writeFile(json, figures.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    print(figures);
    return 0;
}

} // namespace touchstone
