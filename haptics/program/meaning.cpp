#include "haptics/program/meaning.h"

#include <glslang/SPIRV/spirv.hpp>

#include <array>
#include <bit>
#include <numbers>

namespace touchstone::program {

void refuseDamaged(const char* what) {
    throw Refusal(std::string(kDamagedModule) + ": " + what, kCompileAgain);
}

const Value& Meaning::value(uint32_t id) const {
    const auto found = values_.find(id);
    if (found == values_.end())
        refuseDamaged("a value is used before it is made");
    return found->second;
}

const Place& Meaning::place(uint32_t id) const {
    const auto found = places_.find(id);
    if (found == places_.end())
        refuseDamaged("a variable is used before it is declared");
    return found->second;
}

void Meaning::define(const SpirvInstruction& at, uint16_t first) {
    if (!values_.emplace(at.result, Value{at.type, first}).second)
        refuseDamaged("a value is made twice");
}

void Meaning::definePlace(const SpirvInstruction& at, const Place& made) {
    if (!places_.emplace(at.result, made).second)
        refuseDamaged("a variable is declared twice");
}

bool Meaning::isKind(uint32_t type, SpirvType::Kind kind) const {
    using enum SpirvType::Kind;
    const SpirvType::Kind actual = types.scalarKind(type);
    // Signed and unsigned integers are the same registers; SPIR-V lets them mix.
    return actual == kind || (actual == Int && kind == Uint) || (actual == Uint && kind == Int);
}

uint16_t Meaning::operand(const SpirvInstruction& at, size_t i, SpirvType::Kind kind, size_t count) const {
    const Value& v = value(at.operand(i));
    if (!isKind(v.type, kind) || size(v) != count)
        refuseDamaged("an operand has a wrong type");
    return v.first;
}

uint32_t Meaning::resultSize(const SpirvInstruction& at, SpirvType::Kind kind) const {
    if (!isKind(at.type, kind))
        refuseDamaged("a result has a wrong type");
    return types[at.type].registers;
}

std::optional<uint32_t> Meaning::constantBits(uint32_t id) const {
    const auto found = scalars.find(id);
    return found != scalars.end() ? std::optional(found->second) : std::nullopt;
}

uint16_t Meaning::number(float wanted) const {
    return numbers_.at(wanted);
}

void Meaning::declareNumbers() {
    constexpr float kPi = std::numbers::pi_v<float>;
    for (const float number : {0.0f, 1.0f, 2.0f, kPi / 180.0f, 180.0f / kPi})
        numbers_[number] = build.constant(std::array{std::bit_cast<uint32_t>(number)});
}

std::vector<uint32_t> Meaning::constantParts(const SpirvInstruction& at) const {
    const uint32_t size = types[at.type].registers;
    switch (at.code) {
    case spv::OpConstantTrue:
    case spv::OpSpecConstantTrue:
        return {1};
    case spv::OpConstantFalse:
    case spv::OpSpecConstantFalse:
        return {0};
    case spv::OpConstant:
    case spv::OpSpecConstant:
        return {at.operand(0)};
    case spv::OpConstantNull:
        return std::vector<uint32_t>(size, 0);
    default: {
        std::vector<uint32_t> bits;
        for (size_t i = 0; i < at.operands(); ++i) {
            const Value& part = operand(at, i);
            if (part.type != types.partOf(at.type, static_cast<uint32_t>(i)))
                refuseDamaged("a constant has wrong parts");
            const auto first = build.constants().begin() + part.first;
            bits.insert(bits.end(), first, first + size_t{types[part.type].registers});
        }
        return bits;
    }
    }
}

void Meaning::declareConstant(const SpirvInstruction& at) {
    const SpirvType& type = types[at.type];
    const std::vector<uint32_t> bits = constantParts(at);
    if (type.registers == 0 || bits.size() != type.registers)
        refuseDamaged("a constant has a wrong size");
    if (type.kind >= SpirvType::Kind::Bool && type.kind <= SpirvType::Kind::Float)
        scalars[at.result] = bits[0];
    define(at, build.constant(bits));
}

} // namespace touchstone::program
