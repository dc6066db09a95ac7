#pragma once
// How a scene is looked at: camera, light, and which quantity is shown. Plain data.

#include "engine/math/similarity.h"
#include "renderer/camera.h"
#include "renderer/surroundings.h"

#include <glm/glm.hpp>

#include <array>
#include <cstdint>
#include <string_view>

namespace touchstone {

/// Shaded is what the eye would see; the others are false-colour views of what the hand would feel. Tilt:
/// between the facet and the normal that is felt, with its maps. Dihedral: the largest angle between the
/// facets at an edge of the vertex. Effects: SceneRenderer::setMaterialColors.
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
    Effects
};
inline constexpr std::array<std::string_view, 10> kViewModeNames{
    "shaded", "height", "friction", "stiffness", "damping", "normals", "uv", "tilt", "dihedral", "effects"};
[[nodiscard]] constexpr std::string_view viewModeName(ViewMode mode) {
    return kViewModeNames[static_cast<size_t>(mode)];
}

struct DirectionalLight {
    glm::dvec3 toLight{0.0, 0.0, 1.0}; ///< workspace, towards the light; need not be unit
    glm::vec3 irradiance{0.0f};        ///< linear RGB at normal incidence; zero is off
};

/// A ball that takes light from the surface near it, so that its height above the surface can be judged. It
/// casts no shadow through the camera's other objects: only the first light and the surroundings count.
struct ProbeShadow {
    glm::dvec3 centre{0.0}; ///< workspace, m
    double radius = 0.0;    ///< m; 0: none
};

/// Linear RGB at the upper and lower edge of the image; not exposed or tone mapped.
struct Background {
    glm::vec3 top{0.235f, 0.26f, 0.295f};
    glm::vec3 bottom{0.055f, 0.06f, 0.07f};
};

struct View {
    glm::dmat4 viewFromWorkspace{1.0};
    glm::dmat4 clipFromView{1.0}; ///< depth 0..1, y up; must match the aspect of the image
    Similarity workspaceFromScene;
    ViewMode mode = ViewMode::Shaded;
    std::array<DirectionalLight, 2> lights{};
    Surroundings surroundings;
    ProbeShadow probe;
    Background background;
    float exposure = 1.0f; ///< factor before tone mapping
    /// Pixels of one nominal pixel: lines of the scene are 1.5 of them wide, its points 5.
    float pixelScale = 1.0f;
    /// Pixels by which a simplified mesh may differ from the full one; 0: the full one is drawn. Only of
    /// scenes that were prepared with simplified meshes.
    double allowedError = 0.0;
};

/// The view of a camera with a key light over its left shoulder and soft lamps on both sides, which all move
/// with the camera, so that the side one looks at is always lit and metal has something to reflect.
[[nodiscard]] View viewOf(const OrbitCamera& camera, const Similarity& workspaceFromScene, double aspect);

} // namespace touchstone
