#pragma once
// A view of a scene: camera, light, and displayed quantity. Plain data.

#include "engine/scene/scene_part.h"
#include "renderer/camera.h"
#include "renderer/surroundings.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string_view>
#include <vector>

namespace touchstone {

/// Exactly.
[[nodiscard]] inline bool operator==(const Similarity& a, const Similarity& b) {
    return a.scale == b.scale && a.rotation == b.rotation && a.translation == b.translation;
}

/// Shaded is the visual appearance; the others are false-colour views of haptic quantities. Tilt: between the
/// facet and the felt normal, with its maps. Dihedral: the largest angle between the facets at an edge of the
/// vertex. Effects: SceneRenderer::setMaterialColors. Perception: how many angles of kFeltAngles
/// (renderer/false_color.h) that angle exceeds at edges that are meant to be smooth.
enum class ViewMode : uint8_t {
    Shaded,
    Height,
    Friction,
    Stiffness,
    Damping,
    Normals,
    Uv,
    Tilt,
    Dihedral,
    Effects,
    Perception
};
inline constexpr std::array<std::string_view, 11> kViewModeNames{
    "shaded", "height", "friction", "stiffness", "damping",   "normals",
    "uv",     "tilt",   "dihedral", "effects",   "perception"};
[[nodiscard]] constexpr std::string_view viewModeName(ViewMode mode) {
    return kViewModeNames[static_cast<size_t>(mode)];
}

struct DirectionalLight {
    glm::dvec3 toLight{0.0, 0.0, 1.0}; ///< workspace, towards the light; need not be unit
    glm::vec3 irradiance{0.0f};        ///< linear RGB at normal incidence; zero: off
    bool operator==(const DirectionalLight&) const = default;
};

/// A ball that shades the surface near it, which shows its height above the surface. It is the only occluder,
/// and occludes only the first light and the surroundings.
struct ProbeShadow {
    glm::dvec3 centre{0.0}; ///< workspace, m
    double radius = 0.0;    ///< m; 0: none
    bool operator==(const ProbeShadow&) const = default;
};

/// Linear RGB at the upper and lower edge of the image; not exposed or tone mapped.
struct Background {
    glm::vec3 top{0.235f, 0.26f, 0.295f};
    glm::vec3 bottom{0.055f, 0.06f, 0.07f};
    bool operator==(const Background&) const = default;
};

/// What a picture shows but for poses and overlays. A kept picture is drawn anew when any of it changes
/// (PictureKey).
struct View {
    glm::dmat4 viewFromWorkspace{1.0};
    glm::dmat4 clipFromView{1.0}; ///< depth 0..1, y up; must match the aspect of the image
    Similarity workspaceFromScene;
    ScenePart part; ///< what is drawn of the scene
    /// Of Scene::instances, in order: fields that are shells of their open meshes, hollow where the plane
    /// cuts them. Where their surface is drawn in place of the mesh (SceneRenderer::reshape), it is closed.
    std::vector<int> shells;
    ViewMode mode = ViewMode::Shaded;
    bool wireframe = false; ///< the triangles' edges over the surface; the device draws none where it cannot
    std::array<DirectionalLight, 2> lights{};
    Surroundings surroundings;
    ProbeShadow probe;
    Background background;
    float exposure = 1.0f; ///< factor before tone mapping
    /// Pixels per nominal pixel: lines of the scene are 1.5 of them wide, its points 5.
    float pixelScale = 1.0f;
    /// Error of simplified meshes, pixels; 0: the full mesh is drawn. Only for scenes prepared with
    /// simplified meshes.
    double allowedError = 0.0;

    bool operator==(const View&) const = default;

    /// The projection keeps depth out of x and y.
    [[nodiscard]] bool orthographic() const { return clipFromView[2][3] == 0.0; }
};

/// The view of a camera with a key light over its left shoulder and soft lamps on both sides, which all move
/// with the camera, so that the visible side is always lit and metal has something to reflect.
[[nodiscard]] View viewOf(const OrbitCamera& camera, const Similarity& workspaceFromScene, double aspect);

/// Places that light for a camera with these axes (unit, workspace).
void placeLights(const glm::dvec3& right, const glm::dvec3& up, const glm::dvec3& back, View& view);

} // namespace touchstone
