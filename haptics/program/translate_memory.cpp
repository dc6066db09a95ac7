// Composites, variables and places in them.

#include "haptics/program/meaning.h"

#include <glslang/SPIRV/spirv.hpp>

#include <array>

namespace touchstone::program {

namespace {

/// The part of a value of `type` that the literal indices from operand `i` on name: its type, and its first
/// register added to `first`.
Value partAt(const Meaning& t, const SpirvInstruction& at, size_t i, uint32_t type, uint16_t first) {
    Value part{type, first};
    for (; i < at.operands(); ++i) {
        const uint32_t index = at.operand(i), next = t.types.partOf(part.type, index);
        part = {next, at16(part.first + t.types.offsetOf(part.type, index))};
    }
    return part;
}

/// Parts one after the other; vectors may be made of vectors.
void construct(Meaning& t, const SpirvInstruction& at) {
    const uint32_t size = t.types[at.type].registers;
    uint32_t sum = 0;
    for (size_t i = 0; i < at.operands(); ++i)
        sum += t.size(t.operand(at, i));
    if (sum != size || size == 0)
        refuseDamaged("a value has wrong parts");
    const uint16_t to = t.build.allocate(size);
    uint32_t done = 0;
    for (size_t i = 0; i < at.operands(); ++i) {
        const Value& part = t.operand(at, i);
        t.build.move(at16(to + done), part.first, t.size(part));
        done += t.size(part);
    }
    t.define(at, to);
}

void shuffle(Meaning& t, const SpirvInstruction& at) {
    const Value &a = t.operand(at, 0), &b = t.operand(at, 1);
    const uint32_t sizeA = t.size(a), sizeB = t.size(b), size = t.types[at.type].registers;
    if (at.operands() != size_t{2} + size || size == 0)
        refuseDamaged("a value has wrong parts");
    std::array<uint16_t, 4> from{};
    if (size > from.size())
        refuseDamaged("a value has wrong parts");
    bool inOrder = true;
    for (size_t i = 0; i < size; ++i) {
        const uint32_t index = at.operand(2 + i) == 0xffffffffu ? 0 : at.operand(2 + i);
        if (index >= sizeA + sizeB)
            refuseDamaged("a value has wrong parts");
        from[i] = at16(index < sizeA ? a.first + index : b.first + (index - sizeA));
        inOrder &= from[i] == from[0] + i;
    }
    if (inOrder) { // part of another value
        t.define(at, from[0]);
        return;
    }
    const uint16_t to = t.build.allocate(size);
    for (size_t i = 0; i < size; ++i)
        t.build.move(at16(to + i), from[i], 1);
    t.define(at, to);
}

void insert(Meaning& t, const SpirvInstruction& at) {
    const Value &part = t.operand(at, 0), &whole = t.operand(at, 1);
    const uint32_t size = t.types[at.type].registers;
    if (whole.type != at.type || size == 0)
        refuseDamaged("a value has wrong parts");
    const uint16_t to = t.build.allocate(size);
    const Value place = partAt(t, at, 2, at.type, to);
    if (place.type != part.type)
        refuseDamaged("a value has wrong parts");
    t.build.move(to, whole.first, size);
    t.build.move(place.first, part.first, t.size(part));
    t.define(at, to);
}

/// A vector's component whose number is computed.
void dynamicComponent(Meaning& t, const SpirvInstruction& at) {
    const bool extracts = at.code == spv::OpVectorExtractDynamic;
    const Value& vector = t.operand(at, 0);
    const SpirvType& type = t.types[vector.type];
    if (type.kind != Kind::Vector || at.type != (extracts ? type.element : vector.type))
        refuseDamaged("an operand has a wrong type");
    const uint16_t index = t.operand(at, extracts ? 1 : 2, Kind::Int, 1);
    const uint16_t offset = t.build.result(Operation::Index, 1, index, 1, at16(type.count));
    if (extracts) {
        t.define(at, t.build.result(Operation::LoadAt, 1, vector.first, offset));
        return;
    }
    const Value& part = t.operand(at, 1);
    if (part.type != type.element)
        refuseDamaged("an operand has a wrong type");
    const uint16_t to = t.build.allocate(type.count);
    t.build.move(to, vector.first, type.count);
    t.build.emit({Operation::StoreAt, 1, to, part.first, offset});
    t.define(at, to);
}

void accessChain(Meaning& t, const SpirvInstruction& at) {
    Place place = t.place(at.operand(0));
    for (size_t i = 1; i < at.operands(); ++i) {
        const uint32_t id = at.operand(i);
        if (const auto index = t.constantBits(id)) {
            const uint32_t next = t.types.partOf(place.type, *index);
            place.first = at16(place.first + t.types.offsetOf(place.type, *index));
            place.type = next;
            continue;
        }
        const SpirvType& type = t.types[place.type];
        if (type.kind != Kind::Vector && type.kind != Kind::Matrix && type.kind != Kind::Array)
            refuseDamaged("a place has no elements");
        const uint16_t index = t.operand(at, i, Kind::Int, 1);
        const uint32_t stride = t.types[type.element].registers;
        const uint16_t offset = t.build.result(Operation::Index, 1, index, at16(stride), at16(type.count));
        place.offset = place.offset ? t.build.result(Operation::IAdd, 1, *place.offset, offset) : offset;
        place.type = type.element;
    }
    t.definePlace(at, place);
}

void load(Meaning& t, const SpirvInstruction& at) {
    const Place& place = t.place(at.operand(0));
    const uint32_t size = t.types[place.type].registers;
    if (place.type != at.type || size == 0)
        refuseDamaged("a variable has another type");
    const bool constant =
        place.storage == spv::StorageClassInput || place.storage == spv::StorageClassUniform;
    if (place.offset)
        t.define(at, t.build.result(Operation::LoadAt, size, place.first, *place.offset));
    else if (constant)
        t.define(at, place.first);
    else
        t.define(at, t.build.result(Operation::Move, size, place.first));
}

void store(Meaning& t, const SpirvInstruction& at) {
    const Place& place = t.place(at.operand(0));
    const Value& value = t.operand(at, 1);
    const uint32_t size = t.size(value);
    if (place.type != value.type || size == 0)
        refuseDamaged("a variable has another type");
    if (place.storage == spv::StorageClassInput || place.storage == spv::StorageClassUniform)
        throw Refusal("writes to an input or a parameter", "write to a variable or an output");
    if (place.offset)
        t.build.emit({Operation::StoreAt, at16(size), place.first, value.first, *place.offset});
    else
        t.build.move(place.first, value.first, size);
}

/// The members of the uniform block.
void declareParameters(Meaning& t, const SpirvInstruction& at, uint32_t type) {
    const SpirvType& block = t.types[type];
    if (block.kind != Kind::Struct || !t.build.program().parameters.empty())
        refuseDamaged("its parameters are no block");
    const uint16_t first = t.build.constant(std::vector<uint32_t>(block.registers, 0));
    for (uint32_t i = 0; i < block.members.size(); ++i) {
        const Kind kind = t.types.scalarKind(block.members[i]);
        const uint32_t size = t.types[block.members[i]].registers;
        if ((kind != Kind::Float && kind != Kind::Int && kind != Kind::Uint) || size > 4)
            throw Refusal("has a parameter of a type that none can have",
                          "use float, int, uint, or a vector of them");
        const auto name = t.module.memberNames.find({type, i});
        using Slot = ParameterSlot::Kind;
        t.build.program().parameters.push_back(
            {name != t.module.memberNames.end() ? name->second : std::to_string(i),
             kind == Kind::Float ? Slot::Float
             : kind == Kind::Int ? Slot::Int
                                 : Slot::Uint,
             at16(first + t.types.offsetOf(type, i)), at16(size)});
    }
    t.definePlace(at, {type, spv::StorageClassUniform, first, std::nullopt});
}

void declarePort(Meaning& t, const SpirvInstruction& at, const Place& place) {
    const auto location = t.module.locations.find(at.result);
    if (location == t.module.locations.end())
        throw Refusal("uses a variable of the graphics pipeline",
                      "use the members of Touch and Surface alone");
    const SpirvType& type = t.types[place.type];
    const bool isInput = place.storage == spv::StorageClassInput;
    if (location->second >= kMaxLocations || type.registers == 0 || type.registers > 4 ||
        type.kind > Kind::Vector || t.types.scalarKind(place.type) != Kind::Float)
        throw Refusal("declares an input or output of its own",
                      "use the members of Touch and Surface, and parameters");
    std::vector<Port>& ports = isInput ? t.build.program().inputs : t.build.program().outputs;
    ports.push_back({at16(location->second), place.first, at16(type.registers)});
}

} // namespace

void declareVariable(Meaning& t, const SpirvInstruction& at) {
    const SpirvType& pointer = t.types[at.type];
    if (pointer.kind != Kind::Pointer || pointer.storage != at.operand(0))
        refuseDamaged("a variable has no place");
    switch (pointer.storage) {
    case spv::StorageClassUniform:
        declareParameters(t, at, pointer.element);
        return;
    case spv::StorageClassInput:
    case spv::StorageClassOutput:
    case spv::StorageClassPrivate:
    case spv::StorageClassFunction:
        break;
    default:
        throw Refusal("uses memory that a program does not have: a texture, a buffer or shared memory",
                      "use the members of Touch, parameters and variables");
    }
    const uint32_t size = t.types[pointer.element].registers;
    if (size == 0)
        refuseDamaged("a variable has no value");
    const Place place{pointer.element, pointer.storage, t.build.allocate(size), std::nullopt};
    if (pointer.storage == spv::StorageClassInput || pointer.storage == spv::StorageClassOutput)
        declarePort(t, at, place);
    else if (at.operands() > 1) {
        const Value& initial = t.operand(at, 1);
        if (initial.type != place.type)
            refuseDamaged("a variable has another type");
        t.build.move(place.first, initial.first, size);
    }
    t.definePlace(at, place);
}

bool translateComposite(Meaning& t, const SpirvInstruction& at) {
    switch (at.code) {
    case spv::OpCompositeConstruct:
        construct(t, at);
        return true;
    case spv::OpCompositeExtract: {
        const Value& whole = t.operand(at, 0);
        const Value part = partAt(t, at, 1, whole.type, whole.first);
        if (part.type != at.type)
            refuseDamaged("a value has wrong parts");
        t.define(at, part.first);
        return true;
    }
    case spv::OpCompositeInsert:
        insert(t, at);
        return true;
    case spv::OpVectorShuffle:
        shuffle(t, at);
        return true;
    case spv::OpVectorExtractDynamic:
    case spv::OpVectorInsertDynamic:
        dynamicComponent(t, at);
        return true;
    case spv::OpCopyObject: {
        const Value& from = t.operand(at, 0);
        if (from.type != at.type)
            refuseDamaged("a copy has another type");
        t.define(at, from.first);
        return true;
    }
    case spv::OpUndef: {
        const uint32_t size = t.types[at.type].registers;
        if (size == 0)
            refuseDamaged("a value has no type");
        t.define(at, t.build.allocate(size)); // zero: nothing writes it
        return true;
    }
    default:
        return false;
    }
}

bool translateMemory(Meaning& t, const SpirvInstruction& at) {
    switch (at.code) {
    case spv::OpVariable: // inside of the entry function
        if (at.operand(0) != spv::StorageClassFunction)
            refuseDamaged("a variable is declared in a wrong place");
        declareVariable(t, at);
        return true;
    case spv::OpAccessChain:
    case spv::OpInBoundsAccessChain:
        accessChain(t, at);
        return true;
    case spv::OpLoad:
        load(t, at);
        return true;
    case spv::OpStore:
        store(t, at);
        return true;
    default:
        return false;
    }
}

} // namespace touchstone::program
