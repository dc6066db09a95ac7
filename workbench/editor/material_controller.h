#pragma once
// The material editor without its user interface: edits, recompilation, saving.

#include "workbench/editor/live_materials.h"
#include "workbench/editor/material_edits.h"
#include "workbench/editor/program_editor.h"
#include "workbench/editor/texture_saving.h"

#include <filesystem>
#include <future>
#include <optional>
#include <string>

namespace touchstone {

/// Main thread. Owns its workers; no call waits for one, except `open` and the destructor.
class MaterialController {
  public:
    /// Another model; discards all edits. `replaceable`: its file may be overwritten (not one of our own
    /// scenes, nor a format that cannot hold what is felt).
    void open(const Model& model, bool replaceable);

    /// Every frame, before `update`: what touch has made of the textures of `shown`; null: none.
    void watch(const Model& shown, const PersistentTextures* textures);

    /// Every frame: the compiled materials that replace those of `model`, if ready.
    [[nodiscard]] std::optional<MadeMaterials> update(const Model& model);

    [[nodiscard]] MaterialEdits& edits() { return edits_; }
    [[nodiscard]] const MaterialEdits& edits() const { return edits_; }
    /// The haptic programs of the file; their edits are saved with those of the materials.
    [[nodiscard]] ProgramEditor& programs() { return programs_; }
    [[nodiscard]] const ProgramEditor& programs() const { return programs_; }
    /// There are unsaved edits, of materials or programs, or touch has changed a persistent texture.
    [[nodiscard]] bool edited() const { return edits_.edited() || programs_.edited() || textures_.changed(); }
    [[nodiscard]] bool texturesEdited() const { return textures_.changed(); }
    /// Increases with every change of either.
    [[nodiscard]] uint64_t revision() const { return edits_.revision() + programs_.revision(); }
    /// The revision of `edits` that `materials` has.
    [[nodiscard]] uint64_t touched() const { return touched_; }
    /// The materials of the current or next scene; for displaying effective values.
    [[nodiscard]] const std::vector<Material>& materials() const { return materials_; }
    [[nodiscard]] bool working() const { return live_.busy(); }
    /// An edit is being compiled or made: `update` has something to do before the next frame.
    [[nodiscard]] bool onTheWay() { return live_.busy() || programs_.compiling(); }
    [[nodiscard]] double seconds() const { return seconds_; } ///< duration of the last recompilation

    /// To the open file, or to another one, which then becomes the open one; once the last change is in
    /// effect and the previous save has finished.
    void save() { saveAs(path_); }
    void saveAs(const std::filesystem::path& target);
    [[nodiscard]] bool saving() const { return saving_.valid() || !wanted_.empty(); }
    [[nodiscard]] bool canSaveInPlace() const { return replaceable_; }
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }
    /// The file as saved; once after each save.
    [[nodiscard]] std::optional<FileStamp> takeSaved() { return std::exchange(saved_, std::nullopt); }

    /// Result of the last operation, for the user; empty: none.
    [[nodiscard]] const std::string& notice() const { return notice_; }
    [[nodiscard]] bool failed() const { return failed_; } ///< the notice reports a problem

  private:
    void tell(std::string notice, bool failed);
    void startSaving(const std::filesystem::path& target);
    void finishSaving();
    void startWork(const Model& model);

    MaterialEdits edits_;
    ProgramEditor programs_;
    LiveMaterials live_;
    std::vector<Material> materials_;
    uint64_t touched_ = 0, seen_ = 0; // revisions of the haptic and of the rendered scene
    double seconds_ = 0.0;

    TextureWatch textures_;
    uint64_t savingTextures_ = 0; ///< TextureWatch::revision
    Model shown_;                 ///< of `watch`, until `update`
    const PersistentTextures* shownTextures_ = nullptr;
    std::filesystem::path path_, target_, wanted_; ///< wanted_: to be saved to as soon as possible
    FileStamp stamp_;
    bool replaceable_ = true;
    std::future<FileStamp> saving_;
    std::vector<HapticStatement> savingStatements_;
    std::vector<std::string> savingTexts_; ///< of the programs
    std::optional<FileStamp> saved_;
    std::string notice_;
    bool failed_ = false;
};

} // namespace touchstone
