#pragma once
// A model on its way from its file to the screen.

#include "renderer/scene_renderer.h"
#include "workbench/model/model_loader.h"

#include <filesystem>
#include <optional>
#include <string>

namespace touchstone {

/// A worker reads the model and compiles it for the hand; then the renderer takes it in, a slice a frame.
/// What is shown stays until the new one is there. Main thread.
class Opening {
  public:
    /// A second one replaces the first.
    void start(const std::filesystem::path& path, const DeviceLimits& limits, SceneRenderer& renderer);
    /// In every frame: the model in the frame in which the renderer shows it. Throws what stopped it, Error
    /// or std::bad_alloc; then it is over, but for DeviceLost.
    [[nodiscard]] std::optional<LoadedModel> update(SceneRenderer& renderer);
    void cancel(SceneRenderer& renderer);
    /// Another renderer draws from now on: what the one before was taking in begins again.
    void takeDevice(SceneRenderer& renderer);

    [[nodiscard]] bool busy() const { return loader_.loading() || uploading_.has_value(); }
    /// It has been read: the next updates will show it.
    [[nodiscard]] bool arriving() const { return loader_.finished() || uploading_.has_value(); }
    [[nodiscard]] bool uploading() const { return uploading_.has_value(); }
    [[nodiscard]] const std::filesystem::path& path() const { return loader_.path(); }
    [[nodiscard]] double fraction() const { return loader_.fraction(); } ///< 0..1
    [[nodiscard]] std::string activity() const { return loader_.activity(); }

  private:
    ModelLoader loader_;
    std::optional<LoadedModel> uploading_; // not shown yet
};

/// s of a frame in which the renderer takes a scene in.
inline constexpr double kUploadTime = 0.008;

} // namespace touchstone
