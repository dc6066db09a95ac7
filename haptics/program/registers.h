#pragma once
// The registers of a run: 32 bits each, and for dual numbers their derivatives. For executor.cpp only.

#include "haptics/program/real_functions.h"
#include "haptics/program/register_program.h"

#include <array>
#include <bit>
#include <cstdint>
#include <cstring>

namespace touchstone::program {

/// Every register is zero at first; `constants` fill the first ones.
class PlainRegisters {
  public:
    using Real = float;
    explicit PlainRegisters(const RegisterProgram& program) {
        const size_t constants = program.constants.size();
        std::memcpy(bits_.data(), program.constants.data(), 4 * constants);
        std::memset(bits_.data() + constants, 0, 4 * (program.registers - constants));
    }
    [[nodiscard]] Real real(size_t i) const { return std::bit_cast<float>(bits_[i]); }
    [[nodiscard]] uint32_t bits(size_t i) const { return bits_[i]; }
    void set(size_t i, Real value) { bits_[i] = std::bit_cast<uint32_t>(value); }
    void setBits(size_t i, uint32_t bits) { bits_[i] = bits; }
    void move(size_t to, size_t from) { bits_[to] = bits_[from]; }

  private:
    std::array<uint32_t, kMaxRegisters> bits_; // not initialised: the servo pays for those in use
};

/// An integer has the derivatives zero.
class DualRegisters {
  public:
    using Real = Dual;
    explicit DualRegisters(const RegisterProgram& program) {
        const size_t constants = program.constants.size();
        for (size_t i = 0; i < constants; ++i)
            registers_[i] = {program.constants[i], {}};
        for (size_t i = constants; i < program.registers; ++i)
            registers_[i] = {0, {}};
    }
    [[nodiscard]] Real real(size_t i) const {
        return {std::bit_cast<float>(registers_[i].bits), registers_[i].d};
    }
    [[nodiscard]] uint32_t bits(size_t i) const { return registers_[i].bits; }
    void set(size_t i, const Real& value) { registers_[i] = {std::bit_cast<uint32_t>(value.v), value.d}; }
    void setBits(size_t i, uint32_t bits) { registers_[i] = {bits, {}}; }
    void move(size_t to, size_t from) { registers_[to] = registers_[from]; }

  private:
    struct Register {
        uint32_t bits;
        std::array<float, 3> d;
    };
    std::array<Register, kMaxRegisters> registers_; // not initialised
};

} // namespace touchstone::program
