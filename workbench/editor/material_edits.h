#pragma once
// The user's edits of a file's materials, with undo.

#include "engine/save/material_patch.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The JSON patch of one material's extension from `from` to `to`, with the differences only.
[[nodiscard]] nlohmann::ordered_json patchBetween(const HapticStatement& from, const HapticStatement& to);

/// Statements of the file's materials as loaded and as edited, with undo and redo. One thread.
class MaterialEdits {
  public:
    MaterialEdits() = default;
    explicit MaterialEdits(const Scene& scene);

    [[nodiscard]] size_t size() const { return now_.size(); } ///< materials of the file that are in the scene
    [[nodiscard]] const HapticStatement& now(size_t material) const { return now_[material]; }
    [[nodiscard]] const HapticStatement& inFile(size_t material) const { return file_[material]; }
    [[nodiscard]] const std::vector<HapticStatement>& all() const { return now_; }

    /// Sets the statement of a material. `what` names the edit ("static friction"). Consecutive steps of the
    /// same name before `endGesture` are merged, so that one undo reverts the drag of a slider.
    void change(size_t material, HapticStatement next, std::string what);
    void endGesture() { open_ = false; }
    [[nodiscard]] bool inGesture() const { return open_; }

    void undo();
    void redo();
    /// The step to undo or redo; empty: none.
    [[nodiscard]] std::string undoName() const { return at_ > 0 ? steps_[at_ - 1].what : ""; }
    [[nodiscard]] std::string redoName() const { return at_ < steps_.size() ? steps_[at_].what : ""; }

    /// Another program of a material, which is no step: `with` is applied to its statement now, and to those
    /// that undo and redo bring back.
    void replace(size_t material, const std::function<HapticStatement(HapticStatement)>& with);
    void replaceNow(size_t material, HapticStatement statement);
    /// The file's statement has this program now.
    void replaceInFile(size_t material, std::shared_ptr<const SurfaceProgram> program);

    /// The file contains them now.
    void saved(std::vector<HapticStatement> statements) { file_ = std::move(statements); }

    [[nodiscard]] bool edited() const { return now_ != file_; } ///< there are unsaved edits
    [[nodiscard]] bool edited(size_t material) const { return now_[material] != file_[material]; }
    [[nodiscard]] MaterialPatches patches() const;                ///< from the file to the current state
    [[nodiscard]] uint64_t revision() const { return revision_; } ///< increases with every change

  private:
    struct Step {
        size_t material = 0;
        HapticStatement before, after;
        std::string what;
    };
    std::vector<HapticStatement> file_, now_;
    std::vector<Step> steps_;
    size_t at_ = 0; // applied steps
    bool open_ = false;
    uint64_t revision_ = 0;
};

/// The scene's materials with these statements, each resolved as by the importer.
[[nodiscard]] std::vector<Material> editedMaterials(const Scene& scene,
                                                    std::span<const HapticStatement> statements);

} // namespace touchstone
