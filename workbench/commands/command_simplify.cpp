// Writes a model with as few triangles as an angle between facets allows.

#include "study/perception/reduced_model.h"
#include "workbench/files/geometry_file.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

#include <cstdio>

namespace touchstone {

int simplifyCommand(const SimplifyOptions& options) {
    const Model model = loadModelToTouch(options.scene, Fit::Workspace, nullptr, options.iso);
    printWarnings(model);
    if (!model.scene->animations.empty())
        std::fprintf(stderr, "%s: its animation is left out: what is simplified is the static pose\n",
                     options.scene.c_str());
    const study::ReducedModel reduced =
        study::reducedTo(*model.scene, model.workspaceFromScene, options.degrees);
    std::printf("%s: %zu triangles, nine smooth edges of ten within %.3g degrees\n", options.scene.c_str(),
                reduced.before, reduced.angleBefore);
    std::printf("  within %.3g degrees: %zu triangles (%.3g %%), nine of ten within %.3g, %zu edges beyond\n",
                options.degrees, reduced.after,
                100.0 * static_cast<double>(reduced.after) / static_cast<double>(reduced.before),
                reduced.angle, reduced.edgesBeyond);
    if (reduced.after == reduced.before)
        std::printf("  none of the levels tried has fewer: seams and creases stay\n");
    else
        std::printf("  measured at %zu places of both surfaces: at most %.3g mm apart, %.3g mm on average\n",
                    reduced.places, 1e3 * reduced.largest, 1e3 * reduced.mean);
    if (!options.out.empty()) {
        writeGeometry(options.out, *reduced.scene);
        std::printf("saved to %s: geometry and names of materials\n", options.out.c_str());
    }
    return 0;
}

} // namespace touchstone
