#pragma once
// Opens a model: from its file to the screen.

#include "renderer/scene_renderer.h"
#include "workbench/model/model_loader.h"

#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

/// A worker reads the model and compiles it for haptics; then the renderer uploads it, a slice per frame. The
/// current model stays until the new one is ready. Main thread.
class Opening {
  public:
    /// As ModelLoader::compileFor.
    void compileFor(std::string device) { loader_.compileFor(std::move(device)); }
    /// A second call replaces the first.
    void start(const std::filesystem::path& path, SceneRenderer& renderer, const SceneChoice& choice = {});
    /// Every frame: returns the model in the frame in which the renderer shows it. Throws the failure, Error
    /// or std::bad_alloc, which ends the opening; DeviceLost does not.
    [[nodiscard]] std::optional<LoadedModel> update(SceneRenderer& renderer);
    void cancel(SceneRenderer& renderer);
    /// A new renderer: an upload in progress restarts.
    void takeDevice(SceneRenderer& renderer);

    [[nodiscard]] bool busy() const { return loader_.loading() || uploading_.has_value(); }
    /// Loaded: the next updates will show it.
    [[nodiscard]] bool arriving() const { return loader_.finished() || uploading_.has_value(); }
    [[nodiscard]] bool uploading() const { return uploading_.has_value(); }
    [[nodiscard]] const std::filesystem::path& path() const { return loader_.path(); }
    [[nodiscard]] double fraction() const { return loader_.fraction(); } ///< 0..1
    [[nodiscard]] std::string activity() const { return loader_.activity(); }

  private:
    ModelLoader loader_;
    std::optional<LoadedModel> uploading_; // not shown yet
};

/// s per frame for uploading a scene.
inline constexpr double kUploadTime = 0.008;

} // namespace touchstone
