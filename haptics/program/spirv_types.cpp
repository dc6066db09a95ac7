#include "haptics/program/spirv_types.h"

#include "haptics/program/register_program.h"

#include <glslang/SPIRV/spirv.hpp>

namespace touchstone::program {

namespace {

constexpr size_t kMaxMembers = 256;

[[noreturn]] void refuseType(const char* what) {
    throw Refusal(std::string("uses ") + what,
                  "use float, int, uint, bool, and vectors, matrices, arrays and "
                  "structs of them");
}

} // namespace

const SpirvType& SpirvTypes::operator[](uint32_t id) const {
    const auto found = types_.find(id);
    if (found == types_.end())
        throw Refusal("is a damaged SPIR-V module: a type is missing", "compile the source again");
    return found->second;
}

SpirvType::Kind SpirvTypes::scalarKind(uint32_t id) const {
    const SpirvType* type = &(*this)[id];
    while (type->kind == SpirvType::Kind::Vector || type->kind == SpirvType::Kind::Matrix)
        type = &(*this)[type->element];
    return type->kind <= SpirvType::Kind::Float ? type->kind : SpirvType::Kind::Void;
}

uint32_t SpirvTypes::partOf(uint32_t id, uint32_t i) const {
    const SpirvType& type = (*this)[id];
    using enum SpirvType::Kind;
    if (type.kind == Struct && i < type.members.size())
        return type.members[i];
    if ((type.kind == Vector || type.kind == Matrix || type.kind == Array) && i < type.count)
        return type.element;
    throw Refusal("reads element " + std::to_string(static_cast<int32_t>(i)) + " of a value that has none",
                  "keep the index below the array's length");
}

uint32_t SpirvTypes::offsetOf(uint32_t id, uint32_t i) const {
    const SpirvType& type = (*this)[id];
    if (type.kind != SpirvType::Kind::Struct)
        return i * (*this)[type.element].registers;
    uint32_t sum = 0;
    for (uint32_t k = 0; k < i; ++k)
        sum += (*this)[type.members[k]].registers;
    return sum;
}

bool SpirvTypes::add(const SpirvInstruction& at, const std::function<uint32_t(uint32_t)>& length) {
    SpirvType type;
    switch (at.code) {
    case spv::OpTypeVoid:
    case spv::OpTypeFunction:
    case spv::OpTypeBool:
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
        type = scalar(at);
        break;
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
    case spv::OpTypeArray:
    case spv::OpTypeStruct:
    case spv::OpTypePointer:
        type = composite(at, length);
        break;
    case spv::OpTypeRuntimeArray:
        refuseType("an array without a length");
    case spv::OpTypeImage:
    case spv::OpTypeSampler:
    case spv::OpTypeSampledImage:
        refuseType("a texture");
    default:
        return false;
    }
    if (!types_.emplace(at.result, type).second)
        throw Refusal("is a damaged SPIR-V module", "compile the source again");
    return true;
}

SpirvType SpirvTypes::scalar(const SpirvInstruction& at) const {
    using enum SpirvType::Kind;
    SpirvType type;
    type.registers = 1;
    switch (at.code) {
    case spv::OpTypeBool:
        type.kind = Bool;
        break;
    case spv::OpTypeInt:
        if (at.operand(0) != 32)
            refuseType("integers that do not have 32 bits");
        type.kind = at.operand(1) != 0 ? Int : Uint;
        break;
    case spv::OpTypeFloat:
        if (at.operand(0) != 32)
            refuseType("double or half precision");
        type.kind = Float;
        break;
    default:
        type.kind = at.code == spv::OpTypeVoid ? Void : Function;
        type.registers = 0;
        break;
    }
    return type;
}

SpirvType SpirvTypes::composite(const SpirvInstruction& at,
                                const std::function<uint32_t(uint32_t)>& length) const {
    using enum SpirvType::Kind;
    SpirvType type;
    uint64_t registers = 0;
    switch (at.code) {
    case spv::OpTypePointer:
        type.kind = Pointer;
        type.storage = at.operand(0);
        type.element = at.operand(1);
        (void)(*this)[type.element];
        return type;
    case spv::OpTypeStruct:
        type.kind = Struct;
        if (at.operands() > kMaxMembers)
            throw Refusal("declares a struct of more than " + std::to_string(kMaxMembers) + " members",
                          "split the struct");
        for (size_t i = 0; i < at.operands(); ++i) {
            type.members.push_back(at.operand(i));
            registers += (*this)[at.operand(i)].registers;
        }
        break;
    default: {
        type.element = at.operand(0);
        const SpirvType& element = (*this)[type.element];
        type.count = at.code == spv::OpTypeArray ? length(at.operand(1)) : at.operand(1);
        type.kind = at.code == spv::OpTypeVector ? Vector : at.code == spv::OpTypeMatrix ? Matrix : Array;
        const bool fits = type.kind == Vector   ? element.kind >= Bool && element.kind <= Float
                          : type.kind == Matrix ? element.kind == Vector && scalarKind(type.element) == Float
                                                : element.registers > 0;
        if (!fits || type.count == 0 || (type.kind != Array && (type.count < 2 || type.count > 4)))
            throw Refusal("is a damaged SPIR-V module: a type has wrong parts", "compile the source again");
        registers = uint64_t{type.count} * element.registers;
        break;
    }
    }
    if (registers > kMaxRegisters)
        throw Refusal("declares a value of " + std::to_string(4 * registers) + " bytes; a program has " +
                          std::to_string(4 * kMaxRegisters),
                      "make the array smaller");
    type.registers = static_cast<uint32_t>(registers);
    return type;
}

} // namespace touchstone::program
