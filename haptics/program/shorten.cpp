#include "haptics/program/shorten.h"

#include <algorithm>
#include <vector>

namespace touchstone::program {

namespace {

bool isJump(Operation operation) {
    return operation == Operation::Jump || operation == Operation::JumpUnless ||
           operation == Operation::JumpIfEqual;
}

/// It does something besides writing its result: divisions of integers and indices may end the run.
bool hasEffect(Operation operation) {
    switch (operation) {
    case Operation::Return:
    case Operation::Unreachable:
    case Operation::StoreAt: // somewhere
    case Operation::Index:
    case Operation::UDiv:
    case Operation::SDiv:
    case Operation::UMod:
    case Operation::SRem:
    case Operation::SMod:
        return true;
    default:
        return isJump(operation);
    }
}

/// Registers of which some are read, as if control could go from anywhere to anywhere.
class Readings {
  public:
    explicit Readings(const RegisterProgram& program) : read_(kMaxRegisters + 8, false) {
        for (const Port& port : program.outputs)
            note(port.first, port.count);
        for (bool more = true; more;) {
            more = false;
            for (const Instruction& at : program.instructions)
                if (needed(at))
                    more |= noteOperands(at);
        }
    }
    [[nodiscard]] bool needed(const Instruction& at) const {
        return hasEffect(at.operation) || anyRead(at.to, at.count); // dot, any, all write one of them
    }
    [[nodiscard]] bool anyRead(size_t first, size_t count) const {
        const size_t end = std::min(first + count, read_.size());
        return std::find(read_.begin() + static_cast<std::ptrdiff_t>(first),
                         read_.begin() + static_cast<std::ptrdiff_t>(end),
                         true) != read_.begin() + static_cast<std::ptrdiff_t>(end);
    }

  private:
    bool note(size_t first, size_t count) {
        bool changed = false;
        for (size_t i = first; i < std::min(first + count, read_.size()); ++i) {
            changed |= !read_[i];
            read_[i] = true;
        }
        return changed;
    }
    /// At least what it reads: operands that are one component count as `count` of them, or two.
    bool noteOperands(const Instruction& at) {
        const size_t count = std::max<size_t>(at.count, 2);
        switch (at.operation) {
        case Operation::Jump:
        case Operation::Return:
        case Operation::Unreachable:
            return false;
        case Operation::LoadAt: // a place in an array that ends somewhere
            return note(at.a, read_.size()) | note(at.b, 1);
        case Operation::Move:
            return note(at.a, at.count);
        case Operation::JumpUnless:
        case Operation::Index: // b and c are numbers
            return note(at.a, 1);
        case Operation::JumpIfEqual:
            return note(at.a, 1) | note(at.b, 1);
        case Operation::Scale:
            return note(at.a, at.count) | note(at.b, 1);
        default:
            return note(at.a, count) | note(at.b, count) | note(at.c, count);
        }
    }

    std::vector<bool> read_;
};

} // namespace

void shorten(RegisterProgram& program) {
    std::erase_if(program.outputs, [](const Port& port) { return port.location == kLookOutput; });
    const Readings readings(program);
    std::erase_if(program.inputs,
                  [&](const Port& port) { return !readings.anyRead(port.first, port.count); });
    std::vector<uint16_t> places; // where each instruction goes, or the next one that stays
    uint16_t kept = 0;
    for (const Instruction& at : program.instructions) {
        places.push_back(kept);
        kept = static_cast<uint16_t>(kept + (readings.needed(at) ? 1 : 0));
    }
    std::vector<Instruction> instructions;
    std::vector<uint32_t> lines;
    for (size_t i = 0; i < program.instructions.size(); ++i) {
        Instruction at = program.instructions[i];
        if (!readings.needed(at))
            continue;
        lines.push_back(program.lines[i]);
        if (isJump(at.operation))
            at.c = places[at.c];
        instructions.push_back(at);
    }
    program.instructions = std::move(instructions);
    program.lines = std::move(lines);
}

} // namespace touchstone::program
