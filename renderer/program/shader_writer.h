#pragma once
// A SPIR-V shader to which types, constants, variables and the body of one function are added. Pure; any
// thread.

#include "engine/program/spirv_reader.h"

#include <cstdint>
#include <initializer_list>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchstone::program {

using Words = std::vector<uint32_t>;

/// Appends an instruction.
void emit(Words& to, uint32_t code, std::span<const uint32_t> operands);
inline void emit(Words& to, uint32_t code, std::initializer_list<uint32_t> operands) {
    emit(to, code, std::span(operands.begin(), operands.size()));
}

/// Keeps no copy of the host's words. Members throw Refusal.
class ShaderWriter {
  public:
    explicit ShaderWriter(std::span<const uint32_t> host);

    [[nodiscard]] uint32_t newId() { return bound_++; }
    [[nodiscard]] uint32_t extended() const { return host_.extended; }
    /// Id of the variable or function of this name.
    [[nodiscard]] uint32_t named(const std::string& name) const;
    /// Type id of a variable.
    [[nodiscard]] uint32_t typeOfVariable(uint32_t id) const;

    /// The one type of these operands: neither struct nor array.
    [[nodiscard]] uint32_t type(uint32_t code, std::span<const uint32_t> operands);
    [[nodiscard]] uint32_t type(uint32_t code, std::initializer_list<uint32_t> operands) {
        return type(code, std::span(operands.begin(), operands.size()));
    }
    [[nodiscard]] uint32_t boolType(uint32_t components);
    [[nodiscard]] uint32_t uintType();
    /// A scalar, or a vector of equal components.
    [[nodiscard]] uint32_t constant(uint32_t type, uint32_t element, uint32_t components, uint32_t bits);
    [[nodiscard]] uint32_t null(uint32_t type);
    [[nodiscard]] uint32_t trueConstant();

    /// Added after the host's own.
    Words decorations, globals;
    /// Variables of any storage that are added, for the entry point.
    std::vector<uint32_t> interface;

    /// The host with all that was added, and with `body` between OpFunction and OpFunctionEnd of `function`.
    [[nodiscard]] Words finish(uint32_t function, const Words& body) const;

  private:
    std::span<const uint32_t> words_;
    SpirvModule host_;
    uint32_t bound_ = 0;
    std::map<Words, uint32_t> types_, constants_; ///< by code and operands
};

} // namespace touchstone::program
