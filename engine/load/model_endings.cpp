#include "engine/load/model_endings.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace touchstone {

bool endsIn(const std::filesystem::path& file, std::span<const std::string_view> endings) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return std::ranges::find(endings, ending) != endings.end();
}

} // namespace touchstone
