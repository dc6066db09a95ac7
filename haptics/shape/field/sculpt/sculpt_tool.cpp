#include "haptics/shape/field/sculpt/sculpt_tool.h"

#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

constexpr std::array<SculptToolInfo, 7> kSculptTools{{
    {SculptTool::Carve, "carve", "takes the ball out of the solid", SculptTool::Add},
    {SculptTool::Add, "add", "joins the ball to the solid", SculptTool::Carve},
    {SculptTool::Smooth, "smooth", "evens out what is smaller than the ball", SculptTool::Smooth},
    {SculptTool::Stamp, "stamp", "joins the shape of an object to the solid", SculptTool::Imprint},
    {SculptTool::Imprint, "imprint", "takes the shape of an object out of the solid", SculptTool::Stamp},
    {SculptTool::Drag, "drag", "moves the solid along with the tool", SculptTool::Drag},
    {SculptTool::Paint, "paint", "colours the surface within the ball", SculptTool::Paint},
}};

[[noreturn]] void refuseDab(const std::string& problem, const char* remedy) {
    throw Error("sculpting", "", problem, remedy);
}

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

} // namespace

std::span<const SculptToolInfo> sculptTools() {
    return kSculptTools;
}

const SculptToolInfo& infoOf(SculptTool tool) {
    return kSculptTools[static_cast<size_t>(tool)];
}

std::optional<SculptTool> sculptToolNamed(std::string_view name) {
    const auto found =
        std::ranges::find_if(kSculptTools, [&](const SculptToolInfo& info) { return name == info.name; });
    if (found == kSculptTools.end())
        return {};
    return found->tool;
}

void checkDab(const FieldGrid& grid, const Dab& dab) {
    const glm::ivec3& cells = grid.layout().cells;
    const double longest = grid.layout().voxel * std::max({cells.x, cells.y, cells.z});
    if (!isFinite(dab.centre) || !isFinite(dab.motion))
        refuseDab("a place is not a finite number", "check the journal");
    if (!(dab.radius > 0.0) || dab.radius > longest)
        refuseDab("the radius is not above 0 and at most the longest side of the field",
                  "choose a radius of some voxels");
    if (glm::length(dab.motion) > longest)
        refuseDab("the tool moves farther at once than the field is long", "divide the stroke");
    if (!(dab.strength > 0.0 && dab.strength <= 1.0))
        refuseDab("the strength is not above 0 and at most 1", "1 makes the whole change");
    if (!(dab.falloff >= 0.0 && dab.falloff <= 1.0))
        refuseDab("the falloff is not in 0..1", "0 has no soft rim, 1 is soft from the middle on");
    for (int k = 0; k < 3; ++k)
        if (!(dab.color[k] >= 0.0f && dab.color[k] <= 1.0f))
            refuseDab("a colour is not three numbers in 0..1", "give linear red, green and blue");
    const bool stamps = dab.tool == SculptTool::Stamp || dab.tool == SculptTool::Imprint;
    if (stamps && (dab.stamp == nullptr || !(dab.stamp->low().x < dab.stamp->high().x)))
        refuseDab("the tool has no stamp", "name an object with triangles");
}

double dabWeight(const Dab& dab, double rho) noexcept {
    if (dab.tool == SculptTool::Drag || dab.tool == SculptTool::Smooth) {
        // Wyvill's bell: no kink in the middle or at the rim, so none in what is dragged.
        const double rest = std::max(0.0, 1.0 - rho * rho);
        return rest * rest;
    }
    if (dab.falloff == 0.0)
        return 1.0;
    const double t = std::clamp((1.0 - rho) / dab.falloff, 0.0, 1.0);
    return t * t * (3.0 - 2.0 * t);
}

} // namespace touchstone
