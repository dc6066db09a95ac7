// Dabs that are felt before they are made.

#include "haptics/shape/field/sculpt/sculptor.h"
#include "haptics/shape/field/sculpt/tool_values.h"

namespace touchstone {

/// The values of one side stay distances and those of the other bounds, whatever else is owed: the nearer of
/// two bounds is a bound.
DabReport Sculptor::preview(const Dab& dab) {
    check(dab);
    const double radius = changedRadius(*base_, dab);
    if (!isWholeBall(dab) || ballMisses(*base_, dab.centre, radius))
        return {};
    const std::shared_ptr<const FieldGrid> now = grid();
    const SculptZone zone =
        fillShapeWindow(previewWindow_, *now, dab.centre, radius, margin(), shapeMargin(dab.tool));
    (void)applyTool(previewWindow_, *base_, dab, zone);
    const Bricks made = changedBricks(previewWindow_, *now, changedNodes(previewWindow_));
    if (!made.empty()) {
        Bricks all = previewed_;
        for (const auto& [number, brick] : made) {
            all[number] = brick;
            changed_.insert(number);
        }
        preview_ = madeWith(all);
        previewed_ = std::move(all);
    }
    DabReport report;
    report.bricks = made.size();
    return report;
}

void Sculptor::dropPreviews() {
    for (const auto& [number, brick] : previewed_)
        changed_.insert(number);
    previewed_.clear();
    preview_ = nullptr;
}

} // namespace touchstone
