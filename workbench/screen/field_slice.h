#pragma once
// A field in a slice, as [002, Figure 4] shows it: isolines and arrows along the gradient.

#include "renderer/overlay.h"

#include <cstddef>
#include <memory>
#include <string>

namespace touchstone {

class HapticScene;

/// Across an axis of the scene. Plain data.
struct FieldSlice {
    int axis = -1;   ///< 0, 1, 2: across x, y or z; -1: none is shown
    double at = 0.5; ///< 0..1 of the fields' extent along the axis
    bool operator==(const FieldSlice&) const = default;
};

/// What a slice shows.
struct SliceFigures {
    double place = 0.0;   ///< m, scene frame, along the axis
    double spacing = 0.0; ///< m, of the isolines; 0: nothing is felt as a field
    size_t lines = 0, arrows = 0;
    /// "field across z at 1.2 mm, isolines every 2 mm"
    [[nodiscard]] std::string label(const FieldSlice& slice) const;
};

/// Isolines of the field in the slice, by marching squares on a lattice of kSliceCells a side: that of the
/// surface is white, those outside are orange, those inside blue, kIsolines at most on each side as far as
/// the field tells distances. Arrows along the gradient that is felt [002 section 3.2], one every
/// kArrowCells, wherever it has a length. Objects as the scene places them at rest. Main thread.
[[nodiscard]] SliceFigures drawFieldSlice(const HapticScene& scene, const FieldSlice& slice, float pixelScale,
                                          Overlay& overlay);

inline constexpr int kSliceCells = 120, kArrowCells = 5, kIsolines = 6;

/// The slice of the last frames: drawn anew where the field, the slice or the scale differ. Main thread.
class FieldSliceView {
  public:
    /// Appends to `overlay`.
    void draw(const std::shared_ptr<const HapticScene>& scene, const FieldSlice& slice, float pixelScale,
              Overlay& overlay);
    /// Empty where none is shown.
    [[nodiscard]] const std::string& label() const { return label_; }

  private:
    std::shared_ptr<const HapticScene> scene_; ///< null: nothing is drawn yet
    FieldSlice slice_;
    float pixelScale_ = 0.0f;
    Overlay drawn_;
    std::string label_;
};

} // namespace touchstone
