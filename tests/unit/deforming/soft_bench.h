#pragma once
// A hand on soft bodies, checked as a hand on any deforming object.

#include "engine/scene/soft_body.h"
#include "haptics/world/soft_objects.h"
#include "haptics/world/soft_states.h"
#include "tests/unit/deforming/deforming_bench.h"

#include <algorithm>
#include <memory>
#include <string>
#include <vector>

namespace touchstone::test {

inline const std::string kJelly = std::string(TOUCHSTONE_ASSETS) + "/jelly.glb";
inline const std::string kCloth = std::string(TOUCHSTONE_ASSETS) + "/cloth.glb";
inline constexpr double kTop = 0.040; // m, scene: of the jelly

/// A bench whose time goes on from tick to tick.
struct SoftBench : DeformingBench {
    SoftBench(const std::string& path, const HapticSettings& wanted, bool isClosed)
        : SoftBench(loadScene(path), wanted, isClosed) {}
    SoftBench(ScenePtr scene, const HapticSettings& wanted, bool isClosed)
        : DeformingBench(std::move(scene), wanted) {
        closed = isClosed;
    }

    const HapticOutput& feel(const glm::dvec3& scenePlace) {
        return tick(haptic->workspaceFromScene.point(scenePlace), 1e-3 * static_cast<double>(count++));
    }
    void wait(double seconds, const glm::dvec3& scenePlace) {
        for (int k = 0; k < static_cast<int>(1e3 * seconds); ++k)
            feel(scenePlace);
    }
    /// The vertices of soft object `index` in this tick, workspace.
    [[nodiscard]] std::vector<glm::dvec3> vertices(size_t index = 0) const {
        const size_t k = hand.world.soft()->shown()[index].object;
        const HapticObject& object = *hand.world.touched(*haptic).objects[k];
        std::vector<glm::dvec3> places;
        for (size_t v = 0; v < hand.world.soft()->shown()[index].vertices; ++v)
            places.push_back(hand.world.poses()[k].workspaceFromObject.point(object.instant->now.at(v)));
        return places;
    }

    size_t count = 0;
};

inline double farthest(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    double most = 0.0;
    for (size_t v = 0; v < a.size(); ++v)
        most = std::max(most, glm::distance(a[v], b[v]));
    return most;
}

/// The committed jelly without its breath.
inline ScenePtr calmJelly() {
    auto scene = std::make_shared<Scene>(*loadScene(kJelly));
    for (Mesh& mesh : scene->meshes)
        if (mesh.deformation != nullptr) {
            auto deformation = std::make_shared<MeshDeformation>(*mesh.deformation);
            auto law = std::make_shared<SoftBody>(*deformation->soft);
            law->breath = 0.0;
            deformation->soft = law;
            mesh.deformation = deformation;
        }
    return scene;
}

} // namespace touchstone::test
