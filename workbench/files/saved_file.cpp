#include "workbench/files/saved_file.h"

#include "workbench/files/state_folder.h"

#include <algorithm>
#include <array>
#include <ctime>

namespace touchstone {

std::filesystem::path savedFile(std::string_view what, std::string_view ending) {
    const std::filesystem::path folder = stateFolder() / "saved";
    std::filesystem::create_directories(folder);
    const std::time_t now = std::time(nullptr);
    std::tm local{};
    localtime_r(&now, &local);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "-%Y%m%d-%H%M%S", &local);
    const std::string stem = std::string(what) + date.data();
    const auto taken = [&](const std::string& name) {
        return std::ranges::any_of(std::filesystem::directory_iterator(folder),
                                   [&](const auto& entry) { return entry.path().stem() == name; });
    };
    std::string free = stem;
    for (int number = 2; taken(free); ++number)
        free = stem + "-" + std::to_string(number);
    return folder / (free + std::string(ending));
}

} // namespace touchstone
