#pragma once

#include <glm/glm.hpp>

#include <array>
#include <cstdint>

namespace touchstone {

/// Vertex layout of scene meshes, binding 0; binding 1 holds one float per vertex in false-colour views.
struct SceneVertex {
    glm::vec3 position; ///< mesh frame, relative to the mesh's centre
    glm::vec3 normal;
    glm::vec4 tangent;
    glm::vec2 uv0, uv1;
    std::array<uint16_t, 4> color; ///< linear, 0..1 as 0..65535
};
static_assert(sizeof(SceneVertex) == 64);

} // namespace touchstone
