#pragma once
// Puts a shape on the bench and strokes it: scenes in code, offline ticks, no files.

#include "assets/shapes.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/haptic_step.h"

#include <functional>
#include <memory>
#include <vector>

namespace touchstone::test {

/// A scene of one mesh from a shape, in scene metres; the material is the glTF default. `faceNormals`: where
/// the shape has no normals, one per triangle.
[[nodiscard]] Scene sceneOf(const assets::Shape& shape, const glm::dmat4& sceneFromMesh = glm::dmat4(1.0));
/// Adds a second instance with a shape of its own.
void addShape(Scene& scene, const assets::Shape& shape, const glm::dmat4& sceneFromMesh = glm::dmat4(1.0));

/// The bench holds a compiled scene, the settings and one device's state.
class TouchBench {
  public:
    explicit TouchBench(const Scene& scene, const HapticSettings& settings = {}, Fit fit = Fit::None);
    /// Several benches may share one compiled scene.
    TouchBench(std::shared_ptr<const HapticScene> scene, const HapticSettings& settings);

    /// One tick with the HIP at `hip` (workspace m).
    const HapticOutput& step(const glm::dvec3& hip);
    /// Ticks along the straight line from where the HIP is to `to` at `speed` m/s; the first call starts
    /// there.
    const HapticOutput& moveTo(const glm::dvec3& to, double speed,
                               const std::function<void(const HapticOutput&)>& each = {});

    HapticSettings settings;
    std::shared_ptr<const HapticScene> scene;
    std::vector<DeviceState> state;
    WorldState world;
    HapticOutput output;
    std::vector<ObjectMotion> motions; ///< empty: at rest
    DeviceLimits limits;
    DeviceMapping mapping; ///< clutch and zoom; what `step` takes is in the device's frame
    double dt = 1e-3;
    uint64_t tick = 0;
};

} // namespace touchstone::test
