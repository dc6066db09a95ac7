#pragma once
// Edited materials made touchable on a worker, while the hand goes on touching what it touches.

#include "haptics/scene/haptic_scene.h"
#include "workbench/editor/material_edits.h"
#include "workbench/model/model.h"

#include <atomic>
#include <exception>
#include <optional>
#include <thread>

namespace touchstone {

/// What a worker is to make touchable.
struct MaterialJob {
    Model model; ///< as it is touched now
    /// What its haptic scene was compiled from, where that is not what its scene has; empty: it is.
    std::vector<Material> compiledFrom;
    std::vector<HapticStatement> statements;
    std::string edits;          ///< MaterialPatches as text, from the file
    std::filesystem::path path; ///< the file as it is now: it may have been saved under another name
    FileStamp stamp;
    uint64_t revision = 0;  ///< of the edits
    bool forTheEye = false; ///< the eye's scene too
};

struct MadeMaterials {
    std::shared_ptr<HapticScene> haptic;
    std::vector<Material> materials; ///< that it was compiled from
    ScenePtr scene;                  ///< with those materials; null: was not asked for
    bool read = false;               ///< the file was read anew, since maps came that nobody had needed
    bool touchGoesOn = true;         ///< no other geometry: SceneSwap::SameGeometry
    uint64_t feltHash = 0;
    std::string edits;
    uint64_t revision = 0;
    double seconds = 0.0; ///< that it took
};

/// Does the whole job on the caller's thread; throws Error. Reads the file anew only where a map changes or
/// an image is needed that was not decoded; else geometry and maps are shared.
[[nodiscard]] MadeMaterials makeMaterials(const MaterialJob& job);

/// One job at a time on a thread of its own. Main thread.
class LiveMaterials {
  public:
    LiveMaterials() = default;
    ~LiveMaterials();
    LiveMaterials(const LiveMaterials&) = delete;
    LiveMaterials& operator=(const LiveMaterials&) = delete;

    [[nodiscard]] bool busy() const { return worker_.joinable(); }
    void start(MaterialJob job); ///< only while not busy
    /// What has become ready; rethrows what went wrong.
    [[nodiscard]] std::optional<MadeMaterials> take();
    void discard(); ///< waits for the worker and forgets what it made

  private:
    std::thread worker_;
    std::atomic<bool> finished_{false};
    std::optional<MadeMaterials> result_;
    std::exception_ptr failure_;
};

} // namespace touchstone
