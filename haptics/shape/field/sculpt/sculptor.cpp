#include "haptics/shape/field/sculpt/sculptor.h"

#include "engine/core/error.h"
#include "haptics/shape/field/sculpt/tool_values.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <utility>

namespace touchstone {

namespace {

/// The part of a voxel around a node that lies inside, from its distance in voxels: exact for a plane at
/// right angles to an axis, and on average for any other.
double insideShare(double distance) {
    return std::clamp(0.5 - distance, 0.0, 1.0);
}

/// The surface moves in the zone only.
double removedVolume(const FieldWindow& window, const SculptZone& zone) {
    const glm::ivec3 low = zone.low(1.0, 0), high = zone.high(window, 1.0, 0);
    double voxels = 0.0;
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y)
            for (int x = low.x; x <= high.x; ++x) {
                const size_t index = window.index({x, y, z});
                voxels += insideShare(static_cast<double>(window.before[index]) / window.voxel) -
                          insideShare(static_cast<double>(window.value[index]) / window.voxel);
            }
    return voxels * window.voxel * window.voxel * window.voxel;
}

bool sameBytes(std::span<const float, kNodesInBrick> a, std::span<const float, kNodesInBrick> b) {
    return std::memcmp(a.data(), b.data(), a.size_bytes()) == 0;
}

} // namespace

Sculptor::Sculptor(std::shared_ptr<const FieldGrid> base) : base_(std::move(base)), grid_(base_) {}

std::shared_ptr<const FieldGrid> Sculptor::grid() {
    return preview_ != nullptr ? preview_ : made();
}

const std::shared_ptr<const FieldGrid>& Sculptor::made() {
    if (grid_ == nullptr)
        grid_ = madeWith({});
    return grid_;
}

std::shared_ptr<const FieldGrid> Sculptor::madeWith(const Bricks& previews) const {
    std::vector<BrickEdit> edits;
    edits.reserve(edits_.size() + previews.size());
    auto next = previews.begin();
    const auto addBefore = [&](uint64_t end) {
        for (; next != previews.end() && next->first < end; ++next)
            if (next->second != nullptr)
                edits.push_back({next->first, next->second});
    };
    for (const auto& [number, brick] : edits_) {
        addBefore(number);
        if (next == previews.end() || next->first != number)
            edits.push_back({number, brick});
    }
    addBefore(UINT64_MAX);
    return std::make_shared<const FieldGrid>(base_, std::move(edits));
}

void Sculptor::beginStroke() {
    restore(); // belongs to the stroke before
    steps_.resize(done_);
    if (done_ == 0 || !steps_.back().empty()) {
        steps_.emplace_back();
        ++done_;
    }
}

std::vector<Dab> Sculptor::partsOf(const Dab& dab) const {
    if (dab.tool != SculptTool::Drag)
        return {dab};
    constexpr double kMostMotion = 0.25; // of the radius: the bell's slope is at most 1.54 a radius
    const double radius = std::max(dab.radius, 0.1 * base_->layout().voxel); // bounds the number of parts
    const int count =
        std::max(1, static_cast<int>(std::ceil(glm::length(dab.motion) / (kMostMotion * radius))));
    std::vector<Dab> parts(static_cast<size_t>(count), dab);
    for (int i = 0; i < count; ++i) {
        Dab& part = parts[static_cast<size_t>(i)];
        part.motion = dab.motion / static_cast<double>(count);
        part.centre = dab.centre - dab.motion + part.motion * static_cast<double>(i + 1);
    }
    return parts;
}

double Sculptor::margin() const {
    return std::max(base_->inside(), base_->outside()) / base_->layout().voxel + 3.0;
}

/// A whole ball changes values on one side, as far as that side's distances go.
double Sculptor::shapeMargin(SculptTool tool) const {
    const double reach = tool == SculptTool::Carve ? base_->inside() : base_->outside();
    return reach / base_->layout().voxel + 3.0;
}

void Sculptor::check(const Dab& dab) const {
    checkDab(*base_, dab);
    if (dab.tool == SculptTool::Paint)
        return; // it needs no window
    FieldWindow window;
    for (const Dab& part : partsOf(dab)) {
        const double radius = changedRadius(*base_, part);
        if (!ballMisses(*base_, part.centre, radius))
            placeWindow(window, *base_, part.centre, radius, margin());
    }
}

DabReport Sculptor::apply(const Dab& dab) {
    check(dab);
    restore();
    if (done_ == 0 || done_ < steps_.size())
        beginStroke();
    if (dab.tool == SculptTool::Paint)
        return paint(dab);
    DabReport all;
    for (const Dab& part : partsOf(dab)) {
        const DabReport one = applyOnce(part);
        all.removed += one.removed;
        all.bricks += one.bricks;
        if (!one.changed.empty()) {
            all.changed.include(one.changed.low);
            all.changed.include(one.changed.high);
        }
    }
    return all;
}

DabReport Sculptor::applyOnce(const Dab& dab) {
    const double radius = changedRadius(*base_, dab);
    if (ballMisses(*base_, dab.centre, radius))
        return {};
    const SculptZone zone = fillWindow(window_, *made(), *made(), dab.centre, radius, margin());
    const ExactSide exact = applyTool(window_, *base_, dab, zone);
    return committed(zone, restorer_.run(window_, zone, {base_->inside(), base_->outside()}, exact));
}

Sculptor::Shaped Sculptor::joined(const Dab& dab) const {
    Shaped all{.before = grid_, .centre = dab.centre, .radius = changedRadius(*base_, dab), .tool = dab.tool};
    if (!shaped_)
        return all;
    const glm::dvec3 way = all.centre - shaped_->centre;
    const double apart = glm::length(way);
    all.before = shaped_->before;
    if (apart + all.radius <= shaped_->radius) {
        all.centre = shaped_->centre;
        all.radius = shaped_->radius;
    } else if (apart + shaped_->radius > all.radius) { // else the new ball contains the old one
        const double radius = 0.5 * (apart + all.radius + shaped_->radius);
        all.centre = shaped_->centre + way * ((radius - shaped_->radius) / apart);
        all.radius = radius;
    }
    return all;
}

bool Sculptor::joins(const Dab& dab) const {
    constexpr double kLargest = 1.75; // of the dab's own zone: six dabs in a row
    if (!isWholeBall(dab) || !shaped_ || shaped_->tool != dab.tool)
        return false;
    const Shaped all = joined(dab);
    if (all.radius > kLargest * changedRadius(*base_, dab))
        return false;
    FieldWindow window;
    try {
        placeWindow(window, *base_, all.centre, all.radius, margin());
    } catch (const Error&) {
        return false; // too many nodes
    }
    return true;
}

DabReport Sculptor::shape(const Dab& dab) {
    if (!isWholeBall(dab))
        return apply(dab);
    check(dab);
    if (!joins(dab))
        restore();
    dropPreviews();
    if (done_ == 0 || done_ < steps_.size())
        beginStroke();
    const double radius = changedRadius(*base_, dab);
    if (ballMisses(*base_, dab.centre, radius))
        return {};
    const std::shared_ptr<const FieldGrid> now = made();
    Shaped shaped = joined(dab);
    const SculptZone zone =
        fillShapeWindow(window_, *now, dab.centre, radius, margin(), shapeMargin(dab.tool));
    shaped.exact = applyTool(window_, *base_, dab, zone);
    const std::vector<NodeBox> changed = changedNodes(window_);
    if (!changed.empty())
        shaped_ = std::move(shaped);
    return committed(zone, changed);
}

DabReport Sculptor::restore(const std::function<void()>& meanwhile) {
    if (!shaped_) {
        dropPreviews();
        return {};
    }
    const Shaped shaped = *shaped_; // still owed where something throws
    const std::shared_ptr<const FieldGrid> now = made();
    const SculptZone zone = fillWindow(window_, *shaped.before, *now, shaped.centre, shaped.radius, margin());
    // Nodes that the shape changed and the restoration puts back are committed, too: else bricks that share
    // such a node keep two values.
    std::vector<NodeBox> changed = changedNodes(window_);
    const std::vector<NodeBox> restored =
        restorer_.run(window_, zone, {base_->inside(), base_->outside()}, shaped.exact, meanwhile);
    changed.insert(changed.end(), restored.begin(), restored.end());
    DabReport report = committed(zone, changed);
    shaped_.reset();
    dropPreviews();
    report.removed = 0.0; // `shape` has told it
    return report;
}

DabReport Sculptor::committed(const SculptZone& zone, const std::vector<NodeBox>& changed) {
    DabReport report;
    if (changed.empty())
        return report;
    report.removed = removedVolume(window_, zone);
    report.bricks = commit(changed);
    const double voxel = base_->layout().voxel;
    const auto place = [&](const glm::ivec3& node) {
        return base_->layout().origin + voxel * glm::dvec3(window_.first + node);
    };
    for (const NodeBox& box : changed) {
        report.changed.include(place(box.low));
        report.changed.include(place(box.high));
    }
    return report;
}

Sculptor::BrickPtr Sculptor::current(uint32_t number) const {
    const auto found = edits_.find(number);
    return found != edits_.end() ? found->second : nullptr;
}

std::vector<uint32_t> Sculptor::takeChangedBricks() {
    const std::set<uint32_t> changed = std::exchange(changed_, {});
    return {changed.begin(), changed.end()};
}

void Sculptor::replace(uint32_t number, const BrickPtr& brick) {
    changed_.insert(number);
    if (brick == nullptr)
        edits_.erase(number);
    else
        edits_[number] = brick;
}

/// All bricks that have changed nodes: those at the faces of a brick belong to its neighbours, too. Null: the
/// base's brick.
Sculptor::Bricks Sculptor::changedBricks(const FieldWindow& window, const FieldGrid& from,
                                         const std::vector<NodeBox>& changed) const {
    std::set<std::array<int, 3>> bricks;
    for (const NodeBox& box : changed) {
        const glm::ivec3 low = glm::max(window.first + box.low - 1, glm::ivec3(0)) / kBrickCells;
        const glm::ivec3 high = glm::min((window.first + box.high) / kBrickCells, base_->bricks() - 1);
        for (int z = low.z; z <= high.z; ++z)
            for (int y = low.y; y <= high.y; ++y)
                for (int x = low.x; x <= high.x; ++x)
                    bricks.insert({z, y, x});
    }
    Bricks made;
    for (const auto& [z, y, x] : bricks)
        if (std::optional<BrickPtr> brick = changedBrick(window, from, {x, y, z}))
            made.emplace(base_->brickNumber({x, y, z}), std::move(*brick));
    return made;
}

/// A brick of `from` with the window's values, where they differ.
std::optional<Sculptor::BrickPtr> Sculptor::changedBrick(const FieldWindow& window, const FieldGrid& from,
                                                         const glm::ivec3& brick) const {
    std::array<float, kNodesInBrick> before, after, base;
    from.copyBrick(brick, before);
    after = before;
    const glm::ivec3 first = kBrickCells * brick;
    const glm::ivec3 low = glm::max(window.first - first, glm::ivec3(0));
    const glm::ivec3 high = glm::min(window.first + window.size - 1 - first, glm::ivec3(kBrickCells));
    // The last node of a row belongs to the next brick, unless the window ends there.
    const auto copy = [&](const glm::ivec3& begin, int end) {
        const glm::ivec3 node = first + begin - window.first;
        if (begin.x > end || !window.cellIsActive(node))
            return;
        const float* const values = &window.value[window.index(node)];
        float* const to = &after[brickNode(begin)];
        copyRow(values, end - begin.x + 1, to);
    };
    for (int z = low.z; z <= high.z; ++z)
        for (int y = low.y; y <= high.y; ++y) {
            copy({low.x, y, z}, std::min(high.x, kBrickCells - 1));
            copy({kBrickCells, y, z}, high.x);
        }
    if (sameBytes(before, after))
        return std::nullopt;
    base_->copyBrick(brick, base);
    if (sameBytes(after, base))
        return nullptr;
    return editedBrick(first, glm::min(glm::ivec3(kBrickCells), base_->layout().cells - first), after);
}

size_t Sculptor::commit(const std::vector<NodeBox>& changed) {
    const Bricks made = changedBricks(window_, *grid_, changed);
    for (const auto& [number, brick] : made) {
        const auto [place, isNew] =
            steps_.back().values.try_emplace(number, Replaced{current(number), brick});
        if (!isNew)
            place->second.after = brick;
        replace(number, brick);
    }
    if (!made.empty())
        grid_ = nullptr;
    return made.size();
}

void Sculptor::goBackOrOn(const Step& step, bool back) {
    for (const auto& [number, replaced] : step.values)
        replace(number, back ? replaced.before : replaced.after);
    for (const auto& [number, recolored] : step.colors)
        recolor(number, back ? recolored.before : recolored.after);
    if (!step.values.empty())
        grid_ = edits_.empty() ? base_ : nullptr;
}

bool Sculptor::undo() {
    restore(); // belongs to the stroke
    while (done_ > 0 && steps_[done_ - 1].empty())
        --done_;
    if (done_ == 0)
        return false;
    goBackOrOn(steps_[--done_], true);
    return true;
}

bool Sculptor::redo() {
    restore();
    while (done_ < steps_.size() && steps_[done_].empty())
        ++done_;
    if (done_ == steps_.size())
        return false;
    goBackOrOn(steps_[done_++], false);
    return true;
}

size_t Sculptor::undoSteps() const {
    return static_cast<size_t>(std::count_if(steps_.begin(), steps_.begin() + static_cast<ptrdiff_t>(done_),
                                             [](const Step& step) { return !step.empty(); }));
}

size_t Sculptor::redoSteps() const {
    return static_cast<size_t>(std::count_if(steps_.begin() + static_cast<ptrdiff_t>(done_), steps_.end(),
                                             [](const Step& step) { return !step.empty(); }));
}

uint64_t Sculptor::memoryBytes() const {
    std::set<const EditedBrick*> bricks;
    std::set<const ColorBrick*> colors;
    for (const Step& step : steps_) {
        for (const auto& [number, replaced] : step.values) {
            bricks.insert(replaced.before.get());
            bricks.insert(replaced.after.get());
        }
        for (const auto& [number, recolored] : step.colors) {
            colors.insert(recolored.before.get());
            colors.insert(recolored.after.get());
        }
    }
    for (const auto& [number, brick] : previewed_)
        bricks.insert(brick.get());
    bricks.erase(nullptr);
    colors.erase(nullptr);
    return bricks.size() * sizeof(EditedBrick) + colors.size() * sizeof(ColorBrick);
}

} // namespace touchstone
