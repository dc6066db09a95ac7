#pragma once
// What the ids of a module mean while it is translated. For the files translate_*.cpp only.

#include "engine/program/spirv_reader.h"
#include "haptics/program/program_builder.h"
#include "haptics/program/spirv_types.h"

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace touchstone::program {

constexpr const char* kDamagedModule = "is a damaged SPIR-V module";
constexpr const char* kCompileAgain = "compile the source again";

using Kind = SpirvType::Kind;

/// A register's number or a count, which instructions hold in 16 bits.
[[nodiscard]] constexpr uint16_t at16(size_t i) {
    return static_cast<uint16_t>(i);
}

/// A value in registers.
struct Value {
    uint32_t type = 0;
    uint16_t first = 0;
};

/// A place in registers: first + r[offset].
struct Place {
    uint32_t type = 0; ///< of what is there
    uint32_t storage = 0;
    uint16_t first = 0;
    std::optional<uint16_t> offset;
};

struct Phi {
    uint32_t result = 0;
    std::vector<std::pair<uint32_t, uint32_t>> sources; ///< value, block
};

/// The ids so far, and the program so far. All members throw Refusal.
class Meaning {
  public:
    explicit Meaning(const SpirvModule& from) : module(from) {}

    const SpirvModule& module;
    SpirvTypes types;
    ProgramBuilder build;

    [[nodiscard]] const Value& value(uint32_t id) const;
    [[nodiscard]] const Place& place(uint32_t id) const;
    /// Registers of a value.
    [[nodiscard]] uint32_t size(const Value& v) const { return types[v.type].registers; }
    void define(const SpirvInstruction& at, uint16_t first);
    void definePlace(const SpirvInstruction& at, const Place& made);
    /// Operand i as a value.
    [[nodiscard]] const Value& operand(const SpirvInstruction& at, size_t i) const {
        return value(at.operand(i));
    }
    /// Operand i, of kind `kind` and with so many registers.
    [[nodiscard]] uint16_t operand(const SpirvInstruction& at, size_t i, Kind kind, size_t count) const;
    /// Registers of the result, whose scalar kind is `kind`.
    [[nodiscard]] uint32_t resultSize(const SpirvInstruction& at, SpirvType::Kind kind) const;
    [[nodiscard]] bool isKind(uint32_t type, SpirvType::Kind kind) const;
    /// Bits of a constant scalar, if it is one.
    [[nodiscard]] std::optional<uint32_t> constantBits(uint32_t id) const;
    /// Registers with one number, a constant.
    [[nodiscard]] uint16_t number(float value) const;

    void declareConstant(const SpirvInstruction& at);
    void declareNumbers();
    std::map<uint32_t, uint32_t> scalars; ///< bits of constant scalars

  private:
    [[nodiscard]] std::vector<uint32_t> constantParts(const SpirvInstruction& at) const;
    std::map<uint32_t, Value> values_;
    std::map<uint32_t, Place> places_;
    std::map<float, uint16_t> numbers_;
};

[[noreturn]] void refuseDamaged(const char* what);

// Each returns false where the instruction is none of its kind.
bool translateArithmetic(Meaning& t, const SpirvInstruction& at);
bool translateComposite(Meaning& t, const SpirvInstruction& at);
bool translateMatrix(Meaning& t, const SpirvInstruction& at);
bool translateMemory(Meaning& t, const SpirvInstruction& at);
bool translateExtended(Meaning& t, const SpirvInstruction& at);
/// Module-level variables and those of functions.
void declareVariable(Meaning& t, const SpirvInstruction& at);

} // namespace touchstone::program
