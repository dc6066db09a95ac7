#include "engine/program/program_compiler.h"

#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/process/helper_program.h"
#include "engine/process/process_answer.h"
#include "engine/program/spirv_reader.h"

#include <signal.h>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cstring>
#include <string_view>
#include <system_error>

namespace touchstone {

namespace {

// What the compiler calls the declarations made of the user's source, and what runs it.
using program::kSourceFile;
constexpr std::string_view kParameters = "parameters", kEntryFile = "entry.glsl";
constexpr uint64_t kMaxSpirvBytes = uint64_t{4} << 20;
constexpr const char* kShorten = "shorten the program; look for what the compiler has to expand";

std::string printable(std::string_view text) {
    constexpr size_t kLongest = 300;
    std::string line(text.substr(0, std::min(text.find('\n'), kLongest)));
    std::ranges::replace_if(
        line, [](char c) { return c < ' ' || c > '~'; }, ' ');
    return line;
}

std::string remedyFor(std::string_view message) {
    const auto has = [&](std::string_view part) { return message.find(part) != std::string_view::npos; };
    if (has("#include"))
        return "leave it out: the interface and the library are there by themselves";
    if (has("undeclared identifier") || has("no matching overloaded function") || has("no such field"))
        return "see docs/programs.md for what a program gets and which functions there are";
    if (has("ecursi"))
        return "write a loop instead";
    return "correct the line: a program is GLSL 4.50 (docs/programs.md)";
}

/// "f(f1; calling g(f1;" of a message about recursion, which has no line: that where the first of them
/// begins.
[[noreturn]] void failOfRecursion(const ProgramSource& source, std::string_view log) {
    const auto nameBefore = [&](size_t end) {
        const size_t begin = log.find_last_of(" \t\n", end);
        return std::string(log.substr(begin + 1, end - begin - 1));
    };
    constexpr std::string_view kCalling = " calling ";
    const size_t calling = log.find(kCalling);
    const size_t first = calling == std::string_view::npos ? calling : log.rfind('(', calling);
    const size_t second = calling == std::string_view::npos ? calling : log.find('(', calling);
    if (first == std::string_view::npos || second == std::string_view::npos)
        throw Error(source.name, "", "calls a function from itself", remedyFor("recursion"));
    const std::string caller = nameBefore(first), callee = nameBefore(second);
    const auto isName = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
    const std::string code = withoutComments(source.text);
    std::string place;
    for (size_t at = code.find(caller); at != std::string::npos && place.empty();
         at = code.find(caller, at + 1)) {
        const size_t end = code.find_first_not_of(" \t\n", at + caller.size());
        if ((at == 0 || !isName(code[at - 1])) && end != std::string::npos && code[end] == '(')
            place = "line " + std::to_string(lineAt(code, at));
    }
    throw Error(source.name, place,
                "'" + caller + "' calls '" + callee + "', which comes back to it: recursion",
                remedyFor("recursion"));
}

/// The first message of the compiler: "ERROR: FILE:LINE: TEXT", or without a place.
[[noreturn]] void failOf(const ProgramSource& source, std::string_view log) {
    constexpr std::string_view kError = "ERROR: ";
    const size_t start = log.find(kError);
    if (start == std::string_view::npos)
        throw Error(source.name, "", "cannot be compiled: " + printable(log), remedyFor(log));
    log.remove_prefix(start + kError.size());
    if (log.substr(0, log.find('\n')).find("Recursion detected") != std::string_view::npos)
        failOfRecursion(source, log);
    const size_t colon = log.find(':');
    uint32_t line = 0;
    if (colon != std::string_view::npos) {
        const char* const digits = log.data() + colon + 1;
        const auto [end, problem] = std::from_chars(digits, log.data() + log.size(), line);
        if (problem == std::errc() && end < log.data() + log.size() && *end == ':') {
            const std::string file(log.substr(0, colon));
            const std::string_view text = log.substr(static_cast<size_t>(end - log.data()) + 1);
            if (file == kEntryFile)
                throw Error(source.name, "", "has no function 'touch' that can be called: " + printable(text),
                            "write: void touch(const in Touch before, inout Surface after) { ... }");
            const size_t first = std::min(text.find_first_not_of(' '), text.size());
            throw Error(source.name, placeInSource(source, file, line), printable(text.substr(first)),
                        remedyFor(text));
        }
    }
    throw Error(source.name, "", printable(log), remedyFor(log));
}

[[noreturn]] void failOf(const ProgramSource& source, const ProcessAnswer& answer,
                         const PreparedProgram& compiler) {
    using enum ProcessAnswer::End;
    switch (answer.end) {
    case Exited:
        if (answer.status == 1)
            failOf(source, std::string_view(reinterpret_cast<const char*>(answer.output.data()),
                                            answer.output.size()));
        throw Error(source.name, "", "the compiler ended on it with status " + std::to_string(answer.status),
                    kShorten);
    case Killed:
        if (answer.status == SIGXCPU)
            throw Error(source.name, "",
                        "compiling it took more than " + std::to_string(compiler.limits().processorSeconds) +
                            " s",
                        kShorten);
        throw Error(source.name, "",
                    "the compiler crashed on it (signal " + std::to_string(answer.status) + ")", kShorten);
    case TooSlow:
        throw Error(source.name, "",
                    "compiling it took longer than " + std::to_string(compiler.limits().seconds) + " s",
                    kShorten);
    case TooLong:
        throw Error(source.name, "", "it becomes too long when its functions are inlined", kShorten);
    case Stopped:
        throw Cancelled();
    case NotStarted:
        break;
    }
    throw Error(source.name, "", "the compiler of programs cannot be started: " + compiler.program().string(),
                "build it (ninja touchstone_program_compiler) and leave it beside touchstone");
}

} // namespace

PreparedProgram& installedProgramCompiler() {
    // Never destroyed: a thread may still ask while the process ends, and the program ends with that.
    static PreparedProgram& compiler = *[] {
        ProcessLimits limits;
        limits.processorSeconds = 5;
        limits.seconds = 30;
        limits.memory = std::max(kMaxMemory / 2, uint64_t{1} << 30);
        limits.fileSize = 0;
        limits.openFiles = 16;
        return new PreparedProgram(helperProgram("touchstone_program_compiler"), limits);
    }();
    return compiler;
}

std::string placeInSource(const ProgramSource& source, const std::string& file, uint32_t line) {
    if (file == kParameters && line >= 2 && line - 2 < source.parameters.size())
        line = source.parameters[line - 2].line;
    else if (file != kSourceFile)
        return "";
    return line > 0 ? "line " + std::to_string(line) : "";
}

std::vector<uint32_t> compileProgram(const ProgramSource& source, PreparedProgram& compiler,
                                     const std::function<bool()>& stop) {
    std::vector<uint8_t> bytes;
    for (const std::string& text :
         {std::string(kSourceFile), declarationOf(source.parameters), source.text}) {
        bytes.insert(bytes.end(), text.begin(), text.end());
        bytes.push_back(0);
    }
    const ProcessAnswer answer = compiler.ask(memoryFile(bytes), kMaxSpirvBytes, stop);
    if (answer.end != ProcessAnswer::End::Exited || answer.status != 0)
        failOf(source, answer, compiler);
    std::vector<uint32_t> words(answer.output.size() / 4);
    std::memcpy(words.data(), answer.output.data(), 4 * words.size());
    return words;
}

} // namespace touchstone
