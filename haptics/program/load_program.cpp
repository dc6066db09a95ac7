#include "haptics/program/load_program.h"

#include "engine/core/error.h"
#include "haptics/program/translator.h"

#include <algorithm>
#include <bit>
#include <iterator>
#include <utility>

namespace touchstone::program {

void setParameters(RegisterProgram& program, const std::vector<ProgramParameter>& parameters) {
    for (const ParameterSlot& slot : program.parameters) {
        const auto parameter = std::ranges::find(parameters, slot.name, &ProgramParameter::name);
        const bool inside = slot.count <= std::size(ProgramParameter{}.value) &&
                            size_t{slot.first} + slot.count <= program.constants.size();
        if (parameter == parameters.end() || !inside)
            continue;
        for (size_t i = 0; i < slot.count; ++i) {
            const double value = parameter->value[i];
            program.constants[slot.first + i] = slot.kind == ParameterSlot::Kind::Float
                                                    ? std::bit_cast<uint32_t>(static_cast<float>(value))
                                                    : static_cast<uint32_t>(static_cast<int64_t>(value));
        }
    }
}

RegisterProgram translated(const ProgramSource& source, std::span<const uint32_t> spirv) {
    Translation translation = translateSpirv(spirv);
    if (translation.problem) {
        const TranslationProblem& problem = *translation.problem;
        throw Error(source.name, placeInSource(source, problem.place.file, problem.place.line), problem.what,
                    problem.remedy);
    }
    return std::move(translation.program);
}

RegisterProgram loadProgram(const ProgramSource& source, PreparedProgram& compiler,
                            const std::function<bool()>& stop) {
    RegisterProgram program = translated(source, compileProgram(source, compiler, stop));
    setParameters(program, source.parameters);
    return program;
}

} // namespace touchstone::program
