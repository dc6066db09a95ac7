#pragma once
// The panorama that --environment names, as the light of the picture.

#include "renderer/environment.h"
#include "renderer/scene_renderer.h"

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

/// Read and prefiltered by a worker; until it is there, and where the file is bad, the surroundings in closed
/// form are the light. Main thread.
class EnvironmentLight {
  public:
    EnvironmentLight() = default;
    ~EnvironmentLight() { cancel_ = true; } ///< waits for the worker, a few milliseconds
    EnvironmentLight(const EnvironmentLight&) = delete;
    EnvironmentLight& operator=(const EnvironmentLight&) = delete;

    /// Once. An empty path is no environment.
    void start(const std::filesystem::path& file);
    /// In every frame: gives the renderer what is ready. Once, what is wrong with the file.
    [[nodiscard]] std::optional<std::string> update(SceneRenderer& renderer);
    /// The renderer is another one and knows nothing.
    void takeDevice() { given_ = false; }

  private:
    std::atomic<bool> cancel_ = false;
    std::shared_ptr<const Environment> light_;
    bool given_ = false;
    std::future<std::shared_ptr<const Environment>> loading_; ///< last: it reads cancel_ until it ends
};

/// The same for a picture without a window: waits for it, and throws Error where the file is bad: the picture
/// would be another one than was asked for.
void lightWith(const std::filesystem::path& file, SceneRenderer& renderer);

} // namespace touchstone
