#include "workbench/dialog/folder_contents.h"

#include <strings.h>

#include <algorithm>
#include <exception>
#include <system_error>

namespace touchstone {

namespace {

void readEntries(FolderContents& contents, const std::atomic<bool>& cancelled) {
    namespace fs = std::filesystem;
    std::error_code problem;
    fs::directory_iterator at(contents.folder, problem);
    for (; !problem && at != fs::directory_iterator(); at.increment(problem)) {
        if (cancelled.load(std::memory_order_relaxed))
            return;
        if (contents.entries.size() == FolderContents::kMax) {
            contents.complete = false;
            return;
        }
        std::error_code unreadable; // a broken link, say
        const bool folder = at->is_directory(unreadable);
        if (!folder && !at->is_regular_file(unreadable))
            continue;
        const uint64_t bytes = folder ? 0 : at->file_size(unreadable);
        contents.entries.push_back(
            {.name = at->path().filename().string(), .folder = folder, .bytes = unreadable ? 0 : bytes});
    }
    if (problem)
        contents.problem = problem.message();
}

} // namespace

FolderContents readFolder(const std::filesystem::path& folder, const std::atomic<bool>& cancelled) {
    FolderContents contents;
    contents.folder = folder;
    try {
        readEntries(contents, cancelled);
    } catch (const std::exception& error) { // memory
        contents.problem = error.what();
    }
    std::ranges::sort(contents.entries, [](const FolderEntry& a, const FolderEntry& b) {
        if (a.folder != b.folder)
            return a.folder;
        const int order = strcasecmp(a.name.c_str(), b.name.c_str());
        return order != 0 ? order < 0 : a.name < b.name;
    });
    return contents;
}

} // namespace touchstone
