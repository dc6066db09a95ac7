#include "renderer/program/shader_writer.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>

namespace touchstone::program {

namespace {

constexpr size_t kHeader = 5, kBound = 3;

[[noreturn]] void refuseHost(const std::string& what) {
    throw Refusal("cannot be linked: " + what, "build the program again");
}

bool isSharedType(uint32_t code) {
    return code == spv::OpTypeVoid || code == spv::OpTypeBool || code == spv::OpTypeInt ||
           code == spv::OpTypeFloat || code == spv::OpTypeVector || code == spv::OpTypeMatrix ||
           code == spv::OpTypePointer || code == spv::OpTypeFunction;
}

bool beforeGlobals(uint32_t code) {
    return code < spv::OpTypeVoid || (code >= spv::OpDecorate && code <= spv::OpGroupMemberDecorate) ||
           code == spv::OpModuleProcessed || code == spv::OpExecutionModeId || code == spv::OpDecorateId ||
           code == spv::OpDecorateString || code == spv::OpMemberDecorateString;
}

Words keyOf(uint32_t code, std::span<const uint32_t> operands) {
    Words key{code};
    key.insert(key.end(), operands.begin(), operands.end());
    return key;
}

} // namespace

void emit(Words& to, uint32_t code, std::span<const uint32_t> operands) {
    to.push_back(static_cast<uint32_t>(operands.size() + 1) << 16 | code);
    to.insert(to.end(), operands.begin(), operands.end());
}

ShaderWriter::ShaderWriter(std::span<const uint32_t> host)
    : words_(host), host_(readSpirv(host)), bound_(host_.bound) {
    for (const SpirvInstruction& at : host_.instructions)
        if (isSharedType(at.code))
            types_.emplace(keyOf(at.code, at.operands_), at.result);
}

uint32_t ShaderWriter::named(const std::string& name) const {
    for (const auto& [id, its] : host_.names)
        if (its == name)
            return id;
    refuseHost("the shader has no " + name);
}

uint32_t ShaderWriter::typeOfVariable(uint32_t id) const {
    const auto found = std::ranges::find_if(host_.instructions, [&](const SpirvInstruction& at) {
        return at.code == spv::OpVariable && at.result == id;
    });
    return found != host_.instructions.end() ? found->type : 0;
}

uint32_t ShaderWriter::type(uint32_t code, std::span<const uint32_t> operands) {
    const auto [found, added] = types_.emplace(keyOf(code, operands), bound_);
    if (added) {
        Words all{newId()};
        all.insert(all.end(), operands.begin(), operands.end());
        emit(globals, code, all);
    }
    return found->second;
}

uint32_t ShaderWriter::boolType(uint32_t components) {
    const uint32_t scalar = type(spv::OpTypeBool, {});
    return components == 1 ? scalar : type(spv::OpTypeVector, {scalar, components});
}

uint32_t ShaderWriter::uintType() {
    return type(spv::OpTypeInt, {32u, 0u});
}

uint32_t ShaderWriter::constant(uint32_t type, uint32_t element, uint32_t components, uint32_t bits) {
    if (components > 1) {
        const uint32_t scalar = constant(element, element, 1, bits);
        Words key{spv::OpConstantComposite, type};
        key.insert(key.end(), components, scalar);
        const auto [found, added] = constants_.emplace(key, bound_);
        if (added) {
            Words operands{type, newId()};
            operands.insert(operands.end(), components, scalar);
            emit(globals, spv::OpConstantComposite, operands);
        }
        return found->second;
    }
    const auto [found, added] = constants_.emplace(Words{spv::OpConstant, type, bits}, bound_);
    if (added)
        emit(globals, spv::OpConstant, {type, newId(), bits});
    return found->second;
}

uint32_t ShaderWriter::null(uint32_t type) {
    const auto [found, added] = constants_.emplace(Words{spv::OpConstantNull, type}, bound_);
    if (added)
        emit(globals, spv::OpConstantNull, {type, newId()});
    return found->second;
}

uint32_t ShaderWriter::trueConstant() {
    const uint32_t scalar = boolType(1);
    const auto [found, added] = constants_.emplace(Words{spv::OpConstantTrue, scalar}, bound_);
    if (added)
        emit(globals, spv::OpConstantTrue, {scalar, newId()});
    return found->second;
}

Words ShaderWriter::finish(uint32_t function, const Words& body) const {
    Words out(words_.begin(), words_.begin() + kHeader);
    out[kBound] = bound_;
    bool decorated = false, global = false, replaces = false, replaced = false;
    for (const SpirvInstruction& at : host_.instructions) {
        if (!decorated && !beforeGlobals(at.code)) {
            out.insert(out.end(), decorations.begin(), decorations.end());
            decorated = true;
        }
        if (!global && at.code == spv::OpFunction) {
            out.insert(out.end(), globals.begin(), globals.end());
            global = true;
        }
        if (replaces && at.code == spv::OpFunctionEnd) {
            out.insert(out.end(), body.begin(), body.end());
            replaces = false;
        }
        if (replaces)
            continue;
        Words operands(at.words.begin(), at.words.end());
        if (at.code == spv::OpEntryPoint)
            operands.insert(operands.end(), interface.begin(), interface.end());
        emit(out, at.code, operands);
        if (at.code == spv::OpFunction && at.result == function)
            replaces = replaced = true;
    }
    if (!replaced)
        refuseHost("the shader calls no program");
    return out;
}

} // namespace touchstone::program
