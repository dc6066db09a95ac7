#pragma once
// Edits of a distance field, with undo. One thread, not the servo's.

#include "engine/math/similarity.h"
#include "haptics/shape/field/field_colors.h"
#include "haptics/shape/field/sculpt/field_window.h"
#include "haptics/shape/field/sculpt/restore_distance.h"
#include "haptics/shape/field/sculpt/sculpt_tool.h"

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <vector>

namespace touchstone {

struct DabReport {
    double removed = 0.0; ///< object units cubed; negative where the solid grew
    size_t bricks = 0;    ///< that were replaced, also those of colours
    Bounds changed;       ///< of nodes whose value may have changed, object frame
};

/// Applies dabs to a field and keeps every brick that they replace. Bricks are never written to: each grid
/// that `grid` gave stays as it was, and shares with the next all bricks but the replaced ones. The same dabs
/// give the same bytes, and so the same hash, wherever and whenever they are applied.
class Sculptor {
  public:
    /// `base`: a grid that is not edited.
    explicit Sculptor(std::shared_ptr<const FieldGrid> base);

    [[nodiscard]] const std::shared_ptr<const FieldGrid>& base() const { return base_; }
    /// The field as it is now, with previews. A new one after each change.
    [[nodiscard]] std::shared_ptr<const FieldGrid> grid();
    /// Null where nothing is painted.
    [[nodiscard]] std::shared_ptr<const FieldColors> colors();

    /// The dabs from here to the next call are one step of `undo`. Forgets what was undone.
    void beginStroke();
    /// Begins a stroke where none was begun. A Drag longer than a quarter of the radius is divided, so that
    /// it folds nothing. Throws Error (check) before anything is changed.
    DabReport apply(const Dab& dab);

    /// The first half of `apply` for a whole ball that is taken out or joined (isWholeBall): the surface is
    /// where it will be and the values of one side are distances, those of the other are bounds, never longer
    /// than the distance. Several of them, near each other, may be made before `restore`.
    DabReport shape(const Dab& dab);
    /// True where the next `shape` leaves the distances of the last ones to the same `restore`.
    [[nodiscard]] bool joins(const Dab& dab) const;
    /// The second half: distances everywhere. Every other change does so before its own. `meanwhile` is
    /// called between its steps, a millisecond or two apart at most; it may call `preview` and
    /// `takeChangedBricks`, and read what there is. Where it throws, the distances are still owed.
    DabReport restore(const std::function<void()>& meanwhile = {});
    /// `shape` was called since `restore`.
    [[nodiscard]] bool owesDistances() const { return shaped_.has_value(); }
    /// What `shape` would make of the field as it is now, which may owe distances, and of previews before:
    /// `grid` has it until the end of the next change of another kind. No change itself, and no part of a
    /// stroke. Only for isWholeBall.
    DabReport preview(const Dab& dab);
    [[nodiscard]] bool previews() const { return !previewed_.empty(); }

    /// Throws Error where `apply` would: checkDab, and more nodes at once than kMostWindowNodes.
    void check(const Dab& dab) const;

    /// Takes back the last stroke that changed something. False where there is none.
    bool undo();
    bool redo();
    [[nodiscard]] size_t undoSteps() const;
    [[nodiscard]] size_t redoSteps() const;
    /// FieldGrid::brickNumber of the bricks whose values or colours differ from those at the last call, in
    /// order.
    [[nodiscard]] std::vector<uint32_t> takeChangedBricks();
    /// Of all bricks that the field, its previews and its history hold.
    [[nodiscard]] uint64_t memoryBytes() const;

  private:
    using BrickPtr = std::shared_ptr<const EditedBrick>; ///< null: the base's brick
    struct Replaced {
        BrickPtr before, after;
    };
    struct Recolored {
        ColorBrickPtr before, after; ///< null: white
    };
    /// By FieldGrid::brickNumber and by FieldColors::brickNumber.
    struct Step {
        std::map<uint32_t, Replaced> values;
        std::map<uint32_t, Recolored> colors;
        [[nodiscard]] bool empty() const { return values.empty() && colors.empty(); }
    };

    /// What `restore` has to do.
    struct Shaped {
        std::shared_ptr<const FieldGrid> before; ///< a distance
        glm::dvec3 centre{0.0}; ///< of a ball around all nodes that were changed by themselves
        double radius = 0.0;    ///< object units
        SculptTool tool = SculptTool::Carve;
        ExactSide exact = ExactSide::None;
    };
    [[nodiscard]] Shaped joined(const Dab& dab) const;

    [[nodiscard]] std::vector<Dab> partsOf(const Dab& dab) const;
    [[nodiscard]] double margin() const; ///< voxels around what a dab changes by itself
    /// The same, of what the first half of one changes.
    [[nodiscard]] double shapeMargin(SculptTool tool) const;
    DabReport applyOnce(const Dab& dab);
    DabReport committed(const SculptZone& zone, const std::vector<NodeBox>& changed);
    DabReport paint(const Dab& dab);
    bool paintBrick(const glm::ivec3& brick, const Dab& dab);
    void recolor(uint32_t number, const ColorBrickPtr& brick);
    void goBackOrOn(const Step& step, bool back);
    [[nodiscard]] BrickPtr current(uint32_t number) const;
    void replace(uint32_t number, const BrickPtr& brick);
    /// Bricks by FieldGrid::brickNumber.
    using Bricks = std::map<uint32_t, BrickPtr>;
    [[nodiscard]] const std::shared_ptr<const FieldGrid>& made(); ///< without previews
    [[nodiscard]] std::shared_ptr<const FieldGrid> madeWith(const Bricks& previews) const;
    [[nodiscard]] Bricks changedBricks(const FieldWindow& window, const FieldGrid& from,
                                       const std::vector<NodeBox>& changed) const;
    [[nodiscard]] std::optional<BrickPtr> changedBrick(const FieldWindow& window, const FieldGrid& from,
                                                       const glm::ivec3& brick) const;
    size_t commit(const std::vector<NodeBox>& changed);
    void dropPreviews();

    std::shared_ptr<const FieldGrid> base_, grid_; ///< grid_ is null where it is to be made
    Bricks edits_;                                 ///< bricks that differ from the base's
    Bricks previewed_;                             ///< null: the base's brick
    std::shared_ptr<const FieldGrid> preview_;     ///< null where there are none
    std::map<uint32_t, ColorBrickPtr> painted_;    ///< those that are not white
    std::shared_ptr<const FieldColors> colors_;    ///< null where they are to be made, or none is painted
    std::set<uint32_t> changed_;                   ///< since takeChangedBricks
    std::vector<Step> steps_;                      ///< strokes; the first `done_` are applied
    size_t done_ = 0;
    std::optional<Shaped> shaped_;
    FieldWindow window_, previewWindow_;
    DistanceRestorer restorer_;
};

} // namespace touchstone
