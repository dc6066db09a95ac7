#include "haptics/servo/tool_path.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

constexpr double kGrowth = 0.75; // voxels: less than what takeUpReshaped lifts a proxy by

const PotentialField* fieldOf(const HapticScene& scene, int object) noexcept {
    if (object < 0 || static_cast<size_t>(object) >= scene.objects.size())
        return nullptr;
    const Shape* const shape = scene.objects[static_cast<size_t>(object)]->shape.get();
    return shape != nullptr ? shape->potential() : nullptr;
}

bool needsContact(SculptTool tool) noexcept {
    return tool == SculptTool::Add || tool == SculptTool::Smooth || tool == SculptTool::Paint;
}

bool isStamp(SculptTool tool) noexcept {
    return tool == SculptTool::Stamp || tool == SculptTool::Imprint;
}

/// A dab of the tool at a place in the object's frame.
SculptEntry entryOf(const LiveTool& tool, int object, uint64_t tick, const glm::dvec3& centre,
                    double radius) {
    return {.tool = tool.tool,
            .object = object,
            .stamp = tool.stamp,
            .tick = tick,
            .centre = centre,
            .radius = radius,
            .strength = tool.tool == SculptTool::Add ? 1.0 : tool.strength,
            .falloff = tool.falloff,
            .color = tool.color};
}

} // namespace

/// Chooses the object of a stroke. False where there is none yet.
bool ToolPath::begins(const LiveTool& tool, const HapticScene& scene, const HapticOutput& output) noexcept {
    const bool touched = output.contacts > 0 && fieldOf(scene, output.object) != nullptr;
    object_ = touched ? output.object : tool.object;
    return fieldOf(scene, object_) != nullptr && (touched || !needsContact(tool.tool)) &&
           (!isStamp(tool.tool) || tool.stamp >= 0);
}

size_t ToolPath::advance(const LiveTool& tool, bool pressed, const HapticScene& scene, ObjectMotions motions,
                         const TickInput& input, const HapticOutput& output,
                         std::span<SculptEntry, kMost> made) noexcept {
    if (!tool.active || !pressed || has(output.flags, TickFlag::InputInvalid)) {
        down_ = false;
        return 0;
    }
    const bool first = !down_;
    if (first && !begins(tool, scene, output))
        return 0;
    const PotentialField* const field = fieldOf(scene, object_);
    if (field == nullptr || (needsContact(tool.tool) && (output.contacts == 0 || output.object != object_)))
        return 0;
    const Similarity& place = motions[static_cast<size_t>(object_)].workspaceFromObject;
    const bool atProxy = needsContact(tool.tool) || (isStamp(tool.tool) && output.contacts > 0);
    glm::dvec3 centre = place.inversePoint(atProxy ? output.proxy : output.hip);
    const double radius = tool.radius / place.scale, voxel = field->voxel();
    if (tool.tool == SculptTool::Add) {
        const glm::dvec3 outwards = field->gradient(centre);
        const double steep = glm::length(outwards);
        if (!(steep > 0.0))
            return 0;
        centre -= (radius - std::min(kGrowth * tool.strength * voxel, radius)) * outwards / steep;
    }
    SculptEntry entry = entryOf(tool, object_, input.tick, centre, radius);
    size_t count = 0;
    rested_ += input.dt;
    const auto add = [&] {
        made[count++] = entry;
        last_ = entry.centre;
        rested_ = 0.0;
    };
    if (first) {
        down_ = true;
        made[count++] = {.kind = SculptEntryKind::Begin, .object = object_, .tick = input.tick};
        last_ = centre;
        if (tool.tool != SculptTool::Drag)
            add();
        return count;
    }
    if (isStamp(tool.tool))
        return 0;
    const glm::dvec3 from = last_, way = centre - from;
    const double spacing = std::max(0.25 * radius, 0.5 * voxel);
    const double parts = std::min(std::floor(glm::length(way) / spacing), static_cast<double>(kMost));
    for (double i = 1.0; i <= parts; ++i) {
        entry.centre = from + way * (i / parts);
        entry.motion = way / parts;
        add();
    }
    const bool repeats = needsContact(tool.tool) && tool.tool != SculptTool::Paint;
    if (count == 0 && repeats && rested_ >= kRepeat)
        add();
    return count;
}

} // namespace touchstone
