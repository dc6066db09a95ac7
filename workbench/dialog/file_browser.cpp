#include "workbench/dialog/file_browser.h"

#include <strings.h>

#include <algorithm>
#include <system_error>
#include <utility>

namespace touchstone {

namespace {

bool containsIgnoringCase(const std::string& text, const std::string& part) {
    return std::ranges::search(
               text, part,
               [](unsigned char a, unsigned char b) {
                   return std::tolower(a) == std::tolower(b);
               }).begin() != text.end() ||
           part.empty();
}

bool isFolder(const std::filesystem::path& path) {
    std::error_code problem;
    return std::filesystem::is_directory(path, problem);
}

} // namespace

std::filesystem::path withEnding(std::filesystem::path path, const std::string& ending) {
    if (!path.has_extension())
        path += ending;
    return path;
}

void FileBrowser::open(FileRequest request) {
    request_ = std::move(request);
    text_ = request_.name;
    kind_ = request_.saves() ? 1 : 0;
    goTo(request_.folder);
}

void FileBrowser::goTo(const std::filesystem::path& folder) {
    std::error_code problem;
    const std::filesystem::path whole = std::filesystem::absolute(folder, problem).lexically_normal();
    folder_ = problem ? folder : whole;
    if (folder_.has_relative_path() && !folder_.has_filename())
        folder_ = folder_.parent_path(); // without the last separator
    if (!request_.saves())
        text_.clear();
    chosen_.reset();
    shown_.clear();
    contents_ = {};
    read_ = false;
    job_.abandon();
}

void FileBrowser::update(double now) {
    if (std::optional<FolderContents> read = job_.take(); read && read->folder == folder_) {
        const bool changed = reading() || read->entries != contents_.entries;
        contents_ = *std::move(read);
        last_ = now;
        if (changed)
            filter();
    }
    if (job_.busy() || (read_ && now < last_ + kRenewal))
        return;
    read_ = true;
    job_.start(
        [folder = folder_](JobProgress& progress) { return readFolder(folder, progress.cancelled()); });
}

void FileBrowser::filter() {
    const std::string before = chosen_ ? shown_[*chosen_].name : "";
    shown_.clear();
    chosen_.reset();
    const bool byText = !request_.saves() && !isPath(text_);
    const bool hidden = byText && text_.starts_with('.');
    for (const FolderEntry& entry : contents_.entries) {
        const auto& endings = kFileKinds[kind_].endings;
        const bool ofKind = entry.folder || endings.empty() || endsIn(entry.name, endings);
        if (!ofKind || (entry.name.starts_with('.') && !hidden) ||
            (byText && !containsIgnoringCase(entry.name, text_)))
            continue;
        if (!before.empty() && entry.name == before)
            chosen_ = shown_.size();
        shown_.push_back(entry);
    }
    if (!chosen_ && byText && !text_.empty() && !shown_.empty())
        chosen_ = 0; // Enter opens the first that fits
}

void FileBrowser::setKind(size_t kind) {
    kind_ = std::min(kind, kFileKinds.size() - 1);
    filter();
}

void FileBrowser::setText(std::string text) {
    text_ = std::move(text);
    chosen_.reset();
    filter();
}

void FileBrowser::choose(size_t index) {
    if (index >= shown_.size())
        return;
    chosen_ = index;
    if (request_.saves() && !shown_[index].folder)
        text_ = shown_[index].name;
}

void FileBrowser::moveChoice(int step) {
    if (shown_.empty())
        return;
    const auto last = static_cast<std::ptrdiff_t>(shown_.size()) - 1;
    const std::ptrdiff_t from = chosen_ ? static_cast<std::ptrdiff_t>(*chosen_) : step > 0 ? -1 : last + 1;
    chosen_ = static_cast<size_t>(std::clamp<std::ptrdiff_t>(from + step, 0, last));
}

std::optional<std::filesystem::path> FileBrowser::enter() {
    const bool folderChosen = chosen_ && shown_[*chosen_].folder;
    std::filesystem::path target;
    if (isPath(text_))
        target = typedPath(text_, folder_);
    else if (folderChosen || (chosen_ && !request_.saves()))
        target = folder_ / shown_[*chosen_].name;
    else if (!text_.empty())
        target = typedPath(text_, folder_);
    if (target.empty())
        return std::nullopt;
    if (isFolder(target)) {
        if (request_.saves() && isPath(text_))
            text_ = request_.name;
        goTo(target);
        return std::nullopt;
    }
    return request_.saves() ? withEnding(std::move(target), request_.ending) : target;
}

} // namespace touchstone
