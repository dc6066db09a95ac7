#include "haptics/program/felt_program.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/program/program_compiler.h"
#include "haptics/program/load_program.h"
#include "haptics/program/translator.h"

#include <algorithm>
#include <utility>

namespace touchstone::program {

namespace {

constexpr size_t kPosition = 0, kTangent = 2, kBinormal = 3, kUv = 4; // locations of interface.glsl

const Port* portAt(const std::vector<Port>& ports, size_t location) {
    const auto found = std::ranges::find(ports, location, &Port::location);
    return found != ports.end() ? &*found : nullptr;
}

/// False where nothing but copies of the position's components is ever written into the output.
bool writesPosition(const RegisterProgram& program) {
    const Port* out = portAt(program.outputs, kPosition);
    const Port* in = portAt(program.inputs, kPosition);
    if (out == nullptr || in == nullptr)
        return out != nullptr;
    const auto touches = [](const Instruction& at, size_t first, size_t count) {
        return at.to < first + count && first < size_t{at.to} + std::max<size_t>(at.count, 1);
    };
    bool copied = false;
    for (const Instruction& at : program.instructions) {
        if (at.operation == Operation::StoreAt || at.operation == Operation::LoadAt)
            return true; // the places that it writes are not known here
        if (touches(at, in->first, in->count))
            return true;
        if (!touches(at, out->first, out->count))
            continue;
        const bool copy = at.operation == Operation::Move && at.to == out->first && at.a == in->first &&
                          at.count == out->count;
        if (!copy)
            return true;
        copied = true;
    }
    return !copied;
}

uint64_t identityOf(const MaterialProgram& material) {
    Hash64 hash;
    hash.addBytes(material.compiled->spirv);
    for (const std::array<double, 4>& value : material.values)
        for (const double part : value)
            hash.add(part);
    return hash.value();
}

} // namespace

FeltProgram feltProgram(const MaterialProgram& material, const FeltProgram* before) {
    const ProgramSource& source = material.compiled->source;
    FeltProgram felt;
    felt.name = source.name;
    felt.compiled = material.compiled;
    const bool known = before != nullptr && before->compiled == material.compiled;
    felt.code = known ? before->code : translated(source, material.compiled->spirv);
    std::vector<ProgramParameter> parameters = source.parameters;
    for (size_t i = 0; i < parameters.size() && i < material.values.size(); ++i)
        parameters[i].value = material.values[i];
    setParameters(felt.code, parameters);
    felt.displaces = writesPosition(felt.code);
    for (const size_t location : {kTangent, kBinormal, kUv})
        felt.usesCoordinates |= felt.code.reads(location);
    felt.identity = identityOf(material);
    return felt;
}

} // namespace touchstone::program
