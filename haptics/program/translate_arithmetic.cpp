#include "haptics/program/meaning.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv/unified1/GLSL.std.450.h>

#include <algorithm>
#include <array>

namespace touchstone::program {

namespace {

constexpr Kind kF = Kind::Float, kI = Kind::Int, kB = Kind::Bool;

/// An elementwise instruction: all operands have as many components as the result.
struct Row {
    uint32_t code;
    Operation operation;
    uint8_t operands;
    Kind result, operand;
    bool swapped = false; ///< the operation takes the second operand first
};

constexpr std::array kRows = {
    Row{spv::OpFAdd, Operation::FAdd, 2, kF, kF},
    Row{spv::OpFSub, Operation::FSub, 2, kF, kF},
    Row{spv::OpFMul, Operation::FMul, 2, kF, kF},
    Row{spv::OpFDiv, Operation::FDiv, 2, kF, kF},
    Row{spv::OpFRem, Operation::FRem, 2, kF, kF},
    Row{spv::OpFMod, Operation::FMod, 2, kF, kF},
    Row{spv::OpFNegate, Operation::FNegate, 1, kF, kF},
    Row{spv::OpIAdd, Operation::IAdd, 2, kI, kI},
    Row{spv::OpISub, Operation::ISub, 2, kI, kI},
    Row{spv::OpIMul, Operation::IMul, 2, kI, kI},
    Row{spv::OpSNegate, Operation::INegate, 1, kI, kI},
    Row{spv::OpUDiv, Operation::UDiv, 2, kI, kI},
    Row{spv::OpSDiv, Operation::SDiv, 2, kI, kI},
    Row{spv::OpUMod, Operation::UMod, 2, kI, kI},
    Row{spv::OpSRem, Operation::SRem, 2, kI, kI},
    Row{spv::OpSMod, Operation::SMod, 2, kI, kI},
    Row{spv::OpShiftLeftLogical, Operation::ShiftLeft, 2, kI, kI},
    Row{spv::OpShiftRightLogical, Operation::ShiftRight, 2, kI, kI},
    Row{spv::OpShiftRightArithmetic, Operation::ShiftRightSigned, 2, kI, kI},
    Row{spv::OpBitwiseAnd, Operation::And, 2, kI, kI},
    Row{spv::OpBitwiseOr, Operation::Or, 2, kI, kI},
    Row{spv::OpBitwiseXor, Operation::Xor, 2, kI, kI},
    Row{spv::OpNot, Operation::Not, 1, kI, kI},
    Row{spv::OpBitReverse, Operation::BitReverse, 1, kI, kI},
    Row{spv::OpBitCount, Operation::BitCount, 1, kI, kI},
    Row{spv::OpConvertFToS, Operation::FToS, 1, kI, kF},
    Row{spv::OpConvertFToU, Operation::FToU, 1, kI, kF},
    Row{spv::OpConvertSToF, Operation::SToF, 1, kF, kI},
    Row{spv::OpConvertUToF, Operation::UToF, 1, kF, kI},
    Row{spv::OpFOrdEqual, Operation::FOrdEqual, 2, kB, kF},
    Row{spv::OpFUnordEqual, Operation::FUnordEqual, 2, kB, kF},
    Row{spv::OpFOrdNotEqual, Operation::FOrdNotEqual, 2, kB, kF},
    Row{spv::OpFUnordNotEqual, Operation::FUnordNotEqual, 2, kB, kF},
    Row{spv::OpFOrdLessThan, Operation::FOrdLess, 2, kB, kF},
    Row{spv::OpFUnordLessThan, Operation::FUnordLess, 2, kB, kF},
    Row{spv::OpFOrdGreaterThan, Operation::FOrdLess, 2, kB, kF, true},
    Row{spv::OpFUnordGreaterThan, Operation::FUnordLess, 2, kB, kF, true},
    Row{spv::OpFOrdLessThanEqual, Operation::FOrdLessEqual, 2, kB, kF},
    Row{spv::OpFUnordLessThanEqual, Operation::FUnordLessEqual, 2, kB, kF},
    Row{spv::OpFOrdGreaterThanEqual, Operation::FOrdLessEqual, 2, kB, kF, true},
    Row{spv::OpFUnordGreaterThanEqual, Operation::FUnordLessEqual, 2, kB, kF, true},
    Row{spv::OpIsNan, Operation::IsNan, 1, kB, kF},
    Row{spv::OpIsInf, Operation::IsInf, 1, kB, kF},
    Row{spv::OpIEqual, Operation::IEqual, 2, kB, kI},
    Row{spv::OpINotEqual, Operation::INotEqual, 2, kB, kI},
    Row{spv::OpSLessThan, Operation::SLess, 2, kB, kI},
    Row{spv::OpSLessThanEqual, Operation::SLessEqual, 2, kB, kI},
    Row{spv::OpSGreaterThan, Operation::SLess, 2, kB, kI, true},
    Row{spv::OpSGreaterThanEqual, Operation::SLessEqual, 2, kB, kI, true},
    Row{spv::OpULessThan, Operation::ULess, 2, kB, kI},
    Row{spv::OpULessThanEqual, Operation::ULessEqual, 2, kB, kI},
    Row{spv::OpUGreaterThan, Operation::ULess, 2, kB, kI, true},
    Row{spv::OpUGreaterThanEqual, Operation::ULessEqual, 2, kB, kI, true},
    Row{spv::OpLogicalEqual, Operation::IEqual, 2, kB, kB},
    Row{spv::OpLogicalNotEqual, Operation::INotEqual, 2, kB, kB},
    Row{spv::OpLogicalAnd, Operation::And, 2, kB, kB},
    Row{spv::OpLogicalOr, Operation::Or, 2, kB, kB},
    Row{spv::OpLogicalNot, Operation::LogicalNot, 1, kB, kB},
};

constexpr std::array kExtendedRows = {
    Row{GLSLstd450Round, Operation::Round, 1, kF, kF},
    Row{GLSLstd450RoundEven, Operation::RoundEven, 1, kF, kF},
    Row{GLSLstd450Trunc, Operation::Trunc, 1, kF, kF},
    Row{GLSLstd450FAbs, Operation::FAbs, 1, kF, kF},
    Row{GLSLstd450SAbs, Operation::SAbs, 1, kI, kI},
    Row{GLSLstd450FSign, Operation::FSign, 1, kF, kF},
    Row{GLSLstd450SSign, Operation::SSign, 1, kI, kI},
    Row{GLSLstd450Floor, Operation::Floor, 1, kF, kF},
    Row{GLSLstd450Ceil, Operation::Ceil, 1, kF, kF},
    Row{GLSLstd450Fract, Operation::Fract, 1, kF, kF},
    Row{GLSLstd450Sin, Operation::Sin, 1, kF, kF},
    Row{GLSLstd450Cos, Operation::Cos, 1, kF, kF},
    Row{GLSLstd450Tan, Operation::Tan, 1, kF, kF},
    Row{GLSLstd450Asin, Operation::Asin, 1, kF, kF},
    Row{GLSLstd450Acos, Operation::Acos, 1, kF, kF},
    Row{GLSLstd450Atan, Operation::Atan, 1, kF, kF},
    Row{GLSLstd450Sinh, Operation::Sinh, 1, kF, kF},
    Row{GLSLstd450Cosh, Operation::Cosh, 1, kF, kF},
    Row{GLSLstd450Tanh, Operation::Tanh, 1, kF, kF},
    Row{GLSLstd450Asinh, Operation::Asinh, 1, kF, kF},
    Row{GLSLstd450Acosh, Operation::Acosh, 1, kF, kF},
    Row{GLSLstd450Atanh, Operation::Atanh, 1, kF, kF},
    Row{GLSLstd450Atan2, Operation::Atan2, 2, kF, kF},
    Row{GLSLstd450Pow, Operation::Pow, 2, kF, kF},
    Row{GLSLstd450Exp, Operation::Exp, 1, kF, kF},
    Row{GLSLstd450Log, Operation::Log, 1, kF, kF},
    Row{GLSLstd450Exp2, Operation::Exp2, 1, kF, kF},
    Row{GLSLstd450Log2, Operation::Log2, 1, kF, kF},
    Row{GLSLstd450Sqrt, Operation::Sqrt, 1, kF, kF},
    Row{GLSLstd450InverseSqrt, Operation::InverseSqrt, 1, kF, kF},
    Row{GLSLstd450FMin, Operation::FMin, 2, kF, kF},
    Row{GLSLstd450UMin, Operation::UMin, 2, kI, kI},
    Row{GLSLstd450SMin, Operation::SMin, 2, kI, kI},
    Row{GLSLstd450FMax, Operation::FMax, 2, kF, kF},
    Row{GLSLstd450UMax, Operation::UMax, 2, kI, kI},
    Row{GLSLstd450SMax, Operation::SMax, 2, kI, kI},
    Row{GLSLstd450FClamp, Operation::FClamp, 3, kF, kF},
    Row{GLSLstd450FMix, Operation::FMix, 3, kF, kF},
    Row{GLSLstd450Step, Operation::Step, 2, kF, kF},
    Row{GLSLstd450SmoothStep, Operation::SmoothStep, 3, kF, kF},
    Row{GLSLstd450Fma, Operation::Fma, 3, kF, kF},
    Row{GLSLstd450FindILsb, Operation::FindILsb, 1, kI, kI},
    Row{GLSLstd450FindSMsb, Operation::FindSMsb, 1, kI, kI},
    Row{GLSLstd450FindUMsb, Operation::FindUMsb, 1, kI, kI},
};

template <size_t count>
const Row* rowOf(const std::array<Row, count>& rows, uint32_t code) {
    const auto found = std::ranges::find(rows, code, &Row::code);
    return found != rows.end() ? &*found : nullptr;
}

/// `first`: of the operands in the instruction.
void elementwise(Meaning& t, const SpirvInstruction& at, const Row& row, size_t first) {
    const uint32_t size = t.resultSize(at, row.result);
    std::array<uint16_t, 3> from{};
    for (size_t i = 0; i < row.operands; ++i)
        from[i] = t.operand(at, first + i, row.operand, size);
    if (row.swapped)
        std::swap(from[0], from[1]);
    t.define(at, t.build.result(row.operation, size, from[0], from[1], from[2]));
}

/// low = smallest of the upper bound, largest of the lower: clamp of integers.
void clampIntegers(Meaning& t, const SpirvInstruction& at, Operation low, Operation high) {
    const uint32_t size = t.resultSize(at, kI);
    const uint16_t above = t.build.result(low, size, t.operand(at, 2, kI, size), t.operand(at, 3, kI, size));
    t.define(at, t.build.result(high, size, above, t.operand(at, 4, kI, size)));
}

void select(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.types[at.type].registers;
    const Value& condition = t.operand(at, 0);
    const Value &yes = t.operand(at, 1), &no = t.operand(at, 2);
    const uint32_t conditions = t.size(condition);
    if (t.types.scalarKind(condition.type) != kB || yes.type != at.type || no.type != at.type || size == 0 ||
        (conditions != 1 && conditions != size))
        refuseDamaged("a selection has wrong types");
    t.define(at, t.build.result(conditions == 1 ? Operation::SelectAll : Operation::Select, size,
                                condition.first, yes.first, no.first));
}

void bitField(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.resultSize(at, kI);
    const uint16_t base = t.operand(at, 0, kI, size);
    if (at.code != spv::OpBitFieldInsert) {
        const Operation operation =
            at.code == spv::OpBitFieldUExtract ? Operation::BitUExtract : Operation::BitSExtract;
        t.define(at, t.build.result(operation, size, base, t.operand(at, 1, kI, 1), t.operand(at, 2, kI, 1)));
        return;
    }
    const uint16_t insert = t.operand(at, 1, kI, size), both = t.build.allocate(2);
    t.build.move(both, t.operand(at, 2, kI, 1), 1);
    t.build.move(static_cast<uint16_t>(both + 1), t.operand(at, 3, kI, 1), 1);
    t.define(at, t.build.result(Operation::BitInsert, size, base, insert, both));
}

/// The result is a struct of the low and the high part.
void extendedInteger(Meaning& t, const SpirvInstruction& at, Operation low, Operation high) {
    const SpirvType& type = t.types[at.type];
    if (type.kind != Kind::Struct || type.members.size() != 2 || type.members[0] != type.members[1] ||
        !t.isKind(type.members[0], kI))
        refuseDamaged("a result has a wrong type");
    const uint32_t size = t.types[type.members[0]].registers;
    const uint16_t a = t.operand(at, 0, kI, size), b = t.operand(at, 1, kI, size);
    const uint16_t to = t.build.allocate(size_t{2} * size);
    t.build.emit({low, static_cast<uint16_t>(size), to, a, b});
    t.build.emit({high, static_cast<uint16_t>(size), static_cast<uint16_t>(to + size), a, b});
    t.define(at, to);
}

/// The result is a struct of two parts of one operand, elementwise.
void twoParts(Meaning& t, const SpirvInstruction& at, Operation first, Operation second, Kind secondKind) {
    const SpirvType& type = t.types[at.type];
    if (type.kind != Kind::Struct || type.members.size() != 2 || !t.isKind(type.members[0], kF) ||
        !t.isKind(type.members[1], secondKind))
        refuseDamaged("a result has a wrong type");
    const uint32_t size = t.types[type.members[0]].registers;
    if (t.types[type.members[1]].registers != size)
        refuseDamaged("a result has a wrong type");
    const uint16_t x = t.operand(at, 2, kF, size), to = t.build.allocate(size_t{2} * size);
    const auto rest = static_cast<uint16_t>(to + size);
    t.build.emit({second, static_cast<uint16_t>(size), rest, x});
    if (first == Operation::FSub) // modf: what the whole part leaves
        t.build.emit({first, static_cast<uint16_t>(size), to, x, rest});
    else
        t.build.emit({first, static_cast<uint16_t>(size), to, x});
    t.define(at, to);
}

/// The same where the second part goes to a variable.
void partToVariable(Meaning& t, const SpirvInstruction& at, bool modf) {
    const uint32_t size = t.resultSize(at, kF);
    const uint16_t x = t.operand(at, 2, kF, size);
    const Place& place = t.place(at.operand(3));
    if (place.offset || place.storage == spv::StorageClassInput ||
        place.storage == spv::StorageClassUniform || !t.isKind(place.type, modf ? kF : kI) ||
        t.types[place.type].registers != size)
        refuseDamaged("an operand has a wrong type");
    const uint16_t second = t.build.result(modf ? Operation::Trunc : Operation::FrexpExponent, size, x);
    const uint16_t first = modf ? t.build.result(Operation::FSub, size, x, second)
                                : t.build.result(Operation::FrexpSignificand, size, x);
    t.build.move(place.first, second, size);
    t.define(at, first);
}

void oneBit(Meaning& t, const SpirvInstruction& at, Operation operation) {
    const Value& all = t.operand(at, 0);
    if (t.resultSize(at, kB) != 1 || t.types.scalarKind(all.type) != kB)
        refuseDamaged("an operand has a wrong type");
    t.define(at, t.build.result(operation, t.size(all), all.first, 0, 0, 1));
}

void bitcast(Meaning& t, const SpirvInstruction& at) {
    const Value& from = t.operand(at, 0);
    const auto isNumber = [&](uint32_t type) {
        const Kind kind = t.types.scalarKind(type);
        return kind == Kind::Int || kind == Kind::Uint || kind == Kind::Float;
    };
    if (!isNumber(at.type) || !isNumber(from.type) || t.size(from) != t.types[at.type].registers)
        refuseDamaged("a conversion has wrong types");
    // Of its own, so that the derivatives of the bits are zero.
    const uint32_t size = t.size(from);
    t.define(at, t.build.result(Operation::Or, size, from.first, from.first));
}

} // namespace

bool translateArithmetic(Meaning& t, const SpirvInstruction& at) {
    if (const Row* row = rowOf(kRows, at.code)) {
        elementwise(t, at, *row, 0);
        return true;
    }
    switch (at.code) {
    case spv::OpSelect:
        select(t, at);
        return true;
    case spv::OpBitcast:
        bitcast(t, at);
        return true;
    case spv::OpBitFieldInsert:
    case spv::OpBitFieldSExtract:
    case spv::OpBitFieldUExtract:
        bitField(t, at);
        return true;
    case spv::OpUMulExtended:
        extendedInteger(t, at, Operation::IMul, Operation::UMulHigh);
        return true;
    case spv::OpSMulExtended:
        extendedInteger(t, at, Operation::IMul, Operation::SMulHigh);
        return true;
    case spv::OpIAddCarry:
        extendedInteger(t, at, Operation::IAdd, Operation::Carry);
        return true;
    case spv::OpISubBorrow:
        extendedInteger(t, at, Operation::ISub, Operation::Borrow);
        return true;
    case spv::OpAny:
        oneBit(t, at, Operation::Any);
        return true;
    case spv::OpAll:
        oneBit(t, at, Operation::All);
        return true;
    default:
        return false;
    }
}

bool translateExtended(Meaning& t, const SpirvInstruction& at) {
    if (at.code != spv::OpExtInst)
        return false;
    if (t.module.extended == 0 || at.operand(0) != t.module.extended)
        refuseDamaged("an instruction set is missing");
    const uint32_t code = at.operand(1);
    if (const Row* row = rowOf(kExtendedRows, code)) {
        elementwise(t, at, *row, 2);
        return true;
    }
    switch (code) {
    case GLSLstd450UClamp:
        clampIntegers(t, at, Operation::UMax, Operation::UMin);
        return true;
    case GLSLstd450SClamp:
        clampIntegers(t, at, Operation::SMax, Operation::SMin);
        return true;
    case GLSLstd450Radians:
    case GLSLstd450Degrees: {
        constexpr float kPi = 3.14159265358979323846f;
        const uint32_t size = t.resultSize(at, kF);
        t.define(at, t.build.result(Operation::Scale, size, t.operand(at, 2, kF, size),
                                    t.number(code == GLSLstd450Radians ? kPi / 180.0f : 180.0f / kPi)));
        return true;
    }
    case GLSLstd450Ldexp: {
        const uint32_t size = t.resultSize(at, kF);
        t.define(at, t.build.result(Operation::Ldexp, size, t.operand(at, 2, kF, size),
                                    t.operand(at, 3, kI, size)));
        return true;
    }
    case GLSLstd450Modf:
    case GLSLstd450Frexp:
        partToVariable(t, at, code == GLSLstd450Modf);
        return true;
    case GLSLstd450ModfStruct:
        twoParts(t, at, Operation::FSub, Operation::Trunc, kF);
        return true;
    case GLSLstd450FrexpStruct:
        twoParts(t, at, Operation::FrexpSignificand, Operation::FrexpExponent, kI);
        return true;
    default:
        return translateMatrix(t, at);
    }
}

} // namespace touchstone::program
