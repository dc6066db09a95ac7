#pragma once

#include "renderer/scene_renderer.h"

#include <future>
#include <memory>

namespace touchstone {

/// Keeps what the eye sees up to edited materials. The eye needs them only where it shows what is felt; a
/// worker prepares them, and the renderer takes them in by slices as it does a new model. Main thread.
class DrawnMaterials {
  public:
    /// The renderer has this scene.
    void shown(ScenePtr scene);
    /// The images of what is shown are others: draw them whatever the view.
    void renew() { drawn_.reset(); }
    /// Another renderer draws from now on, and has nothing.
    void takeDevice() {
        drawn_.reset();
        redrawn_.reset();
    }
    /// Another model is being taken in.
    void interrupt() { redrawn_.reset(); }
    /// In every frame in which no other model is taken in. Throws what stopped it, once for a change.
    void update(SceneRenderer& renderer, const ScenePtr& scene, bool showsWhatIsFelt);

  private:
    ScenePtr drawn_;                                              // what the renderer has
    std::future<std::shared_ptr<const PreparedScene>> preparing_; // of the edited materials
    ScenePtr redrawn_;                                            // that the renderer is taking in for them
};

} // namespace touchstone
