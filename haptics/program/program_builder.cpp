#include "haptics/program/program_builder.h"

#include "haptics/program/shorten.h"

#include <array>
#include <string>

namespace touchstone::program {

namespace {

constexpr std::array<uint8_t, 256> costs() {
    std::array<uint8_t, 256> all{};
#define TOUCHSTONE_COST(name, value) all[static_cast<size_t>(Operation::name)] = value;
    TOUCHSTONE_PROGRAM_OPERATIONS(TOUCHSTONE_COST)
#undef TOUCHSTONE_COST
    return all;
}
constexpr std::array<uint8_t, 256> kCosts = costs();

} // namespace

uint16_t ProgramBuilder::constant(std::span<const uint32_t> bits) {
    if (registers_ != program_.constants.size()) // their registers would be others'
        throw Refusal("is a damaged SPIR-V module: a constant comes too late", "compile the source again");
    const uint16_t first = allocate(bits.size());
    program_.constants.insert(program_.constants.end(), bits.begin(), bits.end());
    return first;
}

uint16_t ProgramBuilder::allocate(size_t count) {
    if (count > kMaxRegisters - registers_)
        throw Refusal("needs more than " + std::to_string(kMaxRegisters) + " numbers at once",
                      "make arrays smaller, call functions less often, or turn repetitions into loops");
    const auto first = static_cast<uint16_t>(registers_);
    registers_ += count;
    return first;
}

void ProgramBuilder::emit(const Instruction& instruction) {
    if (program_.instructions.size() >= kMaxInstructions)
        throw Refusal("has more than " + std::to_string(kMaxInstructions) + " instructions",
                      "call functions less often, or turn repetitions into loops");
    program_.instructions.push_back(instruction);
    program_.lines.push_back(line_);
}

uint16_t ProgramBuilder::result(Operation operation, size_t count, uint16_t a, uint16_t b, uint16_t c,
                                size_t results) {
    const uint16_t to = allocate(results != 0 ? results : count);
    emit({operation, static_cast<uint16_t>(count), to, a, b, c});
    return to;
}

void ProgramBuilder::move(uint16_t to, uint16_t from, size_t count) {
    if (count > 0 && to != from)
        emit({Operation::Move, static_cast<uint16_t>(count), to, from});
}

void ProgramBuilder::jump(Operation operation, uint32_t label, uint16_t a, uint16_t b) {
    open_.emplace_back(position(), label);
    emit({operation, 1, 0, a, b, 0});
}

size_t ProgramBuilder::openJump(Operation operation, uint16_t a, uint16_t b) {
    emit({operation, 1, 0, a, b, 0});
    return position() - 1;
}

void ProgramBuilder::land(size_t openJump) {
    program_.instructions[openJump].c = static_cast<uint16_t>(position());
}

void ProgramBuilder::beginBlock(uint32_t label) {
    if (!blocks_.emplace(label, position()).second)
        throw Refusal("is a damaged SPIR-V module: a block has two places", "compile the source again");
}

RegisterProgram ProgramBuilder::finish() {
    emit({Operation::Unreachable}); // a jump to the end, and a block without one
    for (const auto& [at, label] : open_) {
        const auto block = blocks_.find(label);
        if (block == blocks_.end())
            throw Refusal("is a damaged SPIR-V module: a block is missing", "compile the source again");
        program_.instructions[at].c = static_cast<uint16_t>(block->second);
    }
    shorten(program_);
    uint32_t sum = 0;
    program_.cost.push_back(0);
    for (const Instruction& instruction : program_.instructions) {
        sum += 1u + instruction.count * kCosts[static_cast<size_t>(instruction.operation)];
        if (sum > kBudget)
            throw Refusal("would take longer than a tick allows, even without its loops",
                          "call functions less often, or leave out octaves");
        program_.cost.push_back(sum);
    }
    program_.registers = static_cast<uint16_t>(registers_);
    return std::move(program_);
}

} // namespace touchstone::program
