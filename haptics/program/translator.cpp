#include "haptics/program/translator.h"

#include "haptics/program/meaning.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <set>

namespace touchstone::program {

namespace {

bool isConstant(uint32_t code) {
    constexpr std::array<uint32_t, 9> kConstants = {
        spv::OpConstantTrue,      spv::OpConstantFalse,     spv::OpConstant,
        spv::OpConstantNull,      spv::OpConstantComposite, spv::OpSpecConstantTrue,
        spv::OpSpecConstantFalse, spv::OpSpecConstant,      spv::OpSpecConstantComposite};
    return std::ranges::find(kConstants, code) != kConstants.end();
}

/// Instructions without an effect on what is computed.
bool isSilent(uint32_t code) {
    constexpr std::array<uint32_t, 24> kSilent = {spv::OpNop,
                                                  spv::OpLine,
                                                  spv::OpNoLine,
                                                  spv::OpSource,
                                                  spv::OpSourceContinued,
                                                  spv::OpSourceExtension,
                                                  spv::OpName,
                                                  spv::OpMemberName,
                                                  spv::OpString,
                                                  spv::OpExtension,
                                                  spv::OpExtInstImport,
                                                  spv::OpMemoryModel,
                                                  spv::OpEntryPoint,
                                                  spv::OpExecutionMode,
                                                  spv::OpCapability,
                                                  spv::OpDecorate,
                                                  spv::OpMemberDecorate,
                                                  spv::OpDecorationGroup,
                                                  spv::OpGroupDecorate,
                                                  spv::OpGroupMemberDecorate,
                                                  spv::OpModuleProcessed,
                                                  spv::OpSelectionMerge,
                                                  spv::OpLoopMerge,
                                                  spv::OpFunctionEnd};
    return std::ranges::find(kSilent, code) != kSilent.end();
}

[[noreturn]] void refuseInstruction(const SpirvInstruction& at) {
    switch (at.code) {
    case spv::OpFunctionCall:
        throw Refusal("calls a function that cannot be inlined", "call no function from itself");
    case spv::OpKill:
    case spv::OpTerminateInvocation:
        throw Refusal("uses discard", "write to the outputs what is to be felt instead");
    case spv::OpSpecConstantOp:
        throw Refusal("computes with a specialisation constant", "declare a parameter instead");
    case spv::OpDPdx:
    case spv::OpDPdy:
    case spv::OpFwidth:
        throw Refusal("uses a derivative of the picture (dFdx, dFdy, fwidth)",
                      "use filterWidth of Touch; the program's own gradients are computed by the hand");
    case spv::OpExtInst:
        throw Refusal("uses a function that programs do not have (number " +
                          std::to_string(at.operands() > 1 ? at.operand(1) : 0) + " of GLSL.std.450)",
                      "use other functions: packing and interpolation are left out");
    default:
        throw Refusal("uses " + opcodeName(at.code) + ", which programs do not have",
                      "use arithmetic, functions of GLSL, conditions and loops");
    }
}

/// Translates the module's declarations and its entry function.
class Translator {
  public:
    explicit Translator(const SpirvModule& module) : module_(module), t_(module) {}

    RegisterProgram translate() {
        const size_t functions = declareValues();
        declareVariables(functions);
        const auto [begin, end] = entryFunction(functions);
        findPhis(begin, end);
        for (size_t i = begin; i < end; ++i)
            located(i, [&](const SpirvInstruction& at) { translate(at, i); });
        return t_.build.finish();
    }

  private:
    /// Runs `work` on instruction i; a refusal names its place.
    template <class Work>
    void located(size_t i, const Work& work) {
        const SpirvInstruction& at = module_.instructions[i];
        try {
            work(at);
        } catch (Refusal& refusal) {
            if (refusal.place.line == 0)
                refusal.place = module_.placeOf(at);
            throw;
        }
    }

    /// Types, constants and parameters, which come first in the registers. Returns the number of the first
    /// function's instruction.
    size_t declareValues() {
        const auto length = [&](uint32_t id) { return t_.constantBits(id).value_or(0); };
        const size_t count = module_.instructions.size();
        size_t functions = count;
        for (size_t i = 0; i < count; ++i)
            located(i, [&](const SpirvInstruction& at) {
                if (at.code == spv::OpFunction)
                    functions = std::min(functions, i);
                if (at.code == spv::OpSwitch)
                    declareCases(at);
                if (i >= functions || t_.types.add(at, length))
                    return;
                if (isConstant(at.code))
                    t_.declareConstant(at);
                else if (at.code == spv::OpVariable && at.operand(0) == spv::StorageClassUniform)
                    declareVariable(t_, at);
                else if (at.code != spv::OpVariable && at.code != spv::OpUndef && !isSilent(at.code))
                    refuseInstruction(at);
            });
        t_.declareNumbers();
        return functions;
    }

    void declareCases(const SpirvInstruction& at) {
        for (size_t k = 2; k + 1 < at.operands(); k += 2)
            if (!cases_.contains(at.operand(k)))
                cases_[at.operand(k)] = t_.build.constant(std::array{at.operand(k)});
    }

    void declareVariables(size_t functions) {
        for (size_t i = 0; i < functions; ++i)
            located(i, [&](const SpirvInstruction& at) {
                if (at.code == spv::OpVariable && at.operand(0) != spv::StorageClassUniform)
                    declareVariable(t_, at);
                else if (at.code == spv::OpUndef)
                    (void)translateComposite(t_, at);
            });
    }

    /// Its instructions after OpFunction, to OpFunctionEnd.
    [[nodiscard]] std::pair<size_t, size_t> entryFunction(size_t functions) const {
        for (size_t i = functions; i < module_.instructions.size(); ++i) {
            const SpirvInstruction& at = module_.instructions[i];
            if (at.code != spv::OpFunction || at.result != module_.entry)
                continue;
            for (size_t end = i + 1; end < module_.instructions.size(); ++end)
                if (module_.instructions[end].code == spv::OpFunctionEnd)
                    return {i + 1, end};
        }
        refuseDamaged("its entry point is missing");
    }

    void findPhis(size_t begin, size_t end) {
        uint32_t block = 0;
        for (size_t i = begin; i < end; ++i) {
            const SpirvInstruction& at = module_.instructions[i];
            if (at.code == spv::OpLabel)
                block = at.result;
            if (at.code != spv::OpPhi)
                continue;
            Phi phi{at.result, {}};
            for (size_t k = 0; k + 1 < at.operands(); k += 2)
                phi.sources.emplace_back(at.operand(k), at.operand(k + 1));
            const uint32_t size = t_.types[at.type].registers;
            if (size == 0)
                refuseDamaged("a value has no type");
            t_.define(at, t_.build.allocate(size));
            phis_[block].push_back(std::move(phi));
        }
    }

    void translate(const SpirvInstruction& at, size_t i) {
        if (isSilent(at.code) || at.code == spv::OpPhi)
            return;
        if (at.code == spv::OpLabel) {
            if (open_)
                refuseDamaged("a block has no end");
            open_ = true;
            block_ = at.result;
            t_.build.beginBlock(block_);
            return;
        }
        if (!open_)
            refuseDamaged("an instruction is in no block");
        if (const SourceLine place = module_.placeOf(at); place.file == kSourceFile)
            t_.build.setLine(place.line);
        if (translateArithmetic(t_, at) || translateComposite(t_, at) || translateMemory(t_, at) ||
            translateExtended(t_, at) || translateMatrix(t_, at))
            return;
        if (!endBlock(at, nextBlock(i)))
            refuseInstruction(at);
        open_ = false;
    }

    /// The block that follows instruction i at once; 0 without one.
    [[nodiscard]] uint32_t nextBlock(size_t i) const {
        for (++i; i < module_.instructions.size(); ++i) {
            const SpirvInstruction& at = module_.instructions[i];
            if (at.code == spv::OpLabel)
                return at.result;
            if (at.code != spv::OpLine && at.code != spv::OpNoLine)
                break;
        }
        return 0;
    }

    bool endBlock(const SpirvInstruction& at, uint32_t next) {
        switch (at.code) {
        case spv::OpReturn:
            t_.build.emit({Operation::Return});
            return true;
        case spv::OpUnreachable:
            t_.build.emit({Operation::Unreachable});
            return true;
        case spv::OpBranch:
            goTo(at.operand(0), next);
            return true;
        case spv::OpBranchConditional:
            branch(at, next);
            return true;
        case spv::OpSwitch:
            choose(at, next);
            return true;
        default:
            return false;
        }
    }

    /// The values that `target` takes from here, and a jump where it does not follow at once.
    void goTo(uint32_t target, uint32_t next) {
        copyPhis(target);
        if (target != next)
            t_.build.jump(Operation::Jump, target);
    }

    void branch(const SpirvInstruction& at, uint32_t next) {
        const uint16_t condition = t_.operand(at, 0, SpirvType::Kind::Bool, 1);
        const uint32_t yes = at.operand(1), no = at.operand(2);
        if (!phis_.contains(no)) {
            t_.build.jump(Operation::JumpUnless, no, condition);
            goTo(yes, next);
            return;
        }
        const size_t otherwise = t_.build.openJump(Operation::JumpUnless, condition);
        goTo(yes, 0);
        t_.build.land(otherwise);
        goTo(no, next);
    }

    void choose(const SpirvInstruction& at, uint32_t next) {
        const uint16_t selector = t_.operand(at, 0, SpirvType::Kind::Int, 1);
        std::vector<std::pair<size_t, uint32_t>> stubs;
        std::set<uint32_t> seen;
        for (size_t k = 2; k + 1 < at.operands(); k += 2) {
            if (!seen.insert(at.operand(k)).second)
                refuseDamaged("a switch has a case twice");
            const uint16_t wanted = cases_.at(at.operand(k));
            const uint32_t target = at.operand(k + 1);
            if (phis_.contains(target))
                stubs.emplace_back(t_.build.openJump(Operation::JumpIfEqual, selector, wanted), target);
            else
                t_.build.jump(Operation::JumpIfEqual, target, selector, wanted);
        }
        goTo(at.operand(1), stubs.empty() ? next : 0);
        for (const auto& [jump, target] : stubs) {
            t_.build.land(jump);
            goTo(target, 0);
        }
    }

    /// All at once: a value may be another's source.
    void copyPhis(uint32_t target) {
        const auto found = phis_.find(target);
        if (found == phis_.end())
            return;
        struct Copy {
            uint16_t to, from;
            uint32_t count;
        };
        std::vector<Copy> copies;
        bool overlap = false;
        for (const Phi& phi : found->second) {
            const auto source =
                std::ranges::find(phi.sources, block_, &std::pair<uint32_t, uint32_t>::second);
            if (source == phi.sources.end())
                refuseDamaged("a block has no value for the next one");
            const Value &to = t_.value(phi.result), &from = t_.value(source->first);
            if (to.type != from.type)
                refuseDamaged("a value has another type");
            if (to.first == from.first)
                continue; // keeps its value
            const uint32_t count = t_.size(to);
            for (const Copy& before : copies)
                overlap |= from.first < before.to + before.count && before.to < from.first + count;
            copies.push_back({to.first, from.first, count});
        }
        if (overlap)
            for (Copy& copy : copies)
                copy.from = t_.build.result(Operation::Move, copy.count, copy.from);
        for (const Copy& copy : copies)
            t_.build.move(copy.to, copy.from, copy.count);
    }

    const SpirvModule& module_;
    Meaning t_;
    std::map<uint32_t, std::vector<Phi>> phis_; ///< by block
    std::map<uint32_t, uint16_t> cases_;        ///< registers of the numbers of switches
    uint32_t block_ = 0;
    bool open_ = false;
};

} // namespace

Translation translateSpirv(std::span<const uint32_t> words) {
    Translation translation;
    try {
        const SpirvModule module = readSpirv(words);
        translation.program = Translator(module).translate();
    } catch (const Refusal& refusal) {
        translation.problem = TranslationProblem{refusal.place, refusal.what(), refusal.remedy};
    }
    return translation;
}

} // namespace touchstone::program
