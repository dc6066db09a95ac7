#include "renderer/program/program_body.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <array>

namespace touchstone::program {

namespace {

constexpr uint32_t kGuardCost = 8; ///< of a count at a loop's head

/// Operand i (after type and result) is a number and no id.
bool isLiteral(const SpirvInstruction& at, size_t i) {
    switch (at.code) {
    case spv::OpConstant:
    case spv::OpTypeInt:
    case spv::OpTypeFloat:
        return true;
    case spv::OpTypePointer:
    case spv::OpVariable:
        return i == 0;
    case spv::OpTypeVector:
    case spv::OpTypeMatrix:
    case spv::OpExtInst:
        return i == 1;
    case spv::OpCompositeExtract:
    case spv::OpLoad:
    case spv::OpSelectionMerge:
        return i >= 1;
    case spv::OpCompositeInsert:
    case spv::OpVectorShuffle:
    case spv::OpStore:
    case spv::OpCopyMemory:
    case spv::OpLoopMerge:
        return i >= 2;
    case spv::OpBranchConditional:
        return i >= 3;
    case spv::OpSwitch:
        return i >= 2 && i % 2 == 0;
    default:
        return false;
    }
}

bool isSilent(uint32_t code) {
    return code == spv::OpNop || code == spv::OpLine || code == spv::OpNoLine;
}

/// Instructions of functions that need no guard and whose operands isLiteral knows.
bool isPlain(uint32_t code) {
    constexpr std::array<std::array<uint32_t, 2>, 7> kRanges = {{{spv::OpVectorShuffle, spv::OpTranspose},
                                                                 {spv::OpConvertFToU, spv::OpConvertUToF},
                                                                 {spv::OpBitcast, spv::OpBitcast},
                                                                 {spv::OpSNegate, spv::OpSMulExtended},
                                                                 {spv::OpAny, spv::OpFUnordGreaterThanEqual},
                                                                 {spv::OpShiftRightLogical, spv::OpBitCount},
                                                                 {spv::OpLoad, spv::OpCopyMemory}}};
    const auto within = [&](const auto& range) { return code >= range[0] && code <= range[1]; };
    return std::ranges::any_of(kRanges, within) || code == spv::OpExtInst || code == spv::OpSelectionMerge ||
           code == spv::OpReturn || code == spv::OpUnreachable || code == spv::OpVariable;
}

} // namespace

void refuseToShow(const std::string& why) {
    throw Refusal("cannot be shown: " + why, "use arithmetic, functions of GLSL, conditions and loops");
}

ProgramBody::ProgramBody(const SpirvModule& program, ShaderWriter& out, uint32_t failed, uint32_t budget)
    : program_(program), out_(out), failed_(failed), budget_(budget) {
    for (const SpirvInstruction& at : program.instructions)
        if (at.result != 0) {
            if (!made_.emplace(at.result, &at).second)
                refuseToShow("a value is made twice");
            ids_[at.result] = out.newId();
        }
}

uint32_t ProgramBody::id(uint32_t from) const {
    const auto found = ids_.find(from);
    if (found == ids_.end())
        refuseToShow("a value is missing");
    return found->second;
}

const SpirvInstruction& ProgramBody::made(uint32_t result) const {
    const auto found = made_.find(result);
    if (found == made_.end())
        refuseToShow("a value is missing");
    return *found->second;
}

Words ProgramBody::operandsOf(const SpirvInstruction& at) const {
    Words operands;
    for (size_t i = 0; i < at.operands(); ++i)
        operands.push_back(isLiteral(at, i) ? at.operand(i) : id(at.operand(i)));
    return operands;
}

uint32_t ProgramBody::typeOfValue(uint32_t value) const {
    return made(value).type;
}

ProgramBody::Shape ProgramBody::shapeOfType(uint32_t type) const {
    const SpirvInstruction& at = made(type);
    if (at.code != spv::OpTypeVector)
        return {id(type), id(type), 1};
    if (at.operand(1) < 2 || at.operand(1) > 4)
        refuseToShow("a vector has a wrong size");
    return {id(type), id(at.operand(0)), at.operand(1)};
}

ProgramBody::Shape ProgramBody::shapeOf(uint32_t value) const {
    return shapeOfType(typeOfValue(value));
}

std::optional<uint32_t> ProgramBody::constantBits(uint32_t value) const {
    const SpirvInstruction& at = made(value);
    return at.code == spv::OpConstant ? std::optional(at.operand(0)) : std::nullopt;
}

uint32_t ProgramBody::splat(const Shape& shape, uint32_t bits) {
    return out_.constant(shape.type, shape.element, shape.components, bits);
}

uint32_t ProgramBody::put(uint32_t code, uint32_t type, std::initializer_list<uint32_t> operands) {
    const uint32_t result = out_.newId();
    Words all{type, result};
    all.insert(all.end(), operands);
    emit(body_, code, all);
    return result;
}

uint32_t ProgramBody::putExact(uint32_t code, uint32_t type, std::initializer_list<uint32_t> operands) {
    const uint32_t result = put(code, type, operands);
    emit(out_.decorations, spv::OpDecorate, {result, spv::DecorationNoContraction});
    return result;
}

void ProgramBody::copy(const SpirvInstruction& at) {
    Words all;
    if (at.type != 0)
        all.push_back(id(at.type));
    if (at.result != 0)
        all.push_back(id(at.result));
    for (const uint32_t operand : operandsOf(at))
        all.push_back(operand);
    emit(body_, at.code, all);
}

void ProgramBody::failWhere(uint32_t condition) {
    const uint32_t type = out_.boolType(1), before = put(spv::OpLoad, type, {failed_});
    emit(body_, spv::OpStore, {failed_, put(spv::OpLogicalOr, type, {before, condition})});
}

/// An index outside becomes 0 and the run fails.
uint32_t ProgramBody::insideIndex(uint32_t index, uint32_t count) {
    const Shape shape = shapeOf(index);
    const uint32_t type = out_.boolType(1), number = out_.uintType();
    const uint32_t limit = out_.constant(number, number, 1, count);
    const uint32_t outside = put(spv::OpUGreaterThanEqual, type, {id(index), limit});
    failWhere(outside);
    return put(spv::OpSelect, shape.type, {outside, out_.null(shape.type), id(index)});
}

void ProgramBody::access(const SpirvInstruction& at) {
    Words all{id(at.type), id(at.result), id(at.operand(0))};
    uint32_t type = made(typeOfValue(at.operand(0))).operand(1); // of what the pointer points to
    for (size_t i = 1; i < at.operands(); ++i) {
        const uint32_t index = at.operand(i);
        const SpirvInstruction& whole = made(type);
        const std::optional<uint32_t> known = constantBits(index);
        if (whole.code == spv::OpTypeStruct) {
            if (!known)
                refuseToShow("a member of a struct is computed");
            type = whole.operand(*known);
        } else if (whole.code == spv::OpTypeArray || whole.code == spv::OpTypeVector ||
                   whole.code == spv::OpTypeMatrix) {
            type = whole.operand(0);
        } else {
            refuseToShow("an index has no array");
        }
        if (known) {
            all.push_back(id(index));
            continue;
        }
        const uint32_t count =
            whole.code == spv::OpTypeArray ? constantBits(whole.operand(1)).value_or(0) : whole.operand(1);
        all.push_back(insideIndex(index, count));
    }
    emit(body_, spv::OpAccessChain, all);
}

void ProgramBody::dynamicComponent(const SpirvInstruction& at) {
    const uint32_t count = shapeOf(at.operand(0)).components;
    Words all{id(at.type), id(at.result), id(at.operand(0))};
    if (at.code == spv::OpVectorInsertDynamic)
        all.push_back(id(at.operand(1)));
    all.push_back(insideIndex(at.operand(at.code == spv::OpVectorInsertDynamic ? 2 : 1), count));
    emit(body_, at.code, all);
}

void ProgramBody::phi(const SpirvInstruction& at) {
    Words all{id(at.type), id(at.result)};
    for (size_t i = 0; i + 1 < at.operands(); i += 2) {
        const uint32_t from = at.operand(i + 1);
        const auto loop = loops_.find(from);
        all.push_back(id(at.operand(i)));
        all.push_back(loop == loops_.end()                        ? id(from)
                      : from == block_ && loop->second.again != 0 ? loop->second.again
                                                                  : loop->second.rest);
    }
    emit(body_, spv::OpPhi, all);
}

/// Jumps of a loop that was one block go back over a block of their own.
void ProgramBody::branch(const SpirvInstruction& at) {
    const auto loop = loops_.find(block_);
    const uint32_t again = loop != loops_.end() ? loop->second.again : 0;
    Words operands = operandsOf(at);
    if (again != 0)
        for (size_t i = 0; i < operands.size(); ++i)
            if (!isLiteral(at, i) && at.operand(i) == block_)
                operands[i] = again;
    emit(body_, at.code, operands);
    if (again != 0) {
        emit(body_, spv::OpLabel, {again});
        emit(body_, spv::OpBranch, {id(block_)});
    }
}

void ProgramBody::findLoops(size_t first, size_t last) {
    std::map<uint32_t, size_t> starts;
    uint32_t block = 0;
    for (size_t i = first; i < last; ++i) {
        const SpirvInstruction& at = program_.instructions[i];
        if (at.code == spv::OpLabel) {
            block = at.result;
            starts[block] = i;
        }
        if (at.code != spv::OpLoopMerge)
            continue;
        Loop loop{.check = out_.newId(),
                  .fail = out_.newId(),
                  .rest = out_.newId(),
                  .merge = at.operand(0),
                  .next = at.operand(1)};
        if (loop.next == block)
            loop.again = out_.newId();
        loops_[block] = loop;
    }
    // What an iteration takes: all up to the last jump back.
    for (size_t i = first; i < last; ++i) {
        const SpirvInstruction& at = program_.instructions[i];
        if (at.code != spv::OpBranch && at.code != spv::OpBranchConditional && at.code != spv::OpSwitch)
            continue;
        for (size_t k = 0; k < at.operands(); ++k) {
            const auto start = starts.find(at.operand(k));
            const auto loop = loops_.find(at.operand(k));
            if (isLiteral(at, k) || loop == loops_.end() || start == starts.end() || start->second > i)
                continue;
            loop->second.cost = std::max(loop->second.cost, static_cast<uint32_t>(i - start->second));
        }
    }
}

/// After a header's phis: counts, and leaves the program where the budget is spent.
void ProgramBody::count(const Loop& loop) {
    emit(body_, spv::OpLoopMerge,
         {id(loop.merge), loop.again != 0 ? loop.again : id(loop.next), spv::LoopControlMaskNone});
    emit(body_, spv::OpBranch, {loop.check});
    emit(body_, spv::OpLabel, {loop.check});
    const uint32_t number = out_.uintType();
    const uint32_t before = put(spv::OpLoad, number, {spent_});
    const uint32_t now =
        put(spv::OpIAdd, number, {before, out_.constant(number, number, 1, loop.cost + kGuardCost)});
    emit(body_, spv::OpStore, {spent_, now});
    const uint32_t over =
        put(spv::OpUGreaterThan, out_.boolType(1), {now, out_.constant(number, number, 1, budget_)});
    emit(body_, spv::OpSelectionMerge, {loop.rest, spv::SelectionControlMaskNone});
    emit(body_, spv::OpBranchConditional, {over, loop.fail, loop.rest});
    emit(body_, spv::OpLabel, {loop.fail});
    emit(body_, spv::OpStore, {failed_, out_.trueConstant()});
    emit(body_, spv::OpReturn, {});
    emit(body_, spv::OpLabel, {loop.rest});
}

void ProgramBody::label(const SpirvInstruction& at) {
    block_ = at.result;
    emit(body_, spv::OpLabel, {id(block_)});
    if (spent_ == 0 && !loops_.empty()) { // the first block
        const uint32_t number = out_.uintType();
        const uint32_t type = out_.type(spv::OpTypePointer, {spv::StorageClassFunction, number});
        spent_ = put(spv::OpVariable, type, {spv::StorageClassFunction, out_.null(number)});
    }
    const auto loop = loops_.find(block_);
    uncounted_ = loop != loops_.end() ? &loop->second : nullptr;
}

void ProgramBody::instruction(const SpirvInstruction& at) {
    if (isSilent(at.code))
        return;
    if (at.code == spv::OpLabel)
        return label(at);
    if (block_ == 0)
        refuseToShow("an instruction is in no block");
    if (at.code == spv::OpPhi)
        return phi(at);
    if (uncounted_ != nullptr) {
        count(*uncounted_);
        uncounted_ = nullptr;
    }
    switch (at.code) {
    case spv::OpLoopMerge: // stands above
    case spv::OpUndef:     // a constant
        return;
    case spv::OpBranch:
    case spv::OpBranchConditional:
    case spv::OpSwitch:
        return branch(at);
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
        return access(at);
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorInsertDynamic:
        return dynamicComponent(at);
    default:
        if (!isPlain(at.code))
            refuseToShow("it uses SPIR-V instruction " + std::to_string(at.code));
        return arithmetic(at);
    }
}

Words ProgramBody::write(size_t first, size_t last) {
    findLoops(first, last);
    for (size_t i = first; i < last; ++i) // a phi may name a later one
        if (program_.instructions[i].code == spv::OpUndef)
            map(program_.instructions[i].result, out_.null(id(program_.instructions[i].type)));
    for (size_t i = first; i < last; ++i)
        instruction(program_.instructions[i]);
    return std::move(body_);
}

} // namespace touchstone::program
