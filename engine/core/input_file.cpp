#include "engine/core/input_file.h"

#include "engine/core/error.h"

#include <system_error>

namespace touchstone {

void requireFile(const std::filesystem::path& path, const std::string& shownAs, const std::string& remedy) {
    std::error_code problem;
    const std::filesystem::file_status status = std::filesystem::status(path, problem);
    if (status.type() == std::filesystem::file_type::none)
        throw Error(shownAs, "", "cannot be read: " + problem.message(),
                    "check its name and its permissions");
    if (!std::filesystem::exists(status))
        throw Error(shownAs, "", "there is no such file", "check the name and the folder");
    if (!std::filesystem::is_regular_file(status))
        throw Error(shownAs, "", "is not a file", remedy);
}

} // namespace touchstone
