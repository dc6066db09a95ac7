#include "engine/program/surface_program.h"

#include "engine/core/error.h"
#include "engine/program/program_compiler.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <mutex>
#include <tuple>
#include <utility>

namespace touchstone {

namespace {

using nlohmann::json;

constexpr const char* kValues = "parameters";

std::string shown(double value) {
    std::array<char, 32> text{};
    std::snprintf(text.data(), text.size(), "%.9g", value);
    return text.data();
}

/// "1 to 100 1/m".
std::string rangeOf(const ProgramParameter& parameter) {
    return shown(parameter.least) + " to " + shown(parameter.greatest) +
           (parameter.unit.empty() ? "" : " " + parameter.unit);
}

std::string formOf(const ProgramParameter& parameter) {
    const std::string number = parameter.kind == ProgramParameter::Kind::Float ? "number" : "whole number";
    return parameter.components == 1
               ? "one " + number
               : "an array of " + std::to_string(parameter.components) + " " + number + "s";
}

[[noreturn]] void refuse(const SurfaceProgram& program, const ProgramParameter& parameter,
                         const std::string& problem) {
    throw Error(program.source.name, "line " + std::to_string(parameter.line),
                "the file's value of '" + parameter.name + "' " + problem,
                "give " + formOf(parameter) + " of " + rangeOf(parameter));
}

double numberOf(const SurfaceProgram& program, const ProgramParameter& parameter, const json& value) {
    if (!value.is_number())
        refuse(program, parameter, "is not " + formOf(parameter));
    const double number = value.get<double>();
    if (parameter.kind != ProgramParameter::Kind::Float && number != std::floor(number))
        refuse(program, parameter, "is no whole number");
    if (!(number >= parameter.least && number <= parameter.greatest))
        refuse(program, parameter, shown(number) + " is out of range");
    return number;
}

std::array<double, 4> usedParts(const ProgramParameter& parameter, std::array<double, 4> value) {
    std::fill(value.begin() + static_cast<std::ptrdiff_t>(parameter.components), value.end(), 0.0);
    return value;
}

std::array<double, 4> valueOf(const SurfaceProgram& program, const ProgramParameter& parameter,
                              const json& value) {
    std::array<double, 4> result{};
    if (value.is_array() == (parameter.components == 1))
        refuse(program, parameter, "is not " + formOf(parameter));
    if (!value.is_array()) {
        result[0] = numberOf(program, parameter, value);
        return result;
    }
    if (value.size() != parameter.components)
        refuse(program, parameter, "is not " + formOf(parameter));
    for (size_t i = 0; i < parameter.components; ++i)
        result[i] = numberOf(program, parameter, value[i]);
    return result;
}

PersistentTextureSize textureSize(const SurfaceProgram& program, const json& stated) {
    const auto wrong = [&](const std::string& member, const std::string& problem) {
        throw Error(program.source.name, "persistentTexture" + member, problem,
                    "give width and height from 1 to " + std::to_string(kMaxPersistentSide) +
                        ", and minimum <= initial <= maximum from -1e6 to 1e6");
    };
    if (!stated.is_object())
        wrong("", "should be an object");
    PersistentTextureSize size;
    for (auto [name, side] : {std::pair{"width", &size.width}, std::pair{"height", &size.height}}) {
        const auto found = stated.find(name);
        if (found == stated.end() || !found->is_number_integer())
            wrong(std::string(".") + name, "should be a whole number of texels");
        const double value = found->get<double>();
        if (!(value >= 1.0 && value <= double{kMaxPersistentSide}))
            wrong(std::string(".") + name, shown(value) + " texels are out of range");
        *side = static_cast<uint32_t>(value);
    }
    const auto number = [&](const char* name, float otherwise) {
        const auto found = stated.find(name);
        if (found == stated.end())
            return otherwise;
        if (!found->is_number() || !(std::abs(found->get<double>()) <= 1e6))
            wrong(std::string(".") + name, "should be a number that is not out of range");
        return found->get<float>();
    };
    size.initial = number("initial", 1.0f);
    size.minimum = number("minimum", std::min(size.initial, 0.0f));
    size.maximum = number("maximum", std::max(size.initial, 1.0f));
    if (!(size.minimum <= size.initial && size.initial <= size.maximum))
        wrong(".initial", shown(static_cast<double>(size.initial)) + " is not between minimum and maximum");
    return size;
}

struct Held {
    std::mutex mutex;
    std::map<std::tuple<std::string, std::string, std::string>, std::weak_ptr<const SurfaceProgram>> programs;
};
Held& held() {
    static Held all;
    return all;
}

} // namespace

std::shared_ptr<const SurfaceProgram> compileSurfaceProgram(const std::string& name, std::string_view text,
                                                            const std::filesystem::path& file,
                                                            const std::function<bool()>& stop) {
    return compileSurfaceProgram(name, text, file, stop, installedProgramCompiler());
}

std::shared_ptr<const SurfaceProgram> compileSurfaceProgram(const std::string& name, std::string_view text,
                                                            const std::filesystem::path& file,
                                                            const std::function<bool()>& stop,
                                                            PreparedProgram& compiler) {
    const std::tuple key(name, std::string(text), file.string());
    {
        const std::lock_guard lock(held().mutex);
        if (const auto found = held().programs.find(key); found != held().programs.end())
            if (auto program = found->second.lock())
                return program;
    }
    auto program = std::make_shared<SurfaceProgram>();
    program->source = readProgramSource(name, text);
    program->text = text;
    program->file = file;
    program->spirv = compileProgram(program->source, compiler, stop);
    const std::lock_guard lock(held().mutex);
    std::erase_if(held().programs, [](const auto& each) { return each.second.expired(); });
    held().programs[key] = program;
    return program;
}

MaterialProgram materialProgram(std::shared_ptr<const SurfaceProgram> compiled, const json& shader) {
    MaterialProgram result;
    const SurfaceProgram& program = *compiled;
    for (const ProgramParameter& parameter : program.source.parameters)
        result.values.push_back(usedParts(parameter, parameter.value));
    if (const auto stated = shader.find(kValues); stated != shader.end())
        for (const auto& [name, value] : stated->items()) {
            const auto& declared = program.source.parameters;
            const auto parameter = std::ranges::find(declared, name, &ProgramParameter::name);
            if (parameter == declared.end())
                throw Error(program.source.name, "", "declares no parameter '" + name.substr(0, 40) + "'",
                            "take it out of the file, or declare it in the program");
            result.values[static_cast<size_t>(parameter - declared.begin())] =
                valueOf(program, *parameter, value);
        }
    if (const auto texture = shader.find("persistentTexture"); texture != shader.end())
        result.texture = textureSize(program, *texture);
    result.compiled = std::move(compiled);
    return result;
}

json withParameter(const json& shader, const ProgramParameter& parameter,
                   const std::array<double, 4>& value) {
    json result = shader;
    if (usedParts(parameter, value) == usedParts(parameter, parameter.value)) {
        if (const auto stated = result.find(kValues); stated != result.end()) {
            stated->erase(parameter.name);
            if (stated->empty())
                result.erase(kValues);
        }
        return result;
    }
    json& stated = result[kValues];
    const auto one = [&](double number) {
        return parameter.kind == ProgramParameter::Kind::Float ? json(number)
                                                               : json(static_cast<int64_t>(number));
    };
    if (parameter.components == 1) {
        stated[parameter.name] = one(value[0]);
    } else {
        stated[parameter.name] = json::array();
        for (size_t i = 0; i < parameter.components; ++i)
            stated[parameter.name].push_back(one(value[i]));
    }
    return result;
}

} // namespace touchstone
