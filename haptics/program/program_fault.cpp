#include "haptics/program/program_fault.h"

#include "engine/program/program_source.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <set>
#include <string_view>
#include <vector>

namespace touchstone::program {

namespace {

/// Members of Surface by location and component (shaders/material/interface.glsl).
constexpr std::array<std::array<const char*, 4>, 6> kOutputs = {
    {{"position", "position", "position", ""},
     {"normal", "normal", "normal", ""},
     {"force", "force", "force", ""},
     {"staticFriction", "dynamicFriction", "stiffness", "damping"},
     {"colour", "colour", "colour", "roughness"},
     {"persistentChange", "brush", "", ""}}};

const char* outputAt(const RegisterProgram& program, size_t at) {
    for (const Port& port : program.outputs)
        if (at >= port.first && at < size_t{port.first} + port.count && port.location < kOutputs.size())
            return kOutputs[port.location][at - port.first];
    return "";
}

bool writes(const Instruction& at, size_t to) {
    switch (at.operation) {
    case Operation::Jump:
    case Operation::JumpUnless:
    case Operation::JumpIfEqual:
    case Operation::Return:
    case Operation::Unreachable:
        return false;
    default:
        return to >= at.to && to < size_t{at.to} + at.count;
    }
}

/// Where the value of a register comes from.
struct Origin {
    bool written = false;
    std::set<uint32_t> lines; ///< of what computes it; none of a constant or an input
};

/// Through copies, whichever way the run took: at the end of a condition there is one for each branch. A
/// finite constant and an input are no origin of what is not finite.
Origin originOf(const RegisterProgram& program, size_t output) {
    Origin origin;
    std::vector<size_t> open{output};
    std::set<size_t> seen{output};
    while (!open.empty()) {
        const size_t to = open.back();
        open.pop_back();
        for (size_t i = 0; i < program.instructions.size(); ++i) {
            const Instruction& at = program.instructions[i];
            if (!writes(at, to))
                continue;
            origin.written = true;
            if (at.operation != Operation::Move)
                origin.lines.insert(program.lines[i]);
            else if (const size_t from = at.a + (to - at.to); seen.insert(from).second)
                open.push_back(from);
        }
    }
    origin.lines.erase(0);
    return origin;
}

/// True where an assignment follows: "=", also after an operator, but no comparison; past a swizzle or an
/// index.
bool isAssigned(std::string_view after) {
    const auto skip = [&](std::string_view set) {
        after.remove_prefix(std::min(after.find_first_not_of(set), after.size()));
    };
    if (after.starts_with('.'))
        skip(".xyzwrgba");
    if (after.starts_with('['))
        after.remove_prefix(std::min(after.find(']'), after.size() - 1) + 1);
    skip(" \t");
    if (after.size() > 1 && std::string_view("+-*/").find(after[0]) != std::string_view::npos)
        after.remove_prefix(1);
    return after.starts_with('=') && !after.starts_with("==");
}

/// The last line that assigns to a member of this name; 0: none.
uint32_t assignmentIn(std::string_view text, const std::string& member) {
    const std::string code = withoutComments(text);
    const std::string name = "." + member;
    uint32_t found = 0;
    for (size_t at = code.find(name); at != std::string::npos; at = code.find(name, at + 1))
        if (isAssigned(std::string_view(code).substr(at + name.size())))
            found = lineAt(code, at);
    return found;
}

std::string listOf(const std::set<uint32_t>& lines) {
    std::string list;
    for (const uint32_t line : lines)
        list += (list.empty() ? "" : ", ") + std::to_string(line);
    return list;
}

ProgramFault notFinite(const RegisterProgram& code, std::string_view source, uint16_t at) {
    if (at == ProgramEnd::kForce)
        return {0, "its outputs make a force that is infinite or no number; keep them smaller"};
    const std::string member = outputAt(code, at);
    const Origin origin = originOf(code, at);
    if (!origin.written)
        return {code.lines.empty() ? 0 : code.lines.front(),
                "never ends, so that 'after' is never written; give the loop a condition that becomes false"};
    ProgramFault fault{0, "after." + member + ", or its gradient, is infinite or no number"};
    if (!origin.lines.empty())
        fault.line = *origin.lines.begin();
    else // a constant has no line
        fault.line = assignmentIn(source, member);
    if (origin.lines.size() > 1)
        fault.problem += ", by one of the lines " + listOf(origin.lines);
    fault.problem += "; keep away from divisions by 0, roots and logarithms of negative numbers, and 1e38";
    return fault;
}

} // namespace

ProgramFault faultOf(const FeltProgram& program, const ProgramEnd& end) {
    return faultOf(program.code, program.compiled != nullptr ? program.compiled->text : "", end);
}

ProgramFault faultOf(const RegisterProgram& code, std::string_view source, const ProgramEnd& end) {
    const uint32_t line = end.at < code.lines.size() ? code.lines[end.at] : 0;
    switch (end.ending) {
    case Ending::Finished:
        return {};
    case Ending::BudgetReached:
        return {line, "takes longer than a tick allows, and was ended here; let the loop end sooner"};
    case Ending::BadIndex:
        return {line, "an index is outside of its array; clamp it"};
    case Ending::DivisionByZero:
        return {line, "an integer is divided by 0; check the divisor before"};
    case Ending::Unreachable:
        return {line, "never ends; give the loop a condition that becomes false"};
    case Ending::NotFinite:
        return notFinite(code, source, end.at);
    }
    return {};
}

std::string textOf(const ProgramFault& fault) {
    if (fault.problem.empty())
        return {};
    return (fault.line > 0 ? "line " + std::to_string(fault.line) + ": " : "") + fault.problem;
}

} // namespace touchstone::program
