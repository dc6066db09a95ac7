#pragma once
// The types of a SPIR-V module, and the registers that a value of each takes.

#include "engine/program/spirv_reader.h"

#include <cstdint>
#include <functional>
#include <map>
#include <vector>

namespace touchstone::program {

struct SpirvType {
    enum class Kind : uint8_t {
        Void,
        Bool,
        Int,
        Uint,
        Float,
        Vector,
        Matrix,
        Array,
        Struct,
        Pointer,
        Function
    };
    Kind kind = Kind::Void;
    uint32_t element = 0;          ///< type id of vectors, matrices (a column), arrays and pointers
    uint32_t count = 1;            ///< of elements
    std::vector<uint32_t> members; ///< type ids of structs
    uint32_t storage = 0;          ///< of pointers
    uint32_t registers = 0;        ///< at most kMaxRegisters; 0 of types without a value
};

class SpirvTypes {
  public:
    /// True where the instruction declares a type, which is added. `length(id)` is the value of a constant.
    /// Throws Refusal.
    bool add(const SpirvInstruction& at, const std::function<uint32_t(uint32_t)>& length);

    /// Throws Refusal where there is no such type.
    [[nodiscard]] const SpirvType& operator[](uint32_t id) const;
    /// Of a scalar or of the elements of a vector or matrix; else Void.
    [[nodiscard]] SpirvType::Kind scalarKind(uint32_t id) const;
    /// Type id of member or element i. Throws Refusal where there is none.
    [[nodiscard]] uint32_t partOf(uint32_t id, uint32_t i) const;
    /// First register of member or element i, relative to the value's; partOf has accepted i.
    [[nodiscard]] uint32_t offsetOf(uint32_t id, uint32_t i) const;

  private:
    [[nodiscard]] SpirvType scalar(const SpirvInstruction& at) const;
    [[nodiscard]] SpirvType composite(const SpirvInstruction& at,
                                      const std::function<uint32_t(uint32_t)>& length) const;

    std::map<uint32_t, SpirvType> types_;
};

} // namespace touchstone::program
