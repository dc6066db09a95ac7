#pragma once

#include "haptics/scene/haptic_scene.h"
#include "haptics/shape/field/save/field_blocks.h"
#include "renderer/scene_renderer.h"

#include <condition_variable>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <span>
#include <thread>
#include <vector>

namespace touchstone {

/// HapticScene::objects that are felt as fields with a texture (FieldTexture), which the drawn mesh lacks.
[[nodiscard]] std::vector<int> texturedFields(const HapticScene& felt, const Scene& drawn);

/// Draws them as they are felt, in place of the scene's meshes.
void drawTexturedFields(const HapticScene& felt, const Scene& drawn, SceneRenderer& renderer);

/// The surfaces of sculpted fields for the eye: a worker meshes the blocks that changed, the renderer draws
/// them in place of the scene's meshes. Main thread.
class SculptedSurface {
  public:
    SculptedSurface() = default;
    ~SculptedSurface();
    SculptedSurface(const SculptedSurface&) = delete;
    SculptedSurface& operator=(const SculptedSurface&) = delete;

    /// Another model.
    void forget();
    /// Meshes all blocks of an object that will be sculpted, once: the first edit then is seen as soon as the
    /// others.
    void prepare(const HapticScene& scene, int object, const Scene* drawn);
    /// Bricks (FieldGrid::brickNumber) of an object's field differ.
    void changed(const HapticScene& scene, int object, const Scene* drawn, std::span<const uint32_t> bricks);
    /// Every frame.
    void draw(SceneRenderer& renderer);

  private:
    struct Job {
        std::shared_ptr<const FieldGrid> grid;
        std::shared_ptr<const FieldColors> colors;
        std::vector<uint32_t> bricks;
        glm::dmat4 meshFromObject{1.0};
        bool shown = false; ///< it was sculpted
    };
    void add(const HapticScene& scene, int object, const Scene* drawn, std::span<const uint32_t> bricks,
             bool shown);
    void work();

    std::mutex mutex_; // of everything to the next empty line
    std::condition_variable wake_;
    bool stopping_ = false;
    uint64_t model_ = 0;      // results of earlier ones are dropped
    std::map<int, Job> jobs_; // by Scene::meshes
    std::map<int, std::shared_ptr<const ReshapedMesh>> made_;
    std::set<int> fresh_;

    std::thread worker_;
    std::set<int> prepared_; // HapticScene::objects
    uint64_t rendered_ = 0;  // SceneRenderer::sceneNumber of the last frame
};

} // namespace touchstone
