#include "haptics/program/felt_program.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "engine/program/program_compiler.h"
#include "haptics/program/interface_locations.h"
#include "haptics/program/load_program.h"
#include "haptics/program/translator.h"

#include <algorithm>
#include <cstddef>
#include <utility>
#include <vector>

namespace touchstone::program {

namespace {

const Port* portAt(const std::vector<Port>& ports, size_t location) {
    const auto found = std::ranges::find(ports, location, &Port::location);
    return found != ports.end() ? &*found : nullptr;
}

/// What a register holds, whatever way a run takes: a copy of one of the position's components, or anything.
constexpr int kNever = -2, kAnything = -1;

int joined(int a, int b) {
    return a == kNever ? b : b == kNever || a == b ? a : kAnything;
}

/// One pass over all instructions. True where a register came to hold more.
bool follow(const RegisterProgram& program, std::vector<int>& holds) {
    bool changed = false;
    for (const Instruction& at : program.instructions)
        for (size_t i = 0; i < std::max<size_t>(at.count, 1) && at.to + i < holds.size(); ++i) {
            const bool copies = at.operation == Operation::Move && at.a + i < holds.size();
            int& to = holds[at.to + i];
            const int next = joined(to, copies ? holds[at.a + i] : kAnything);
            changed |= next != to;
            to = next;
        }
    return changed;
}

/// False where nothing but the position that it gets is ever written into the output.
bool writesPosition(const RegisterProgram& program) {
    const Port* out = portAt(program.outputs, kOutPosition);
    const Port* in = portAt(program.inputs, kPosition);
    const bool indexed = std::ranges::any_of(program.instructions, [](const Instruction& at) {
        return at.operation == Operation::StoreAt; // into a place that is not known here
    });
    if (out == nullptr || in == nullptr || indexed)
        return out != nullptr;
    std::vector<int> holds(program.registers, kNever);
    std::fill_n(holds.begin(), std::min(program.constants.size(), holds.size()), kAnything);
    for (size_t k = 0; k < in->count; ++k)
        holds[in->first + k] = static_cast<int>(k);
    while (follow(program, holds)) {
    }
    for (size_t k = 0; k < out->count; ++k)
        if (holds[out->first + k] != static_cast<int>(k))
            return true;
    return false;
}

uint64_t identityOf(const MaterialProgram& material, const PersistentTextureSize& texture) {
    Hash64 hash;
    hash.addBytes(material.compiled->spirv);
    for (const std::array<double, 4>& value : material.values)
        for (const double part : value)
            hash.add(part);
    if (texture.width > 0) {
        hash.add(texture.width);
        hash.add(texture.height);
        for (const float value : {texture.initial, texture.minimum, texture.maximum})
            hash.add(value);
    }
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
    for (const InputLocation location : {kTangent, kBinormal, kUv})
        felt.usesCoordinates |= felt.code.reads(location);
    if (felt.code.reads(kPersistent) || portAt(felt.code.outputs, kOutPersistent) != nullptr)
        felt.texture = material.texture;
    felt.usesCoordinates |= felt.texture.width > 0;
    felt.identity = identityOf(material, felt.texture);
    return felt;
}

} // namespace touchstone::program
