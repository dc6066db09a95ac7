#include "workbench/dialog/file_dialog.h"

#include <system_error>
#include <utility>

namespace touchstone {

void FileDialog::ask(FileRequest request) {
    close();
    request_ = std::move(request);
    waiting_ = installedDialogs();
    asks_ = !waiting_.empty();
    if (asks_)
        stage_ = Stage::Desktop;
    else
        browse();
}

void FileDialog::close() {
    desktop_.close();
    waiting_.clear();
    choice_.reset();
    note_.clear();
    stage_ = Stage::Closed;
}

void FileDialog::browse() {
    desktop_.close();
    waiting_.clear();
    stage_ = Stage::Browser;
    awaitsText_ = asksForFocus_ = true;
    browser_.open(request_);
}

std::optional<FileChoice> FileDialog::update(double now) {
    if (const std::optional<DialogAnswer> answer = desktop_.take())
        takeAnswer(*answer);
    if (asks_ && !desktop_.busy()) {
        asks_ = false;
        desktop_.open(waiting_.front(), request_);
        waiting_.erase(waiting_.begin());
    }
    if (stage_ == Stage::Browser)
        browser_.update(now);
    return std::exchange(choice_, std::nullopt);
}

void FileDialog::takeAnswer(const DialogAnswer& answer) {
    if (stage_ != Stage::Desktop)
        return;
    if (answer.absent && !waiting_.empty()) {
        asks_ = true;
    } else if (answer.absent && std::getenv("TOUCHSTONE_FILE_DIALOG") == nullptr) {
        browse(); // as where there is no dialog at all
    } else if (!answer.problem.empty()) {
        note_ = answer.problem;
        browse();
    } else if (answer.path.empty()) {
        close();
    } else if (request_.saves() && !answer.path.has_extension()) {
        // The dialog has asked about another name.
        browser_.open(request_);
        choose(withEnding(answer.path, request_.ending));
    } else {
        choice_ = FileChoice{request_.purpose, answer.path};
        stage_ = Stage::Closed;
    }
}

void FileDialog::enter() {
    if (const std::optional<std::filesystem::path> path = browser_.enter())
        choose(*path);
}

void FileDialog::choose(const std::filesystem::path& path) {
    std::error_code problem;
    target_ = path;
    if (request_.saves() && std::filesystem::exists(path, problem)) {
        stage_ = Stage::Replace;
        return;
    }
    replace(true);
}

void FileDialog::replace(bool yes) {
    stage_ = yes ? Stage::Closed : Stage::Browser;
    awaitsText_ = asksForFocus_ = !yes;
    if (yes)
        choice_ = FileChoice{request_.purpose, target_};
}

} // namespace touchstone
