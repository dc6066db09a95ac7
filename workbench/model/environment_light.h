#pragma once
// The panorama of --environment as the light of the picture.

#include "renderer/environment.h"
#include "renderer/scene_renderer.h"

#include <atomic>
#include <filesystem>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace touchstone {

/// A worker reads and prefilters it; until then, and for an invalid file, the closed-form surroundings are
/// the light. Main thread.
class EnvironmentLight {
  public:
    EnvironmentLight() = default;
    ~EnvironmentLight() { cancel_ = true; } ///< waits for the worker, a few milliseconds
    EnvironmentLight(const EnvironmentLight&) = delete;
    EnvironmentLight& operator=(const EnvironmentLight&) = delete;

    /// Once. Empty path: no environment.
    void start(const std::filesystem::path& file);
    /// Every frame: passes the result to the renderer. Returns the problem with the file, once.
    [[nodiscard]] std::optional<std::string> update(SceneRenderer& renderer);
    /// A new renderer without an environment.
    void takeDevice() { given_ = false; }

  private:
    std::atomic<bool> cancel_ = false;
    std::shared_ptr<const Environment> light_;
    bool given_ = false;
    std::future<std::shared_ptr<const Environment>> loading_; ///< last: it reads cancel_ until it ends
};

/// For a picture without a window: waits for the result. Throws Error for an invalid file, since the picture
/// would differ from the request.
void lightWith(const std::filesystem::path& file, SceneRenderer& renderer);

} // namespace touchstone
