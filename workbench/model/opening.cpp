#include "workbench/model/opening.h"

#include <utility>

namespace touchstone {

void Opening::start(const std::filesystem::path& path, const DeviceLimits& limits) {
    loader_.start(path, limits);
}

std::optional<LoadedModel> Opening::update(SceneRenderer& renderer) {
    try {
        if (std::optional<LoadedModel> loaded = loader_.take()) {
            renderer.beginScene(std::move(loaded->prepared));
            uploading_ = std::move(loaded);
        }
        if (uploading_ && renderer.continueScene(kUploadTime))
            return std::exchange(uploading_, std::nullopt);
        return std::nullopt;
    } catch (...) {
        uploading_.reset();
        throw;
    }
}

void Opening::cancel(SceneRenderer& renderer) {
    loader_.abandon();
    if (std::exchange(uploading_, std::nullopt))
        renderer.abandonScene();
}

} // namespace touchstone
