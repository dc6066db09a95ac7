#include "workbench/editor/drawn_materials.h"

#include "workbench/model/opening.h"

#include <algorithm>
#include <chrono>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

std::vector<std::shared_ptr<const SurfaceProgram>>
distinctPrograms(const std::vector<MaterialProgram>& programs) {
    std::vector<std::shared_ptr<const SurfaceProgram>> distinct;
    for (const MaterialProgram& program : programs)
        if (program && std::ranges::find(distinct, program.compiled) == distinct.end())
            distinct.push_back(program.compiled);
    return distinct;
}

std::vector<MaterialProgram> programsOf(std::span<const Material> materials) {
    std::vector<MaterialProgram> programs;
    for (const Material& material : materials)
        programs.push_back(material.haptic.program);
    return programs;
}

} // namespace

void DrawnMaterials::shown(ScenePtr scene) {
    drawn_ = std::move(scene);
    redrawn_.reset();
    compiled_ = distinctPrograms(programsOf(drawn_->materials)); // while it was opened
}

void DrawnMaterials::update(SceneRenderer& renderer, const ScenePtr& scene, bool needed) {
    const bool stale = drawn_ != scene && (drawn_ == nullptr || needed);
    if (stale && !preparing_.valid() && redrawn_ == nullptr) {
        const std::string ahead = compiled(programsOf(scene->materials)) ? "" : device_;
        preparing_ = std::async(std::launch::async, [scene, ahead] {
            auto prepared = prepareScene(scene);
            if (!ahead.empty())
                compileAhead(ahead, prepared);
            return prepared;
        });
    }
    try {
        if (preparing_.valid() && preparing_.wait_for(std::chrono::seconds(0)) == std::future_status::ready) {
            const std::shared_ptr<const PreparedScene> prepared = preparing_.get();
            if (prepared->scene == scene) { // else another change arrived meanwhile
                redrawn_ = prepared->scene;
                renderer.beginScene(prepared);
            }
        }
        if (redrawn_ != nullptr && renderer.continueScene(kUploadTime)) {
            drawn_ = std::exchange(redrawn_, nullptr);
            compiled_ = distinctPrograms(programsOf(drawn_->materials));
            ++redraws_;
        }
    } catch (const DeviceLost&) {
        throw;
    } catch (...) {
        redrawn_.reset();
        drawn_ = scene; // not again until the next change
        throw;
    }
}

void DrawnMaterials::showPrograms(SceneRenderer& renderer, std::span<const Material> materials,
                                  uint64_t revision) {
    const std::pair now(renderer.sceneNumber(), revision);
    if (drawn_ == nullptr || programs_ == now || drawn_->materials.size() != materials.size())
        return;
    std::vector<MaterialProgram> programs = programsOf(materials);
    if (compiling_.valid()) {
        if (compiling_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
            return;
        compiling_.get();
        // Shown although newer ones may have come: those that are typed would not be seen before the typing
        // ends.
        if (ahead_.of.first == now.first) {
            renderer.setPrograms(ahead_.all);
            programs_ = ahead_.of;
            compiled_ = distinctPrograms(ahead_.all);
        }
        return;
    }
    if (device_.empty() || compiled(programs)) {
        renderer.setPrograms(programs);
        programs_ = now;
        return;
    }
    ahead_ = {now, std::move(programs)};
    compiling_ = std::async(std::launch::async, [device = device_, scene = drawn_, all = ahead_.all] {
        compileAhead(device, *scene, all);
    });
}

bool DrawnMaterials::compiled(const std::vector<MaterialProgram>& programs) const {
    return std::ranges::all_of(programs, [&](const MaterialProgram& program) {
        return !program || std::ranges::find(compiled_, program.compiled) != compiled_.end();
    });
}

} // namespace touchstone
