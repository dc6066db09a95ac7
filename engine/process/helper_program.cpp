#include "engine/process/helper_program.h"

#include <dlfcn.h>

#include <array>
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

} // namespace

std::filesystem::path helperProgram(const std::string& name) {
    const std::filesystem::path own = ownFolder();
    // Beside it; in the build folder, from lib/; from bin/ or lib/; from lib/x86_64-linux-gnu/.
    const std::array candidates{own / name, own / "../bin" / name, own / "../libexec/touchstone" / name,
                                own / "../../libexec/touchstone" / name};
    std::error_code problem;
    for (const std::filesystem::path& candidate : candidates)
        if (std::filesystem::exists(candidate, problem))
            return candidate.lexically_normal();
    return own / name;
}

} // namespace touchstone
