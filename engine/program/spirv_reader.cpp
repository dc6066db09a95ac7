#include "engine/program/spirv_reader.h"

#include <algorithm>
#include <string_view>

#define SPV_ENABLE_UTILITY_CODE
#include <glslang/SPIRV/spirv.hpp>

namespace touchstone::program {

namespace {

constexpr size_t kHeader = 5;
constexpr const char* kDamaged = "compile the source again";

/// A literal string: bytes in words, the lowest first, ended by a zero.
std::string textOf(std::span<const uint32_t> words) {
    constexpr size_t kLongest = 4096;
    std::string text;
    for (const uint32_t word : words)
        for (unsigned shift = 0; shift < 32; shift += 8) {
            const char c = static_cast<char>(word >> shift & 0xffu);
            if (c == '\0' || text.size() == kLongest)
                return text;
            text += c;
        }
    return text;
}

/// The reader's state while it goes through the instructions.
class Reader {
  public:
    explicit Reader(std::span<const uint32_t> words) : words_(words) {}

    SpirvModule read() {
        if (words_.size() < kHeader || words_[0] != spv::MagicNumber)
            throw Refusal("is no SPIR-V module", kDamaged);
        if (words_.size() > kMaxSpirvWords)
            throw Refusal("has " + std::to_string(words_.size()) + " words of SPIR-V, more than " +
                              std::to_string(kMaxSpirvWords),
                          "shorten the program");
        module_.bound = words_[3];
        if (module_.bound == 0 || module_.bound > kMaxSpirvIds)
            throw Refusal("has more than " + std::to_string(kMaxSpirvIds) + " values", "shorten the program");
        for (size_t i = kHeader; i < words_.size();) {
            const size_t count = words_[i] >> 16;
            if (count == 0 || count > words_.size() - i)
                throw Refusal("is a damaged SPIR-V module", kDamaged);
            add(words_[i] & 0xffffu, words_.subspan(i + 1, count - 1));
            i += count;
        }
        if (module_.entry == 0)
            throw Refusal("has no entry point", "compile the source again");
        return std::move(module_);
    }

  private:
    void add(uint32_t code, std::span<const uint32_t> words) {
        SpirvInstruction at{.code = code, .words = words, .operands_ = words};
        bool hasResult = false, hasType = false;
        spv::HasResultAndType(static_cast<spv::Op>(code), &hasResult, &hasType);
        const size_t taken = (hasResult ? 1u : 0u) + (hasType ? 1u : 0u);
        if (words.size() < taken)
            throw Refusal("is a damaged SPIR-V module", kDamaged);
        if (hasType)
            at.type = id(words[0]);
        if (hasResult)
            at.result = id(words[taken - 1]);
        at.operands_ = words.subspan(taken);
        at.fileId = file_;
        at.line = line_;
        note(at);
        module_.instructions.push_back(at);
    }

    void note(const SpirvInstruction& at) {
        switch (at.code) {
        case spv::OpLine:
            file_ = at.operand(0);
            line_ = at.operand(1);
            break;
        case spv::OpNoLine:
            file_ = line_ = 0;
            break;
        case spv::OpString:
            module_.strings[at.result] = textOf(at.operands_);
            break;
        case spv::OpName:
            module_.names[at.operand(0)] = textOf(at.operandsFrom(1));
            break;
        case spv::OpMemberName:
            module_.memberNames[{at.operand(0), at.operand(1)}] = textOf(at.operandsFrom(2));
            break;
        case spv::OpDecorate:
            if (at.operand(1) == spv::DecorationLocation)
                module_.locations[at.operand(0)] = at.operand(2);
            break;
        case spv::OpExtInstImport:
            if (textOf(at.operands_) != "GLSL.std.450")
                throw Refusal("uses the instructions of \"" + textOf(at.operands_) + "\"",
                              "use functions of GLSL alone");
            module_.extended = at.result;
            break;
        case spv::OpEntryPoint:
            if (module_.entry != 0)
                throw Refusal("has several entry points", "compile the source again");
            module_.entry = id(at.operand(1));
            break;
        default:
            break;
        }
    }

    [[nodiscard]] uint32_t id(uint32_t value) const {
        if (value == 0 || value >= module_.bound)
            throw Refusal("is a damaged SPIR-V module", kDamaged);
        return value;
    }

    std::span<const uint32_t> words_;
    SpirvModule module_;
    uint32_t file_ = 0, line_ = 0;
};

} // namespace

uint32_t SpirvInstruction::operand(size_t i) const {
    if (i >= operands_.size())
        throw Refusal("is a damaged SPIR-V module", kDamaged);
    return operands_[i];
}

std::span<const uint32_t> SpirvInstruction::operandsFrom(size_t i) const {
    if (i > operands_.size())
        throw Refusal("is a damaged SPIR-V module", kDamaged);
    return operands_.subspan(i);
}

SourceLine SpirvModule::placeOf(const SpirvInstruction& at) const {
    const auto file = strings.find(at.fileId);
    return {file != strings.end() ? file->second : "", at.line};
}

SpirvModule readSpirv(std::span<const uint32_t> words) {
    return Reader(words).read();
}

std::string opcodeName(uint32_t code) {
    return "SPIR-V instruction " + std::to_string(code);
}

} // namespace touchstone::program
