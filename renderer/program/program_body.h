#pragma once
// The one function of a haptic program with guards, so that it ends and reads nothing but its own: loops are
// counted, indices stay inside, divisions of integers by zero do not happen. For link_program.cpp.

#include "renderer/program/shader_writer.h"

#include <cstdint>
#include <map>
#include <optional>

namespace touchstone::program {

/// Throws Refusal.
[[noreturn]] void refuseToShow(const std::string& why);

/// Members throw Refusal.
class ProgramBody {
  public:
    /// `failed`: a private bool of the host that becomes true where the program has no result. `budget`:
    /// SPIR-V instructions in loops.
    ProgramBody(const SpirvModule& program, ShaderWriter& out, uint32_t failed, uint32_t budget);

    /// The program's id `from` is `to` in the shader; before the body is written.
    void map(uint32_t from, uint32_t to) { ids_[from] = to; }
    [[nodiscard]] uint32_t id(uint32_t from) const;
    /// The instruction with this result.
    [[nodiscard]] const SpirvInstruction& made(uint32_t result) const;
    /// Operands of a declaration with its ids as they are in the shader.
    [[nodiscard]] Words operandsOf(const SpirvInstruction& at) const;

    /// Instructions first .. last - 1 of the program, without OpFunction and OpFunctionEnd.
    [[nodiscard]] Words write(size_t first, size_t last);

  private:
    struct Shape { ///< of a scalar or a vector
        uint32_t type = 0, element = 0, components = 1;
    };
    struct Loop {
        uint32_t check = 0, fail = 0, rest = 0; ///< blocks that are added
        uint32_t merge = 0, next = 0;           ///< of the program: after the loop, and its continue block
        uint32_t again = 0; ///< the new continue block of a loop that was one block; else 0
        uint32_t cost = 0;  ///< of an iteration, instructions
    };

    void findLoops(size_t first, size_t last);
    void instruction(const SpirvInstruction& at);
    void phi(const SpirvInstruction& at);
    void label(const SpirvInstruction& at);
    void count(const Loop& loop);
    void branch(const SpirvInstruction& at);
    void arithmetic(const SpirvInstruction& at);
    void access(const SpirvInstruction& at);
    void dynamicComponent(const SpirvInstruction& at);
    void divide(const SpirvInstruction& at);
    void shift(const SpirvInstruction& at);
    void toInteger(const SpirvInstruction& at);
    [[nodiscard]] bool asForTheHand(const SpirvInstruction& at);

    [[nodiscard]] uint32_t typeOfValue(uint32_t value) const;
    [[nodiscard]] Shape shapeOf(uint32_t value) const;
    [[nodiscard]] Shape shapeOfType(uint32_t type) const;
    [[nodiscard]] std::optional<uint32_t> constantBits(uint32_t value) const;
    /// Emits it and returns its result.
    uint32_t put(uint32_t code, uint32_t type, std::initializer_list<uint32_t> operands);
    uint32_t putExact(uint32_t code, uint32_t type, std::initializer_list<uint32_t> operands);
    void copy(const SpirvInstruction& at);
    void failWhere(uint32_t condition);
    [[nodiscard]] uint32_t insideIndex(uint32_t index, uint32_t count);
    [[nodiscard]] uint32_t splat(const Shape& shape, uint32_t bits);

    const SpirvModule& program_;
    ShaderWriter& out_;
    uint32_t failed_ = 0, spent_ = 0, budget_ = 0;
    std::map<uint32_t, uint32_t> ids_;
    std::map<uint32_t, const SpirvInstruction*> made_;
    std::map<uint32_t, Loop> loops_; ///< by header
    Words body_;
    uint32_t block_ = 0;
    const Loop* uncounted_ = nullptr; ///< its header's phis are being written
};

} // namespace touchstone::program
