#pragma once
// Recompiles edited materials on a worker while the servo continues.

#include "haptics/scene/haptic_scene.h"
#include "workbench/editor/material_edits.h"
#include "workbench/model/model.h"

#include <atomic>
#include <exception>
#include <optional>
#include <thread>

namespace touchstone {

/// The job of the worker.
struct MaterialJob {
    Model model; ///< the current model
    /// The materials that its haptic scene was compiled from, if they differ from its scene's; empty: they do
    /// not.
    std::vector<Material> compiledFrom;
    std::vector<HapticStatement> statements;
    std::string edits;          ///< MaterialPatches as text, relative to the file
    std::filesystem::path path; ///< the current file: it may have been saved under another name
    FileStamp stamp;
    uint64_t revision = 0;  ///< of the edits
    bool forTheEye = false; ///< also for the rendered scene
};

struct MadeMaterials {
    std::shared_ptr<HapticScene> haptic;
    std::vector<Material> materials; ///< those it was compiled from
    ScenePtr scene;                  ///< with those materials; null: not requested
    bool read = false;               ///< the file was reloaded, for maps that had not been decoded
    bool touchGoesOn = true;         ///< geometry unchanged: SceneSwap::SameGeometry
    uint64_t feltHash = 0;
    std::string edits;
    uint64_t revision = 0;
    double seconds = 0.0; ///< duration
};

/// Runs the whole job on the caller's thread; throws Error. Reloads the file only where a map changes or an
/// image is needed that was not decoded; otherwise geometry and maps are shared.
[[nodiscard]] MadeMaterials makeMaterials(const MaterialJob& job);

/// One job at a time on a worker thread. Main thread.
class LiveMaterials {
  public:
    LiveMaterials() = default;
    ~LiveMaterials();
    LiveMaterials(const LiveMaterials&) = delete;
    LiveMaterials& operator=(const LiveMaterials&) = delete;

    [[nodiscard]] bool busy() const { return worker_.joinable(); }
    void start(MaterialJob job); ///< only while not busy
    /// The finished result; rethrows an exception of the worker.
    [[nodiscard]] std::optional<MadeMaterials> take();
    void discard(); ///< waits for the worker and discards its result

  private:
    std::thread worker_;
    std::atomic<bool> finished_{false};
    std::optional<MadeMaterials> result_;
    std::exception_ptr failure_;
};

} // namespace touchstone
