#include "workbench/timeline/recorded_scenes.h"

#include "engine/core/error.h"
#include "workbench/model/default_scene.h"
#include "workbench/model/model.h"

#include <system_error>
#include <utility>

namespace touchstone {

std::optional<std::filesystem::path> findRecordedScene(const std::filesystem::path& recording,
                                                       const SceneIdentity& scene) {
    std::error_code ignored;
    const std::filesystem::path beside =
        recording.parent_path() / std::filesystem::path(scene.path).filename();
    for (const std::filesystem::path& path :
         {std::filesystem::path(scene.absolutePath), std::filesystem::path(scene.path), beside,
          scene.generated ? defaultScene() : std::filesystem::path()})
        if (!path.empty() && std::filesystem::is_regular_file(path, ignored))
            return path;
    return std::nullopt;
}

std::string FoundScene::change() const {
    if (!sameFelt)
        return sameFile ? "is the same file, but this build makes something else of it: the ticks "
                          "will differ"
                        : "has changed since it was touched: what is felt is not the same, so the "
                          "ticks will differ";
    return sameFile ? "" : "has changed since it was touched, but nothing that is felt";
}

FoundScene loadRecordedScene(const RecordedScene& recorded, const std::filesystem::path& path,
                             const std::atomic<bool>* cancel) {
    LoadOptions loading;
    loading.edits = recorded.identity.edits;
    loading.images.visual = false;
    loading.cancel = cancel;
    Model model = loadModel(path, recorded.identity.fit, loading);
    takePart(model, recorded.identity.part);
    const SceneIdentity now = identityOf(model, recorded.identity.fit);
    return {.recorded = recorded,
            .path = path,
            .sameFile = now.fileHash == recorded.identity.fileHash,
            .sameFelt = now.feltHash == recorded.identity.feltHash,
            .scene = {model.haptic, model.scene}};
}

FoundScene RecordedSceneShelf::get(const RecordedScene& recorded) {
    const std::lock_guard lock(mutex_);
    const auto found = loaded_.find(recorded.number);
    if (found != loaded_.end())
        return found->second;
    const std::optional<std::filesystem::path> path = findRecordedScene(recording_, recorded.identity);
    if (!path)
        throw Error(recorded.identity.absolutePath.empty() ? recorded.identity.path
                                                           : recorded.identity.absolutePath,
                    "", "the scene that was touched is not there", "put it beside the recording");
    return loaded_.emplace(recorded.number, loadRecordedScene(recorded, *path)).first->second;
}

} // namespace touchstone
