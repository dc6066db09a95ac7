#pragma once
// The editor of materials without its widgets: what is edited, what is being made touchable, what is saved.

#include "workbench/editor/live_materials.h"
#include "workbench/editor/material_edits.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace touchstone {

/// Main thread. Owns the workers that it needs; none of its calls waits for one, but `open` and the end.
class MaterialController {
  public:
    /// Another model: what was edited before is gone. `generated`: the program's own scene, which is not to
    /// be written over.
    void open(const Model& model, bool generated);

    /// Every frame: what has become ready to be touched in place of `model`, if anything has.
    [[nodiscard]] std::optional<MadeMaterials> update(const Model& model);

    [[nodiscard]] MaterialEdits& edits() { return edits_; }
    [[nodiscard]] const MaterialEdits& edits() const { return edits_; }
    /// What the scene that is touched, or is about to be, was made of; for showing what holds.
    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
    [[nodiscard]] bool working() const { return live_.busy(); }
    [[nodiscard]] double seconds() const { return seconds_; } ///< that the last change took to be touchable

    /// Into the file that is open, or another one, which then is the one that is open; once the last change
    /// is felt and the save before has ended.
    void save() { saveAs(path_); }
    void saveAs(const std::filesystem::path& target);
    [[nodiscard]] bool saving() const { return saving_.valid() || !wanted_.empty(); }
    [[nodiscard]] bool canSaveInPlace() const { return !generated_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// The file as it was saved; once after each save.
    [[nodiscard]] std::optional<FileStamp> takeSaved() { return std::exchange(saved_, std::nullopt); }

    /// What went wrong or well last, for the user; empty: nothing.
    [[nodiscard]] const std::string& notice() const { return notice_; }
    [[nodiscard]] bool failed() const { return failed_; } ///< the notice tells of a problem

  private:
    void tell(std::string notice, bool failed);
    void startSaving(const std::filesystem::path& target);
    void finishSaving();
    void startWork(const Model& model);

    MaterialEdits edits_;
    LiveMaterials live_;
    std::vector<Material> materials_;
    uint64_t touched_ = 0, seen_ = 0; // revisions that the hand and the eye have
    double seconds_ = 0.0;

    std::filesystem::path path_, target_, wanted_; ///< wanted_: to be saved to as soon as may be
    FileStamp stamp_;
    bool generated_ = false;
    std::future<FileStamp> saving_;
    std::vector<HapticStatement> savingStatements_;
    std::optional<FileStamp> saved_;
    std::string notice_;
    bool failed_ = false;
};

} // namespace touchstone
