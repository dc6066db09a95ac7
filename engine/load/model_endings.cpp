#include "engine/load/model_endings.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace touchstone {

bool endsIn(const std::filesystem::path& file, std::span<const std::string_view> endings) {
    std::string name = file.filename().string();
    std::ranges::transform(name, name.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::any_of(endings, [&](std::string_view ending) {
        return name.size() > ending.size() && name.ends_with(ending);
    });
}

} // namespace touchstone
