#pragma once
// The desktop's own file dialog: xdg-desktop-portal's, asked by a small program of ours (dialog/portal), or
// the programs that desktops have for scripts, zenity (GNOME and others) and kdialog (KDE). Each is a process
// of its own, so that neither its toolkit nor a hang of it is ours.

#include "engine/process/process_answer.h"
#include "workbench/dialog/file_request.h"
#include "workbench/timeline/background_job.h"

#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

struct DialogProgram {
    enum class Kind : uint8_t { Portal, Zenity, Kdialog } kind = Kind::Zenity;
    std::filesystem::path file;
};

/// In the order in which they are asked: the portal where the session has a bus, then those in PATH, kdialog
/// first on KDE. TOUCHSTONE_FILE_DIALOG=portal, zenity or kdialog leaves one, any other value none: the
/// window's own browser then.
[[nodiscard]] std::vector<DialogProgram> installedDialogs();

/// Its command line, the program's name first.
[[nodiscard]] std::vector<std::string> dialogArguments(DialogProgram::Kind kind, const FileRequest& request);

struct DialogAnswer {
    std::filesystem::path path; ///< absolute; empty: none was chosen
    std::string problem;        ///< why the program gave no answer; empty: it gave one, or was cancelled
    bool absent = false;        ///< nobody answers for the portal: the next dialog is asked instead
};

/// What the program's end means; status 3 that there is no portal. `seconds`: how long it ran; one that ends
/// unsuccessfully before anybody could have cancelled it was never seen.
[[nodiscard]] DialogAnswer answerOf(const ProcessAnswer& answer, double seconds);

/// One dialog at a time. Main thread; only the destructor waits, some 20 ms.
class DesktopDialog {
  public:
    void open(const DialogProgram& program, const FileRequest& request);
    /// Ends the program; no answer comes.
    void close() { job_.abandon(); }
    [[nodiscard]] bool isOpen() const { return job_.wanted(); }
    /// Still ending after close().
    [[nodiscard]] bool busy() const { return job_.busy(); }
    /// Every frame: the answer, once.
    [[nodiscard]] std::optional<DialogAnswer> take() { return job_.take(); }

  private:
    BackgroundJob<DialogAnswer> job_;
};

} // namespace touchstone
