#include "renderer/program/link_program.h"

#include "renderer/program/program_body.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <bit>
#include <cstring>

namespace touchstone::program {

namespace {

bool isConstant(uint32_t code) {
    return code == spv::OpConstantTrue || code == spv::OpConstantFalse || code == spv::OpConstant ||
           code == spv::OpConstantComposite || code == spv::OpConstantNull;
}

/// Declarations of the program into the shader, then its function.
class Linker {
  public:
    Linker(std::span<const uint32_t> host, std::span<const uint32_t> program, uint32_t set)
        : program_(readSpirv(program)), out_(host),
          body_(program_, out_, out_.named("touchstone_failed"), kEyeBudget), set_(set) {}

    Words link() {
        const std::vector<SpirvInstruction>& all = program_.instructions;
        const auto isFunction = [](const SpirvInstruction& at) { return at.code == spv::OpFunction; };
        const auto declared = std::ranges::find_if(all, isFunction);
        for (auto at = all.begin(); at != declared; ++at)
            declare(*at);
        for (auto at = declared; at != all.end(); ++at) {
            if (!isFunction(*at) || at->result != program_.entry)
                continue;
            const auto end =
                std::ranges::find(at, all.end(), uint32_t{spv::OpFunctionEnd}, &SpirvInstruction::code);
            const auto number = [&](auto place) { return static_cast<size_t>(place - all.begin()); };
            const Words body = body_.write(number(at) + 1, number(end));
            return out_.finish(out_.named("touchstone_run("), body);
        }
        refuseToShow("its function is missing");
    }

  private:
    void declare(const SpirvInstruction& at) {
        switch (at.code) {
        case spv::OpCapability:
            if (at.operand(0) != spv::CapabilityShader && at.operand(0) != spv::CapabilityMatrix)
                refuseToShow("it needs another kind of device");
            return;
        case spv::OpExtInstImport:
            return body_.map(at.result, out_.extended());
        case spv::OpTypeVoid:
        case spv::OpTypeBool:
        case spv::OpTypeInt:
        case spv::OpTypeFloat:
        case spv::OpTypeVector:
        case spv::OpTypeMatrix:
        case spv::OpTypeFunction:
            return body_.map(at.result, out_.type(at.code, body_.operandsOf(at)));
        case spv::OpTypePointer:
            return body_.map(at.result,
                             out_.type(at.code, {storageOf(at.operand(0)), body_.id(at.operand(1))}));
        case spv::OpTypeStruct:
        case spv::OpTypeArray:
            return copyType(at);
        case spv::OpMemberDecorate:
            if (at.operand(2) == spv::DecorationOffset)
                emit(out_.decorations, at.code,
                     {body_.id(at.operand(0)), at.operand(1), at.operand(2), at.operand(3)});
            return;
        case spv::OpDecorate:
            if (at.operand(1) == spv::DecorationBlock)
                emit(out_.decorations, at.code, {body_.id(at.operand(0)), at.operand(1)});
            return;
        case spv::OpVariable:
            return variable(at);
        case spv::OpUndef:
            return body_.map(at.result, out_.null(body_.id(at.type)));
        default:
            if (isConstant(at.code))
                constant(at);
            else if (at.type != 0 || (at.code >= spv::OpTypeVoid && at.code <= spv::OpTypeForwardPointer))
                refuseToShow("it uses SPIR-V instruction " + std::to_string(at.code));
            return; // names and lines
        }
    }

    /// Inputs and outputs are variables of the shader.
    static uint32_t storageOf(uint32_t storage) {
        return storage == spv::StorageClassInput || storage == spv::StorageClassOutput
                   ? uint32_t{spv::StorageClassPrivate}
                   : storage;
    }

    void copyType(const SpirvInstruction& at) {
        Words operands{body_.id(at.result)};
        for (const uint32_t operand : body_.operandsOf(at))
            operands.push_back(operand);
        emit(out_.globals, at.code, operands);
    }

    void constant(const SpirvInstruction& at) {
        Words operands{body_.id(at.type), body_.id(at.result)};
        for (const uint32_t operand : body_.operandsOf(at))
            operands.push_back(operand);
        emit(out_.globals, at.code, operands);
    }

    void variable(const SpirvInstruction& at) {
        const uint32_t type = body_.id(at.type), result = body_.id(at.result), storage = at.operand(0);
        if (storage == spv::StorageClassInput || storage == spv::StorageClassOutput) {
            const auto name = program_.names.find(at.result);
            if (name == program_.names.end())
                refuseToShow("an input has no name");
            const uint32_t known = out_.named(name->second);
            if (out_.typeOfVariable(known) != type)
                refuseToShow("'" + name->second + "' has another type");
            return body_.map(at.result, known);
        }
        if (storage == spv::StorageClassPrivate) {
            const uint32_t first = at.operands() > 1 ? body_.id(at.operand(1))
                                                     : out_.null(body_.id(body_.made(at.type).operand(1)));
            emit(out_.globals, at.code, {type, result, storage, first});
        } else if (storage == spv::StorageClassUniform) {
            emit(out_.globals, at.code, {type, result, storage});
            emit(out_.decorations, spv::OpDecorate, {result, spv::DecorationDescriptorSet, set_});
            emit(out_.decorations, spv::OpDecorate, {result, spv::DecorationBinding, 0});
        } else {
            refuseToShow("it uses memory that programs do not have");
        }
        out_.interface.push_back(result);
    }

    const SpirvModule program_;
    ShaderWriter out_;
    ProgramBody body_;
    uint32_t set_ = 0;
};

} // namespace

LinkedProgram linkProgram(std::span<const uint32_t> host, std::span<const uint32_t> program, uint32_t set) {
    try {
        return {Linker(host, program, set).link(), ""};
    } catch (const Refusal& refusal) {
        return {{}, refusal.what()};
    }
}

std::vector<std::byte> parameterBlock(std::span<const uint32_t> program,
                                      std::span<const ProgramParameter> parameters,
                                      std::span<const std::array<double, 4>> values) {
    const SpirvModule module = readSpirv(program);
    std::vector<std::byte> block;
    for (const SpirvInstruction& at : module.instructions) {
        if (at.code != spv::OpMemberDecorate || at.operand(2) != spv::DecorationOffset)
            continue;
        const auto name = module.memberNames.find({at.operand(0), at.operand(1)});
        const auto parameter = name == module.memberNames.end()
                                   ? parameters.end()
                                   : std::ranges::find(parameters, name->second, &ProgramParameter::name);
        const size_t offset = at.operand(3);
        if (parameter == parameters.end() || offset > 16 * kMaxProgramParameters)
            continue;
        const auto number = static_cast<size_t>(parameter - parameters.begin());
        block.resize(std::max(block.size(), (offset / 16 + 1) * 16));
        for (size_t i = 0;
             i < parameter->components && number < values.size() && offset + 4 * i + 4 <= block.size(); ++i) {
            const double value = values[number][i];
            const uint32_t bits = parameter->kind == ProgramParameter::Kind::Float
                                      ? std::bit_cast<uint32_t>(static_cast<float>(value))
                                      : static_cast<uint32_t>(static_cast<int64_t>(value));
            std::memcpy(&block[offset + 4 * i], &bits, 4);
        }
    }
    return block;
}

} // namespace touchstone::program
