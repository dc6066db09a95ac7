#include "workbench/commands/stroke_outcome.h"

#include "engine/core/error.h"

#include <cstdio>
#include <string>

namespace touchstone {

void requireTouch(const std::filesystem::path& scene, const StrokeRequest& stroke, double period,
                  double seconds, uint64_t ticksInContact) {
    if (ticksInContact > 0)
        return;
    if (seconds >= period)
        throw Error(
            scene.string(), "", "the stroke '" + stroke.name + "' never touches the model",
            "choose another stroke (--stroke) or depth (--stroke-depth), or touch along a path of your "
            "own (touch --path)");
    std::fprintf(
        stderr,
        "touchstone: note: the stroke '%s' has not touched the model in %.3g s; once round takes %.3g s\n",
        stroke.name.c_str(), seconds, period);
}

} // namespace touchstone
