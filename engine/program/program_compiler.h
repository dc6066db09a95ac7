#pragma once
// GLSL to SPIR-V, by a process of its own.

#include "engine/process/process_answer.h"
#include "engine/program/program_source.h"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace touchstone {

/// Which program compiles, within which limits.
struct ProgramCompiler {
    std::filesystem::path program;
    ProcessLimits limits;
};

/// touchstone_program_compiler beside the running program: at most 5 s of a processor, 1 GiB, and no file.
[[nodiscard]] ProgramCompiler installedProgramCompiler();

/// Compilers that have started before there is anything to compile: nine tenths of their time go by with what
/// is the same for each program. One thread.
class WaitingCompiler {
  public:
    explicit WaitingCompiler(ProgramCompiler compiler) : compiler_(std::move(compiler)) {}

    /// Starts one where fewer than `wanted` wait.
    void start(size_t wanted = 1);
    /// The one that has waited longest, which waits no more; null: none.
    [[nodiscard]] std::unique_ptr<WaitingProcess> take();

  private:
    ProgramCompiler compiler_;
    std::vector<std::unique_ptr<WaitingProcess>> processes_; ///< the oldest first
};

/// SPIR-V with one function, whose uniform block has the source's parameters. Throws Error with the line and
/// a remedy, also where the compiler crashes on the source; Cancelled. `stop` is asked every 20 ms. Any
/// thread but the servo. `waiting`: one of `compiler` that may have started; null: none.
[[nodiscard]] std::vector<uint32_t> compileProgram(const ProgramSource& source,
                                                   const ProgramCompiler& compiler,
                                                   const std::function<bool()>& stop,
                                                   WaitingCompiler* waiting = nullptr);

/// "line 12" of the source for a place that the compiler names: a file of its own and a line; empty where the
/// source has no such line.
[[nodiscard]] std::string placeInSource(const ProgramSource& source, const std::string& file, uint32_t line);

} // namespace touchstone
