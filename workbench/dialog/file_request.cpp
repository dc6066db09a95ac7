#include "workbench/dialog/file_request.h"

#include <pwd.h>
#include <unistd.h>

#include <algorithm>
#include <cstdlib>
#include <system_error>

namespace touchstone {

namespace {

/// Of the user, or of the one named; empty where there is none.
std::filesystem::path homeOf(const std::string& user) {
    if (user.empty())
        if (const char* home = std::getenv("HOME"); home != nullptr && *home != '\0')
            return home;
    const passwd* entry = user.empty() ? getpwuid(getuid()) : getpwnam(user.c_str());
    return entry != nullptr && entry->pw_dir != nullptr ? entry->pw_dir : "";
}

} // namespace

std::filesystem::path typedPath(std::string_view typed, const std::filesystem::path& folder) {
    const size_t first = typed.find_first_not_of(" \t\n");
    if (first == std::string_view::npos)
        return {};
    typed = typed.substr(first, typed.find_last_not_of(" \t\n") - first + 1);
    if (typed.front() == '~') {
        const size_t slash = std::min(typed.find('/'), typed.size());
        if (const std::filesystem::path home = homeOf(std::string(typed.substr(1, slash - 1))); !home.empty())
            return slash + 1 < typed.size() ? home / typed.substr(slash + 1) : home;
    }
    return folder / typed; // an absolute path replaces the folder
}

bool isPath(std::string_view typed) {
    const size_t first = typed.find_first_not_of(" \t\n");
    return first != std::string_view::npos &&
           (typed[first] == '~' || typed.find('/') != std::string_view::npos || typed.substr(first) == "..");
}

std::vector<FilePlace> usualPlaces(std::span<const std::filesystem::path> samples,
                                   std::span<const std::filesystem::path> recent) {
    std::vector<FilePlace> places;
    const auto add = [&](const std::string& name, const std::filesystem::path& folder) {
        std::error_code problem;
        if (!folder.empty() && std::ranges::find(places, folder, &FilePlace::folder) == places.end() &&
            std::filesystem::is_directory(folder, problem))
            places.push_back({name, folder});
    };
    const std::filesystem::path home = homeOf("");
    add("Home", home);
    if (!home.empty())
        for (const char* name : {"Desktop", "Documents", "Downloads"})
            add(name, home / name);
    if (!samples.empty())
        add("Samples", samples.front().parent_path());
    for (const std::filesystem::path& file : recent)
        add(file.parent_path().filename().string(), file.parent_path());
    return places;
}

} // namespace touchstone
