#include "workbench/commands/touch_sculpt.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "engine/import/mesh_file/surface_glb.h"
#include "haptics/shape/field/save/field_export.h"

#include <cstdio>
#include <string>
#include <string_view>
#include <utility>

namespace touchstone {

TouchSculpt::TouchSculpt(const std::filesystem::path& journal, std::shared_ptr<const HapticScene> scene)
    : steps_(readSculptJournal(journal)), sculptor_(std::move(scene)) {
    while (waits() && !steps_[next_].time)
        apply();
}

void TouchSculpt::apply() {
    const SculptReport one = sculptor_.apply(steps_[next_++]);
    all_.removed += one.removed;
    all_.dabs += one.dabs;
    all_.bricks += one.bricks;
}

bool TouchSculpt::applyUntil(double time) {
    if (!waits() || *steps_[next_].time > time)
        return false;
    const std::shared_ptr<const HapticScene> was = sculptor_.scene();
    while (waits() && *steps_[next_].time <= time)
        apply();
    if (sculptor_.scene() == was)
        return false;
    before_ = was;
    return true;
}

std::string TouchSculpt::hashText() const {
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sculptor_.hash()));
    return text;
}

nlohmann::ordered_json TouchSculpt::json() const {
    return {{"steps", next_},
            {"steps_left", steps_.size() - next_},
            {"dabs", all_.dabs},
            {"removed_m3", all_.removed},
            {"hash", hashText()}};
}

void TouchSculpt::finish(const std::vector<std::filesystem::path>& files) const {
    std::string first;
    for (const SculptStep& step : steps_)
        if (step.action == SculptAction::Stroke) {
            first = step.object;
            break;
        }
    for (const std::filesystem::path& file : files) {
        const size_t object = sculptor_.objectNamed(first);
        const Similarity place = sculptor_.sceneFromObject(object);
        const std::string& name = sculptor_.scene()->objects[object]->name;
        if (file.extension() == ".vdb") {
            writeFile(file, vdbOfField(*sculptor_.field(object), place, name));
            continue;
        }
        const SurfaceMesh mesh = meshOfField(sculptor_.field(object), place);
        if (mesh.corners.empty())
            throw Error(file.string(), "", "has no surface: everything was taken away", "undo a stroke");
        const std::vector<uint8_t> glb =
            glbOfSurface(mesh, name, "Touchstone " TOUCHSTONE_VERSION ", sculpted", file.string());
        writeFile(file, std::string_view(reinterpret_cast<const char*>(glb.data()), glb.size()));
        std::printf("%zu triangles, written to %s\n", mesh.corners.size() / 3, file.c_str());
    }
    std::printf("%zu strokes, %zu dabs, %.6g mm^3 removed, field %s\n", next_, all_.dabs, 1e9 * all_.removed,
                hashText().c_str());
    if (waits())
        std::fprintf(stderr, "touchstone: warning: %zu strokes come after the last tick\n",
                     steps_.size() - next_);
}

} // namespace touchstone
