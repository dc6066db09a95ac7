#pragma once
// Draws a Scene and an Overlay into its own image. Shared by headless rendering and the window.

#include "engine/scene/mesh_deformation.h"
#include "engine/scene/scene.h"
#include "renderer/environment.h"
#include "renderer/false_color.h"
#include "renderer/gpu.h"
#include "renderer/overlay.h"
#include "renderer/persistent_texels.h"
#include "renderer/prepared_scene.h"
#include "renderer/reshaped_mesh.h"
#include "renderer/view.h"

#include <glm/glm.hpp>

#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// Two pictures of the same scene, each with its own size: the window's, and a small inset.
enum class Eye : uint8_t { Main, Magnifier };

/// What renderKept drew.
enum class PictureState : uint8_t {
    Coarse,   ///< a whole frame of the coarse size: something has changed since the last one
    Refining, ///< the same, and a part of the picture to be kept
    Kept,     ///< a frame of the full size over the kept picture
};

/// Main thread only. Two frames of each eye are in flight; `render` waits only when the last but one is
/// unfinished.
class SceneRenderer {
  public:
    /// Compiles nothing in advance: pipelines are created at first use.
    explicit SceneRenderer(Gpu& gpu);
    ~SceneRenderer();
    SceneRenderer(const SceneRenderer&) = delete;
    SceneRenderer& operator=(const SceneRenderer&) = delete;

    /// For a window, before its first frame: draws what no scene decides (background, overlays, the shadow
    /// over a kept picture) once, unseen, since drivers compile shaders at their first draw. 0.3 s where the
    /// CPU draws and has compiled none yet.
    void warmUp();

    /// Uploads meshes and textures; waits for the frames in flight. Null: empty scene. Missing or broken base
    /// colours become grey. Throws Error when the device memory does not hold the scene; then the renderer is
    /// empty.
    void setScene(ScenePtr scene);

    /// The same in steps, for a window that must not block: the current scene is drawn until `continueScene`
    /// returns that the new one is complete; a step takes about `seconds`. A second beginScene replaces the
    /// first. Errors as in setScene, but the current scene stays.
    void beginScene(std::shared_ptr<const PreparedScene> prepared);
    [[nodiscard]] bool continueScene(double seconds);
    /// Cancels the upload of a scene; the current one stays.
    void abandonScene();

    [[nodiscard]] bool hasScene() const; ///< there is something to draw

    /// Current poses, one `sceneFromMesh` for each of Scene::instances; valid until the next call. Throws
    /// std::invalid_argument for another count.
    void setInstancePoses(std::span<const glm::dmat4> sceneFromMesh);

    /// Current vertices of a deforming mesh (Scene::meshes); valid until the next call. Ignores another
    /// count.
    void setMeshVertices(int mesh, const DrawnVertices& vertices);

    /// Draws other triangles in place of those of a mesh (Scene::meshes) of the current scene, until the next
    /// scene: what is sculpted. With the mesh's material; its textures keep no coordinates. Once a frame at
    /// most. Throws Error when the device memory does not hold them.
    void reshape(int mesh, const ReshapedMesh& reshaped);
    /// Of the current scene, unique in the process; 0: there was none.
    [[nodiscard]] uint64_t sceneNumber() const;

    /// sRGB (0..1) of each material of the scene, for ViewMode::Effects; grey where there are too few. Valid
    /// until the next call.
    void setMaterialColors(std::vector<glm::vec3> colors);

    /// The haptic program of each material, in place of the file's; until another scene. Waits for the frames
    /// in flight where they differ from the last ones. Throws std::invalid_argument for another count.
    void setPrograms(const std::vector<MaterialProgram>& programs);
    /// A part of an instance's persistent texture as touch has made it; until another scene, or until
    /// programs with other textures. Ignored where the instance has no texture of that size. May be seen at
    /// once, also in a frame in flight.
    void setTexels(const PersistentTexels& texels);
    /// Empty, or why a program that was to be drawn is not: its surfaces look plain.
    [[nodiscard]] std::string programProblem(const std::shared_ptr<const SurfaceProgram>& program) const;

    /// The surrounding light from now on, instead of View::surroundings; null: those. Waits for the frames in
    /// flight. Throws Error when the device memory does not hold it; then the light is unchanged.
    void setEnvironment(std::shared_ptr<const Environment> environment);

    /// Records and submits one frame; returns without waiting for it. width, height: pixels, 1..16384
    /// (bounded by the device). Throws DeviceLost, and Error when the device is out of memory.
    void render(const View& view, const Overlay& overlay, int width, int height, Eye eye = Eye::Main);

    /// For a CPU that draws: a frame of the main eye in which a picture of the full size is kept. While view,
    /// scene or an object's pose changes, `coarse` pixels are drawn, as by `render`. Once nothing of that has
    /// changed since the last frame, so are steps of about 10 ms of the picture of all opaque objects that
    /// rest, with the full mesh (not View::allowedError); and when it is complete, frames of `full` pixels
    /// copy it and draw only the probe's shadow, moving and blended objects and the overlay. An object that
    /// has moved is drawn in each frame until the picture is begun anew. With View::wireframe nothing is
    /// kept: `full` pixels are drawn in each frame. Sizes and errors as in `render`.
    [[nodiscard]] PictureState renderKept(const View& view, const Overlay& overlay, const glm::ivec2& coarse,
                                          const glm::ivec2& full);

    /// Waits for the last frame of the main eye and reads it: RGBA8, sRGB, rows from the top, alpha 255.
    /// Empty before the first.
    [[nodiscard]] PixelData readPixels();

    /// The scale of the last false-colour view drawn.
    [[nodiscard]] FalseColorScale falseColorScale() const;

    struct Statistics {
        uint64_t triangles = 0;      ///< of the scene, over the instances
        uint64_t drawCalls = 0;      ///< of the last frame
        uint64_t drawnTriangles = 0; ///< of the last frame, after simplification
        uint64_t pipelines = 0;      ///< compiled so far
        uint64_t deviceBytes = 0;    ///< device memory held for the scene
        double gpuSeconds = 0.0;     ///< device time of the last finished frame; 0: not measurable
        double waitSeconds = 0.0;    ///< time that the last `render` waited for a frame in flight
    };
    [[nodiscard]] const Statistics& statistics() const;

    struct Impl;
    [[nodiscard]] Impl& impl() const { return *impl_; } ///< for renderer/ only

  private:
    std::unique_ptr<Impl> impl_;
};

/// Draws a scene once, unseen, on a device of its own with this name (as in GpuOptions), so that a driver of
/// a CPU that draws has its shaders in the cache on disk before a window needs them. What fails is left out.
/// Any thread; 0.1 s, and 0.3 s for each new kind of material.
void compileAhead(const std::string& device, const std::shared_ptr<const PreparedScene>& prepared) noexcept;
/// The same for programs that the materials of a scene are to have, one for each: the drivers of CPUs that
/// draw compile some for seconds (6 s for indices that are computed).
void compileAhead(const std::string& device, const Scene& scene,
                  const std::vector<MaterialProgram>& programs) noexcept;

/// One finished picture, anti-aliased by rendering at `supersampling` times the size (1..4, less where the
/// device's maximum image size or 67 million drawn pixels require it) and averaging in linear light. Waits
/// for it. Its time does not count in the statistics. Throws Error where the device draws no picture of that
/// size, or its memory holds none.
[[nodiscard]] PixelData renderStill(SceneRenderer& renderer, const View& view, const Overlay& overlay,
                                    int width, int height, int supersampling = 2);

} // namespace touchstone
