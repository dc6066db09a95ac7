#pragma once
// The file browser of the window, without its widgets.

#include "workbench/dialog/file_request.h"
#include "workbench/dialog/folder_contents.h"
#include "workbench/timeline/background_job.h"

#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// A folder, what of it is shown, and what is chosen. Folders are read on a worker, again every two seconds;
/// where the folder has gone or may not be read `contents().problem` tells, and one can go elsewhere. Main
/// thread.
class FileBrowser {
  public:
    void open(FileRequest request);
    /// Every frame in which it is shown. `now`: s, any steady clock.
    void update(double now);

    void goTo(const std::filesystem::path& folder);
    void goUp() { goTo(folder_.parent_path()); }
    [[nodiscard]] const std::filesystem::path& folder() const { return folder_; }
    [[nodiscard]] const FileRequest& request() const { return request_; }
    [[nodiscard]] const FolderContents& contents() const { return contents_; }
    [[nodiscard]] bool reading() const { return contents_.folder != folder_; }

    /// Folders and files of the kind; to open one, those whose names contain the typed text, in any case.
    /// Those that begin with a point are shown where the text does.
    [[nodiscard]] const std::vector<FolderEntry>& shown() const { return shown_; }
    [[nodiscard]] size_t kind() const { return kind_; } ///< index into kFileKinds
    void setKind(size_t kind);
    [[nodiscard]] const std::string& text() const {
        return text_;
    } ///< typed: part of a name, a name, or a path
    void setText(std::string text);
    /// Index into shown(); none where nothing is chosen.
    [[nodiscard]] std::optional<size_t> chosen() const { return chosen_; }
    /// By a click: a file to be replaced also lends its name.
    void choose(size_t index);
    /// The next one, or the one before (-1).
    void moveChoice(int step);

    /// What Enter does: goes into a folder, or returns the file that is typed or chosen. A file to be saved
    /// has an ending.
    [[nodiscard]] std::optional<std::filesystem::path> enter();

  private:
    void filter();
    static constexpr double kRenewal = 2.0; // s

    FileRequest request_;
    std::filesystem::path folder_;
    FolderContents contents_;
    std::vector<FolderEntry> shown_;
    std::optional<size_t> chosen_;
    size_t kind_ = 0;
    std::string text_;
    BackgroundJob<FolderContents> job_;
    double last_ = 0.0;
    bool read_ = false; ///< folder_ has been read, or is being read
};

/// `path` with `ending`, where its name has none.
[[nodiscard]] std::filesystem::path withEnding(std::filesystem::path path, const std::string& ending);

} // namespace touchstone
