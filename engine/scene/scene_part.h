#pragma once
// The part of a scene that is seen and felt: without its hidden objects, on one side of a clipping plane.

#include "engine/scene/scene.h"

#include <glm/glm.hpp>

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// Keeps what lies on the far side of its normal: dot(normal, p) <= offset. Scene frame, m. It cuts every
/// object in the static pose; an object that moves takes its cut along.
struct ClipPlane {
    glm::dvec3 normal{1.0, 0.0, 0.0}; ///< unit
    double offset = 0.0;              ///< m along the normal, from the scene's origin

    [[nodiscard]] double distance(const glm::dvec3& point) const { return glm::dot(normal, point) - offset; }
    bool operator==(const ClipPlane&) const = default;
};

struct ScenePart {
    std::vector<int> hidden; ///< Scene::nodes, ascending, each once; those below a node are named themselves
    std::optional<ClipPlane> clip;

    [[nodiscard]] bool whole() const { return hidden.empty() && !clip; }
    bool operator==(const ScenePart&) const = default;
};

/// Nodes as the command line names them.
struct PartNames {
    std::vector<std::string> hide, isolate;
    std::optional<ClipPlane> clip;
};

/// The plane through `offset` along `normal`, which need not be unit; nullopt where it has no direction or a
/// number is not finite.
[[nodiscard]] std::optional<ClipPlane> clipPlane(const glm::dvec3& normal, double offset);

/// The name of a node in the window and on the command line: its own, else "node 3".
[[nodiscard]] std::string nodeLabel(const Scene& scene, int node);
/// The nodes that a text names: by their label, else by the name of a mesh that they place. Empty: none.
[[nodiscard]] std::vector<int> nodesNamed(const Scene& scene, std::string_view name);

/// Hides or shows a node and all below it.
void hideNode(const Scene& scene, int node, ScenePart& part);
void showNode(const Scene& scene, int node, ScenePart& part);
/// Hides all but these nodes and what is below them.
void isolateNodes(const Scene& scene, std::span<const int> nodes, ScenePart& part);
[[nodiscard]] bool isHidden(const ScenePart& part, int node);

/// Throws Error for a name that the scene does not have.
[[nodiscard]] ScenePart partNamed(const Scene& scene, const PartNames& names);

/// One entry for each of Scene::instances: true where its node is hidden.
[[nodiscard]] std::vector<bool> hiddenInstances(const Scene& scene, const ScenePart& part);
/// The plane in the frame of a mesh whose pose in the scene is `sceneFromMesh`: dot(plane, (p, 1)) is the
/// distance in the scene, m.
[[nodiscard]] glm::dvec4 planeInMesh(const ClipPlane& plane, const glm::dmat4& sceneFromMesh);
/// True for an instance that is felt as a distance field: a clipping plane leaves a flat face on it. A mesh
/// is open where it is cut.
[[nodiscard]] bool isFilled(const Scene& scene, const Instance& instance);

/// A scene with the part's triangles and without hidden instances, as a stroke is laid on it: nodes,
/// materials, animations and bounds are those of the whole; it has no images, cameras and warnings.
[[nodiscard]] ScenePtr sceneOf(const ScenePtr& whole, const ScenePart& part);

} // namespace touchstone
