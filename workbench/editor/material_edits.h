#pragma once
// What a user has changed about a file's materials, step by step.

#include "engine/save/material_patch.h"
#include "engine/scene/scene.h"

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// What takes the extension of one material from `from` to `to`, naming only what differs.
[[nodiscard]] nlohmann::ordered_json patchBetween(const HapticStatement& from, const HapticStatement& to);

/// Statements of the file's materials as they were read and as they are now, with the way back and forth.
/// One thread.
class MaterialEdits {
  public:
    MaterialEdits() = default;
    explicit MaterialEdits(const Scene& scene);

    [[nodiscard]] size_t size() const { return now_.size(); } ///< materials of the file that the scene has
    [[nodiscard]] const HapticStatement& now(size_t material) const { return now_[material]; }
    [[nodiscard]] const HapticStatement& inFile(size_t material) const { return file_[material]; }
    [[nodiscard]] const std::vector<HapticStatement>& all() const { return now_; }

    /// Another statement for a material. `what` says what the user did ("static friction"). Steps of the same
    /// name that follow each other before `endGesture` are one: a slider that is dragged is undone at once.
    void change(size_t material, HapticStatement next, std::string what);
    void endGesture() { open_ = false; }
    [[nodiscard]] bool inGesture() const { return open_; }

    void undo();
    void redo();
    /// What would be undone or redone; empty: nothing.
    [[nodiscard]] std::string undoName() const { return at_ > 0 ? steps_[at_ - 1].what : ""; }
    [[nodiscard]] std::string redoName() const { return at_ < steps_.size() ? steps_[at_].what : ""; }

    /// The file has them now.
    void saved(std::vector<HapticStatement> statements) { file_ = std::move(statements); }

    [[nodiscard]] bool edited() const { return now_ != file_; } ///< something is not in the file
    [[nodiscard]] bool edited(size_t material) const { return now_[material] != file_[material]; }
    [[nodiscard]] MaterialPatches patches() const;                ///< from the file to now
    [[nodiscard]] uint64_t revision() const { return revision_; } ///< grows with every change

  private:
    struct Step {
        size_t material = 0;
        HapticStatement before, after;
        std::string what;
    };
    std::vector<HapticStatement> file_, now_;
    std::vector<Step> steps_;
    size_t at_ = 0; // steps that are made
    bool open_ = false;
    uint64_t revision_ = 0;
};

/// The scene's materials with these statements for the file's, each settled as the importer does it.
[[nodiscard]] std::vector<Material> editedMaterials(const Scene& scene,
                                                    std::span<const HapticStatement> statements);

} // namespace touchstone
