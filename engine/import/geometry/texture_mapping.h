#pragma once
// Two-part texture mapping (Bier and Sloan 1986): an image goes onto a simple surface around the object (S),
// and from there onto the object (O), so that a mesh without texture coordinates can have maps.

#include "engine/import/file/import_context.h"
#include "engine/import/materials/gltf_document.h"
#include "engine/scene/scene.h"

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace touchstone {

/// `textureMapping` of a material. The intermediate surface has the axes of the mesh, turned by `rotation`,
/// and the size of the mesh along them.
struct TextureMapping {
    enum class Surface : uint8_t {
        Plane,    ///< seen along z: u along x, v against y
        Cylinder, ///< about z: u around it, v against z
        Sphere,   ///< poles on z: u around it, v from the upper pole to the lower
        Box       ///< each of six faces has the whole image
    };
    /// Which place of the intermediate surface a corner gets.
    enum class Ray : uint8_t {
        Position, ///< on the ray from the middle (of a cylinder: from the axis) through the corner
        Normal    ///< to which the surface's normal points
    };
    Surface surface = Surface::Plane;
    Ray ray = Ray::Position;
    glm::dvec2 repeat{1.0, 1.0};
    glm::dquat rotation{1.0, 0.0, 0.0, 0.0};
};

/// `textureMapping` as `place` of a file states it. Throws ImportError where it is wrong.
[[nodiscard]] TextureMapping readTextureMapping(ImportContext& context, const nlohmann::json& stated,
                                                const std::string& place);

/// That of a material; empty where it has none. Throws ImportError where it is wrong.
[[nodiscard]] std::optional<TextureMapping>
readTextureMapping(ImportContext& context, const GltfDocument& document, int material, std::string& place);

/// Gives the mesh texture coordinates of set 0 in place of its own, without tangents. Where an image closes
/// upon itself, at a pole and between the faces of a box, vertices are split, so that no triangle runs back
/// through the image. Returns how many vertices came.
size_t mapTexture(const TextureMapping& mapping, Mesh& mesh);

} // namespace touchstone
