#pragma once
// Registers and instructions of a program while it is translated.

#include "engine/program/spirv_reader.h"
#include "haptics/program/register_program.h"

#include <cstdint>
#include <map>
#include <span>
#include <utility>
#include <vector>

namespace touchstone::program {

/// Throws Refusal where a program would pass its bounds. Constants come first: `constant` may be called until
/// the first `allocate`.
class ProgramBuilder {
  public:
    /// First register of these constants.
    uint16_t constant(std::span<const uint32_t> bits);
    /// First of so many registers, which are zero at first.
    uint16_t allocate(size_t count);
    void emit(const Instruction& instruction);
    /// The line of the source that instructions come from which are emitted next.
    void setLine(uint32_t line) { line_ = line; }
    /// Emits it with registers of its own for the result, whose first is returned.
    uint16_t result(Operation operation, size_t count, uint16_t a, uint16_t b = 0, uint16_t c = 0,
                    size_t results = 0);
    void move(uint16_t to, uint16_t from, size_t count);
    [[nodiscard]] size_t position() const { return program_.instructions.size(); }

    /// A jump that is emitted next goes to the block `label`, whose place may be unknown yet.
    void jump(Operation operation, uint32_t label, uint16_t a = 0, uint16_t b = 0);
    /// The same to `position()` at a later `land`.
    [[nodiscard]] size_t openJump(Operation operation, uint16_t a, uint16_t b = 0);
    void land(size_t openJump);
    void beginBlock(uint32_t label);

    [[nodiscard]] const std::vector<uint32_t>& constants() const { return program_.constants; }
    [[nodiscard]] RegisterProgram& program() { return program_; }
    /// Resolves jumps and adds up costs.
    [[nodiscard]] RegisterProgram finish();

  private:
    RegisterProgram program_;
    size_t registers_ = 0;
    uint32_t line_ = 0;
    std::map<uint32_t, size_t> blocks_;
    std::vector<std::pair<size_t, uint32_t>> open_;
};

} // namespace touchstone::program
