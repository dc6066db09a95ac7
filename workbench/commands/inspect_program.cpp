#include "workbench/commands/inspect_program.h"

#include "engine/core/error.h"
#include "engine/core/input_file.h"
#include "engine/core/output_file.h"
#include "haptics/program/load_program.h"
#include "workbench/figures/program_figures.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <fstream>
#include <iterator>
#include <string>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

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
        std::printf("  without a result at %.0f %% of the places tried, and plain there: %s\n",
                    100.0 * flagged, json["fault"].get<std::string>().c_str());
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
    Json figures{{"program", file.string()}};
    figures.update(programFigures(compiled, source.text));
    figures["parameters"] = parametersOf(source);
    // A name that is not UTF-8 is replaced, so that the output stays valid.
    if (!json.empty())
        writeFile(json, figures.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    print(figures);
    return 0;
}

} // namespace touchstone
