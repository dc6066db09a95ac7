#include "workbench/timeline/recording_files.h"

#include "engine/core/error.h"

#include <fcntl.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <string>

namespace touchstone {

namespace {

constexpr size_t kLongestName = 255; // bytes, of ext4, XFS and btrfs

[[noreturn]] void refuse(const std::filesystem::path& file, const std::string& problem,
                         const std::string& remedy) {
    throw Error(file.filename().string(), "", problem, remedy);
}

/// Why a name cannot be given; empty: it can.
std::string faultOf(std::string_view name, std::string_view ending) {
    const auto controls = [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == 0x7f; };
    if (std::ranges::all_of(name, [](char c) { return c == ' '; }))
        return "a name is missing";
    if (name.find('/') != std::string_view::npos || std::ranges::any_of(name, controls))
        return "a name has no slash and no control characters";
    if (name.starts_with('.'))
        return "a name that begins with a dot is hidden";
    if (name.starts_with("live-"))
        return "names that begin with live- belong to the flight recorder";
    if (name.size() + ending.size() > kLongestName)
        return "the name is too long";
    return "";
}

/// Never replaces a file, not even one that appears meanwhile.
int renameFresh(const std::filesystem::path& from, const std::filesystem::path& to) {
    if (renameat2(AT_FDCWD, from.c_str(), AT_FDCWD, to.c_str(), RENAME_NOREPLACE) == 0)
        return 0;
    if (errno != EINVAL) // a file system that does not know the flag
        return errno;
    if (link(from.c_str(), to.c_str()) != 0)
        return errno;
    return unlink(from.c_str()) == 0 ? 0 : errno;
}

} // namespace

std::filesystem::path renameRecording(const std::filesystem::path& file, std::string_view name) {
    const std::string ending = file.extension().string();
    if (name.ends_with(ending) && name.size() > ending.size())
        name.remove_suffix(ending.size());
    if (const std::string fault = faultOf(name, ending); !fault.empty())
        refuse(file, "is not renamed: " + fault, "choose another name");
    const std::filesystem::path renamed = file.parent_path() / (std::string(name) + ending);
    if (renamed == file)
        return file;
    const int error = renameFresh(file, renamed);
    if (error == EEXIST)
        refuse(file, "is not renamed: there is another " + renamed.filename().string(),
               "choose another name");
    if (error == ENOENT)
        refuse(file, "is not renamed: the file is gone", "");
    if (error != 0)
        refuse(file, std::string("is not renamed: ") + std::strerror(error),
               "make its folder writable: " + file.parent_path().string());
    return renamed;
}

void deleteRecording(const std::filesystem::path& file) {
    if (unlink(file.c_str()) == 0)
        return;
    const int error = errno;
    if (error == ENOENT)
        refuse(file, "is already gone", "");
    refuse(file, std::string("is not deleted: ") + std::strerror(error),
           "make its folder writable: " + file.parent_path().string());
}

} // namespace touchstone
