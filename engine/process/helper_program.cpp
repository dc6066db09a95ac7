#include "engine/process/helper_program.h"

#include <dlfcn.h>

#include <array>
#include <span>
#include <system_error>

namespace touchstone {

namespace {

/// The folder of the program or shared library that holds this function.
std::filesystem::path ownFolder() {
    std::error_code problem;
    Dl_info info{};
    if (dladdr(reinterpret_cast<const void*>(&helperProgram), &info) != 0 && info.dli_fname != nullptr) {
        const std::filesystem::path file = info.dli_fname;
        if (file.filename().string().find(".so") != std::string::npos)
            return std::filesystem::canonical(file, problem).parent_path();
    }
    // The link is that of a running program even where another build has replaced its file.
    return std::filesystem::read_symlink("/proc/self/exe", problem).parent_path();
}

/// The first that exists.
std::filesystem::path firstOf(std::span<const std::filesystem::path> candidates,
                              const std::filesystem::path& otherwise) {
    std::error_code problem;
    for (const std::filesystem::path& candidate : candidates)
        if (std::filesystem::exists(candidate, problem))
            return candidate.lexically_normal();
    return otherwise;
}

} // namespace

std::filesystem::path helperProgram(const std::string& name) {
    const std::filesystem::path own = ownFolder();
    // Beside it; in the build folder, from lib/; from bin/ or lib/; from lib/x86_64-linux-gnu/.
    const std::array candidates{own / name, own / "../bin" / name, own / "../libexec/touchstone" / name,
                                own / "../../libexec/touchstone" / name};
    return firstOf(candidates, own / name);
}

std::filesystem::path dataFolder(const std::string& name, const std::filesystem::path& otherwise) {
    const std::filesystem::path own = ownFolder();
    const std::array candidates{own / "../share/touchstone" / name, own / "../../share/touchstone" / name};
    return firstOf(candidates, otherwise);
}

} // namespace touchstone
