#pragma once

#include "workbench/dialog/desktop_dialog.h"
#include "workbench/dialog/file_browser.h"

#include <filesystem>
#include <optional>
#include <string>
#include <utility>

namespace touchstone {

struct FileChoice {
    FilePurpose purpose = FilePurpose::Open;
    std::filesystem::path path; ///< absolute
};

/// Asks for a file: by the desktop's dialog where there is one, else, and where that fails, by the window's
/// browser. Before a file is replaced that the desktop's dialog has not asked about, it asks. Main thread.
class FileDialog {
  public:
    enum class Stage : uint8_t { Closed, Desktop, Browser, Replace };

    /// Replaces what was asked before.
    void ask(FileRequest request);
    /// Every frame: the choice, once. `now`: s, any steady clock.
    [[nodiscard]] std::optional<FileChoice> update(double now);

    [[nodiscard]] Stage stage() const { return stage_; }
    [[nodiscard]] bool open() const { return stage_ != Stage::Closed; }
    /// While the browser has the keyboard.
    [[nodiscard]] bool covers() const { return stage_ == Stage::Browser || stage_ == Stage::Replace; }
    void close();
    /// The browser's text field is to have the keyboard and does not have it yet; what draws it tells.
    [[nodiscard]] bool awaitsText() const { return stage_ == Stage::Browser && awaitsText_; }
    void setAwaitsText(bool awaits) { awaitsText_ = awaits; }
    /// Once after it was opened: the text field is to have the keyboard.
    [[nodiscard]] bool takeAsksForFocus() { return std::exchange(asksForFocus_, false); }
    /// While it asks for a name to save under.
    [[nodiscard]] bool saves() const { return open() && request_.saves(); }

    /// The window's browser in place of the desktop's dialog.
    void browse();
    [[nodiscard]] FileBrowser& browser() { return browser_; }
    /// The browser's choice; nothing where it went into a folder.
    void enter();
    /// Of stage Replace: the file in question, and the answer. No: back to the browser.
    [[nodiscard]] const std::filesystem::path& target() const { return target_; }
    void replace(bool yes);
    /// Why the browser is shown though the desktop has a dialog; empty: no such reason.
    [[nodiscard]] const std::string& note() const { return note_; }

  private:
    void takeAnswer(const DialogAnswer& answer);
    void choose(const std::filesystem::path& path);

    FileRequest request_;
    Stage stage_ = Stage::Closed;
    std::vector<DialogProgram> waiting_; ///< those that are asked if the one before is absent, in this order
    bool awaitsText_ = false, asksForFocus_ = false;
    bool asks_ = false; ///< the first of them, once the one before has ended
    DesktopDialog desktop_;
    FileBrowser browser_;
    std::filesystem::path target_;
    std::string note_;
    std::optional<FileChoice> choice_;
};

} // namespace touchstone
