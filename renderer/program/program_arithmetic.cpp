// Arithmetic of a program's body, guarded, and with the bits that the hand computes.

#include "renderer/program/program_body.h"

#include <glslang/SPIRV/spirv.hpp>
#include <spirv/unified1/GLSL.std.450.h>

#include <bit>

namespace touchstone::program {

namespace {

/// Those that a compiler may not contract or reorder (NoContraction).
bool isArithmetic(uint32_t code) {
    return code == spv::OpFNegate || code == spv::OpFAdd || code == spv::OpFSub || code == spv::OpFMul ||
           code == spv::OpFDiv || (code >= spv::OpFRem && code <= spv::OpDot);
}

} // namespace

/// By zero the run fails; the smallest number by -1, which processors trap on, is divided by 1.
void ProgramBody::divide(const SpirvInstruction& at) {
    const uint32_t a = id(at.operand(0)), b = id(at.operand(1));
    const Shape top = shapeOf(at.operand(0)), divisor = shapeOf(at.operand(1));
    const uint32_t type = out_.boolType(divisor.components);
    uint32_t unfit = put(spv::OpIEqual, type, {b, out_.null(divisor.type)});
    failWhere(divisor.components == 1 ? unfit : put(spv::OpAny, out_.boolType(1), {unfit}));
    if (at.code != spv::OpUDiv && at.code != spv::OpUMod) {
        const uint32_t minusOne = put(spv::OpIEqual, type, {b, splat(divisor, ~uint32_t{0})});
        const uint32_t smallest = put(spv::OpIEqual, type, {a, splat(top, 0x80000000u)});
        const uint32_t both = put(spv::OpLogicalAnd, type, {minusOne, smallest});
        unfit = put(spv::OpLogicalOr, type, {unfit, both});
    }
    const uint32_t safe = put(spv::OpSelect, divisor.type, {unfit, splat(divisor, 1), b});
    emit(body_, at.code, {id(at.type), id(at.result), a, safe});
}

/// By the amount modulo 32, as for the hand.
void ProgramBody::shift(const SpirvInstruction& at) {
    const Shape amount = shapeOf(at.operand(1));
    const uint32_t masked = put(spv::OpBitwiseAnd, amount.type, {id(at.operand(1)), splat(amount, 31)});
    emit(body_, at.code, {id(at.type), id(at.result), id(at.operand(0)), masked});
}

/// Saturates to the floats next to the ends; of a NaN: 0.
void ProgramBody::toInteger(const SpirvInstruction& at) {
    const bool isSigned = at.code == spv::OpConvertFToS;
    const Shape from = shapeOf(at.operand(0));
    const uint32_t x = id(at.operand(0));
    const uint32_t low = splat(from, std::bit_cast<uint32_t>(isSigned ? -2147483648.0f : 0.0f)),
                   high = splat(from, std::bit_cast<uint32_t>(isSigned ? 2147483520.0f : 4294967040.0f));
    const uint32_t inside = put(spv::OpExtInst, from.type, {out_.extended(), GLSLstd450FClamp, x, low, high});
    const uint32_t number = put(spv::OpFOrdEqual, out_.boolType(from.components), {x, x});
    const uint32_t safe = put(spv::OpSelect, from.type, {number, inside, out_.null(from.type)});
    emit(body_, at.code, {id(at.type), id(at.result), safe});
}

/// Functions of which devices have other forms, as the hand computes them (haptics/program/real_functions.h).
bool ProgramBody::asForTheHand(const SpirvInstruction& at) {
    const Shape shape = shapeOfType(at.type);
    const auto number = [&](float value) { return splat(shape, std::bit_cast<uint32_t>(value)); };
    const auto exact = [&](uint32_t code, uint32_t x, uint32_t y) {
        return putExact(code, shape.type, {x, y});
    };
    const auto last = [&](uint32_t code, std::initializer_list<uint32_t> operands) {
        Words all{shape.type, id(at.result)};
        all.insert(all.end(), operands);
        emit(body_, code, all);
        if (isArithmetic(code))
            emit(out_.decorations, spv::OpDecorate, {id(at.result), spv::DecorationNoContraction});
        return true;
    };
    const uint32_t x = id(at.operand(2));
    switch (at.operand(1)) {
    case GLSLstd450FMix: { // x (1 - a) + y a
        const uint32_t a = id(at.operand(4)), rest = exact(spv::OpFSub, number(1.0f), a);
        return last(spv::OpFAdd, {exact(spv::OpFMul, x, rest), exact(spv::OpFMul, id(at.operand(3)), a)});
    }
    case GLSLstd450SmoothStep: { // t t (3 - 2 t)
        const uint32_t across = exact(spv::OpFSub, id(at.operand(3)), x),
                       along = exact(spv::OpFSub, id(at.operand(4)), x);
        const uint32_t t = put(spv::OpExtInst, shape.type,
                               {out_.extended(), GLSLstd450FClamp, exact(spv::OpFDiv, along, across),
                                number(0.0f), number(1.0f)});
        const uint32_t rest = exact(spv::OpFSub, number(3.0f), exact(spv::OpFMul, number(2.0f), t));
        return last(spv::OpFMul, {exact(spv::OpFMul, t, t), rest});
    }
    case GLSLstd450Round: { // halves away from zero
        const auto function = [&](uint32_t which, uint32_t of) {
            return put(spv::OpExtInst, shape.type, {out_.extended(), which, of});
        };
        const uint32_t whole = function(GLSLstd450Trunc, x);
        const uint32_t rest = function(GLSLstd450FAbs, exact(spv::OpFSub, x, whole));
        const uint32_t farther = exact(spv::OpFAdd, whole, function(GLSLstd450FSign, x));
        const uint32_t isHalf =
            put(spv::OpFOrdGreaterThanEqual, out_.boolType(shape.components), {rest, number(0.5f)});
        return last(spv::OpSelect, {isHalf, farther, whole});
    }
    default:
        return false;
    }
}

void ProgramBody::arithmetic(const SpirvInstruction& at) {
    switch (at.code) {
    case spv::OpUDiv:
    case spv::OpSDiv:
    case spv::OpUMod:
    case spv::OpSRem:
    case spv::OpSMod:
        return divide(at);
    case spv::OpShiftLeftLogical:
    case spv::OpShiftRightLogical:
    case spv::OpShiftRightArithmetic:
        return shift(at);
    case spv::OpConvertFToS:
    case spv::OpConvertFToU:
        return toInteger(at);
    case spv::OpExtInst:
        if (asForTheHand(at))
            return;
        break;
    case spv::OpVariable: // the hand's are zero at first
        emit(body_, spv::OpVariable,
             {id(at.type), id(at.result), at.operand(0),
              at.operands() > 1 ? id(at.operand(1)) : out_.null(id(made(at.type).operand(1)))});
        return;
    default:
        if (isArithmetic(at.code))
            emit(out_.decorations, spv::OpDecorate, {id(at.result), spv::DecorationNoContraction});
        break;
    }
    copy(at);
}

} // namespace touchstone::program
