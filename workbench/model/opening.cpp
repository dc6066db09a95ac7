#include "workbench/model/opening.h"

#include <utility>

namespace touchstone {

void Opening::start(const std::filesystem::path& path, SceneRenderer& renderer, const SceneChoice& choice) {
    cancel(renderer);
    loader_.start(path, choice);
}

std::optional<LoadedModel> Opening::update(SceneRenderer& renderer) {
    try {
        if (std::optional<LoadedModel> loaded = loader_.take()) {
            uploading_ = std::move(loaded);
            renderer.beginScene(uploading_->prepared);
        }
        if (!uploading_ || !renderer.continueScene(kUploadTime))
            return std::nullopt;
        uploading_->prepared.reset();
        return std::exchange(uploading_, std::nullopt);
    } catch (const DeviceLost&) {
        throw; // continues on another device
    } catch (...) {
        uploading_.reset();
        throw;
    }
}

void Opening::takeDevice(SceneRenderer& renderer) {
    if (uploading_)
        renderer.beginScene(uploading_->prepared);
}

void Opening::cancel(SceneRenderer& renderer) {
    loader_.abandon();
    if (std::exchange(uploading_, std::nullopt))
        renderer.abandonScene();
}

} // namespace touchstone
