#include "engine/import/program_compiler/endless_loop.h"

#include <glslang/SPIRV/spirv.hpp>

#include <algorithm>
#include <set>
#include <span>
#include <string>

namespace touchstone {

namespace {

constexpr size_t kHeader = 5;

/// Instructions of a module that a compiler has made: their lengths are right.
template <class Each>
void forEach(const std::vector<uint32_t>& module, const Each& each) {
    for (size_t i = kHeader; i < module.size(); i += module[i] >> 16)
        each(module[i] & 0xffffu, std::span(module).subspan(i + 1, (module[i] >> 16) - 1), i);
}

/// The OpString that is `text`; 0: none.
uint32_t stringIn(const std::vector<uint32_t>& module, std::string_view text) {
    uint32_t found = 0;
    forEach(module, [&](uint32_t code, std::span<const uint32_t> words, size_t) {
        if (code == spv::OpString &&
            std::string(reinterpret_cast<const char*>(words.data() + 1)) == std::string(text))
            found = words[0];
    });
    return found;
}

bool writesNothing(const std::vector<uint32_t>& module) {
    bool nothing = true;
    forEach(module, [&](uint32_t code, std::span<const uint32_t>, size_t) {
        nothing = nothing && code != spv::OpStore;
    });
    return nothing;
}

/// Line of the first loop of the program that nothing leaves; 0: none. A condition that is constantly true
/// does not leave.
uint32_t endlessLine(const std::vector<uint32_t>& module, std::string_view file) {
    struct Loop {
        uint32_t merge = 0, line = 0;
    };
    std::vector<Loop> loops;
    std::set<uint32_t> targets, always;
    const uint32_t own = stringIn(module, file);
    uint32_t lineFile = 0, line = 0;
    forEach(module, [&](uint32_t code, std::span<const uint32_t> words, size_t) {
        switch (code) {
        case spv::OpConstantTrue:
            always.insert(words[1]);
            break;
        case spv::OpLine:
            lineFile = words[0];
            line = words[1];
            break;
        case spv::OpNoLine:
            lineFile = 0;
            break;
        case spv::OpLoopMerge:
            if (own != 0 && lineFile == own)
                loops.push_back({words[0], line});
            break;
        case spv::OpBranch:
            targets.insert(words[0]);
            break;
        case spv::OpBranchConditional:
            targets.insert(words[1]);
            if (!always.contains(words[0]))
                targets.insert(words[2]);
            break;
        case spv::OpSwitch:
            targets.insert(words.begin() + 1, words.end()); // labels, and numbers that are too many
            break;
        default:
            break;
        }
    });
    const auto endless =
        std::ranges::find_if(loops, [&](const Loop& loop) { return !targets.contains(loop.merge); });
    return endless != loops.end() ? endless->line : 0;
}

} // namespace

std::vector<uint32_t> withEndlessLoop(std::vector<uint32_t> shortened, const std::vector<uint32_t>& whole,
                                      std::string_view file) {
    const uint32_t line = writesNothing(shortened) ? endlessLine(whole, file) : 0;
    const uint32_t name = stringIn(shortened, file);
    if (line == 0 || name == 0)
        return shortened;
    size_t end = 0;
    forEach(shortened, [&](uint32_t code, std::span<const uint32_t>, size_t at) {
        if (code == spv::OpReturn)
            end = at;
    });
    if (end > 0)
        shortened.insert(shortened.begin() + static_cast<std::ptrdiff_t>(end),
                         {4u << 16 | static_cast<uint32_t>(spv::OpLine), name, line, 0u});
    return shortened;
}

} // namespace touchstone
