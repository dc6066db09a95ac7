#pragma once
// Draws a Scene and an Overlay into an image of its own. Headless and window share it.

#include "engine/scene/scene.h"
#include "renderer/environment.h"
#include "renderer/false_color.h"
#include "renderer/gpu.h"
#include "renderer/overlay.h"
#include "renderer/prepared_scene.h"
#include "renderer/view.h"

#include <glm/glm.hpp>

#include <memory>
#include <span>

namespace touchstone {

/// Two pictures of the same scene, each with its own size: the window's, and a small one over it.
enum class Eye : uint8_t { Main, Magnifier };

/// Main thread only. Two frames of each eye are in flight; `render` waits only when the one before the last
/// is unfinished.
class SceneRenderer {
  public:
    /// Compiles nothing that the scene does not call for: pipelines are made on first use.
    explicit SceneRenderer(Gpu& gpu);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// Uploads meshes and textures; waits for the frames in flight. Null: empty scene. Missing or broken base
    /// colours become grey. Throws Error when the device memory does not hold the scene; then the renderer is
    /// empty.
    void setScene(ScenePtr scene);

    /// The same in steps, for a window that must not wait: the scene before is drawn until `continueScene`
    /// says that the new one is there; it works for about `seconds`. A second beginScene replaces the first.
    /// Errors as in setScene, but what was drawn before stays.
    void beginScene(std::shared_ptr<const PreparedScene> prepared);
    [[nodiscard]] bool continueScene(double seconds);
    /// Forgets the scene that is being taken in; the one that is shown stays.
    void abandonScene();

    [[nodiscard]] bool hasScene() const; ///< there is something to draw

    /// Where the instances are now, one `sceneFromMesh` for each of Scene::instances; holds until the next
    /// call. Throws std::invalid_argument on another count.
    void setInstancePoses(std::span<const glm::dmat4> sceneFromMesh);

    /// sRGB (0..1) of each material of the scene, for ViewMode::Effects; grey where there are too few. Holds
    /// until the next call.
    void setMaterialColors(std::vector<glm::vec3> colors);

    /// Light of the surroundings from now on, in place of View::surroundings; null: theirs. Waits for the
    /// frames in flight. Throws Error when the device memory does not hold it; then the light stays what it
    /// was.
    void setEnvironment(std::shared_ptr<const Environment> environment);

    /// Records and submits one frame; returns without waiting for it. width, height: pixels, 1..16384
    /// (bounded by the device). Throws DeviceLost, and Error when the device is out of memory.
    void render(const View& view, const Overlay& overlay, int width, int height, Eye eye = Eye::Main);

    /// Waits for the last frame of the main eye and reads it: RGBA8, sRGB, rows from the top, alpha 255.
    /// Empty before the first.
    [[nodiscard]] PixelData readPixels();

    /// Of the false-colour view that was drawn last: what its colours stand for.
    [[nodiscard]] FalseColorScale falseColorScale() const;

    struct Statistics {
        uint64_t triangles = 0;      ///< of the scene, over the instances
        uint64_t drawCalls = 0;      ///< of the last frame
        uint64_t drawnTriangles = 0; ///< of the last frame, of what simplification left
        uint64_t pipelines = 0;      ///< compiled so far
        uint64_t deviceBytes = 0;    ///< device memory held for the scene
        double gpuSeconds = 0.0;     ///< of the last finished frame as the device measured it; 0: it cannot
        double waitSeconds = 0.0;    ///< that the last `render` waited for a frame in flight
    };
    [[nodiscard]] const Statistics& statistics() const;

    struct Impl;
    [[nodiscard]] Impl& impl() const { return *impl_; } ///< for renderer/ only

  private:
    std::unique_ptr<Impl> impl_;
};

/// One finished picture, anti-aliased by drawing at `supersampling` times the size (1..4, less where the
/// device's largest image demands it) and averaging in linear light.
[[nodiscard]] PixelData renderStill(SceneRenderer& renderer, const View& view, const Overlay& overlay,
                                    int width, int height, int supersampling = 2);

} // namespace touchstone
