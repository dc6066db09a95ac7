#include "workbench/editor/drawn_materials.h"

#include "workbench/model/opening.h"

#include <chrono>
#include <utility>
#include <vector>

namespace touchstone {

void DrawnMaterials::shown(ScenePtr scene) {
    drawn_ = std::move(scene);
    redrawn_.reset();
}

void DrawnMaterials::update(SceneRenderer& renderer, const ScenePtr& scene, bool needed) {
    const bool stale = drawn_ != scene && (drawn_ == nullptr || needed);
    if (stale && !preparing_.valid() && redrawn_ == nullptr)
        preparing_ = std::async(std::launch::async, [scene] { return prepareScene(scene); });
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
    std::vector<MaterialProgram> programs;
    for (const Material& material : materials)
        programs.push_back(material.haptic.program);
    renderer.setPrograms(programs);
    programs_ = now;
}

} // namespace touchstone
