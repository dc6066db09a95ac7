#pragma once
// The haptic programs of a file while they are edited: in the window, or by another program that saves their
// files. Without its user interface.

#include "haptics/program/program_fault.h"
#include "workbench/editor/material_edits.h"
#include "workbench/editor/program_worker.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// One source; materials may share it.
struct EditedProgram {
    std::string name{};
    std::filesystem::path file{};                    ///< empty: the source is inside the model's file
    std::shared_ptr<const SurfaceProgram> program{}; ///< the last that compiled; null: none has yet
    std::string text{};                              ///< as it is typed
    std::string saved{};                             ///< as the file has it
    std::string problem{};                           ///< of `text`, with its remedy; empty: none
    unsigned line = 0;                               ///< of the problem, from 1; 0: none in particular
    program::ProgramFault fault{};                   ///< of `program`, where it is touched; empty: none
    bool compiling = false;                          ///< `problem` is not that of `text` yet
    bool overtaken = false;                          ///< the file has changed beside what was typed here
    ProgramCost cost{};                              ///< of `program`
    uint64_t loads = 0;                              ///< programs that have taken the place of others
    double felt = -1.0, seen = -1.0; ///< s from the last change to touch and to the picture; < 0: not yet

    [[nodiscard]] bool edited() const { return text != saved; }
};

/// Main thread. The last program that compiled stays until the next one does.
class ProgramEditor {
  public:
    /// Another model, and the programs of its file.
    void open(const Scene& scene);

    /// Every frame: what has been compiled takes the place of the programs of all materials that share the
    /// source.
    void update(MaterialEdits& edits);

    [[nodiscard]] const std::vector<EditedProgram>& sources() const { return sources_; }
    /// That of a material of the file; null: it has none, or none that can be read.
    [[nodiscard]] const EditedProgram* of(size_t material) const;
    /// Index in `sources` of a material that has one.
    [[nodiscard]] size_t indexOf(size_t material) const { return static_cast<size_t>(sourceOf_[material]); }

    /// A text as somebody types it: compiled when nothing has been typed for 0.15 s.
    void type(size_t source, std::string text);
    /// Back to what the file has.
    void revert(size_t source);
    /// The file's statement about a material, whose program follows: its text is reverted.
    [[nodiscard]] HapticStatement reverted(size_t material, const MaterialEdits& edits);
    /// What the program costs stands in `cost` some time later. May be called in every frame.
    void measure(size_t source);

    [[nodiscard]] bool edited() const;  ///< there are texts that no file has
    [[nodiscard]] bool pending() const; ///< a text is being compiled, or soon will be
    /// A text is being compiled, or the result is not taken up yet.
    [[nodiscard]] bool compiling() { return worker_.busy(); }
    /// Why texts cannot be saved, with a remedy; empty: they can. One that does not compile would make the
    /// surface plain.
    [[nodiscard]] std::string saveProblem() const;
    /// Texts that are to be written to files of their own.
    [[nodiscard]] std::vector<ProgramFile> unsavedFiles() const;
    /// The files have these texts now.
    [[nodiscard]] std::vector<std::string> texts() const;
    void saved(const std::vector<std::string>& texts);
    /// The model was saved into another folder, and the files of its programs beside it.
    void moved(const std::filesystem::path& from, const std::filesystem::path& to);
    /// Every frame: why `failing` has no result where it is touched; null: none fails.
    void showFault(const program::FeltProgram* failing, const program::ProgramFault& fault);
    /// Increases with every text that is typed.
    [[nodiscard]] uint64_t revision() const { return revision_; }

    /// The patches, with the source itself in place of a file that has changed since the model was opened:
    /// what is touched can be touched again whatever becomes of that file.
    [[nodiscard]] MaterialPatches withSources(MaterialPatches patches, const MaterialEdits& edits) const;

    /// The materials of this revision of the edits are in touch, or in the picture, at `now` (secondsNow()).
    void feltAt(uint64_t revision, double now);
    void seenAt(uint64_t revision, double now);

  private:
    struct Timing {
        double due = 0.0;                               ///< s, when the text is to be compiled; 0: it was
        double changed = 0.0;                           ///< s, of the last change that compiled
        uint64_t revision = 0;                          ///< of the edits that have it
        std::shared_ptr<const SurfaceProgram> measured; ///< or about to be
    };
    void add(size_t material, const HapticStatement& says, const std::filesystem::path& model);
    void apply(const ProgramReport& report, MaterialEdits& edits);
    [[nodiscard]] HapticStatement withKeptValues(size_t material, HapticStatement statement,
                                                 nlohmann::json stated);
    void takeUp(size_t source, const std::shared_ptr<const SurfaceProgram>& program, bool inFile,
                MaterialEdits& edits);

    ProgramWorker worker_;
    std::vector<EditedProgram> sources_;
    std::vector<Timing> timings_;
    std::vector<int> sourceOf_;               ///< by material of the file; -1: none
    std::map<size_t, nlohmann::json> unused_; ///< by material: values that the program declares no more
    uint64_t revision_ = 0;
};

/// The statement with another program in place of its own, without values that this one does not declare so.
/// `sourceFrom`: a shader whose source is the program's; null: its text is inside.
[[nodiscard]] HapticStatement withProgram(HapticStatement statement,
                                          const std::shared_ptr<const SurfaceProgram>& program,
                                          const nlohmann::json* sourceFrom);

/// `data:` URI of a text.
[[nodiscard]] std::string dataUriOf(std::string_view text);

} // namespace touchstone
