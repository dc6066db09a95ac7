#pragma once
// What touch had made of persistent textures, in a model's file: the start state of the next session.

#include "engine/import/file/import_context.h"
#include "engine/program/surface_program.h"
#include "engine/scene/scene.h"

#include <nlohmann/json_fwd.hpp>

#include <cstddef>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// The texels of one object: of one of the surfaces that a node places.
struct TextureValues {
    int node = 0;              ///< of the file
    int surface = 0;           ///< among those of the node (Scene::instances), in their order
    std::vector<float> values; ///< row by row
};

/// TextureValues::surface of each instance.
[[nodiscard]] std::vector<int> surfacesOf(const Scene& scene);

/// `persistentTexture.values` of a shader: an array of {node, surface, data}. The data are 32-bit floats,
/// least significant byte first, in the zlib format (RFC 1950), as a data URI.
[[nodiscard]] nlohmann::json jsonOf(std::span<const TextureValues> objects);

/// Reads it; values beyond the texture's range are moved to its ends. Throws Error at `place` where it is
/// damaged, or of another size than the texture.
[[nodiscard]] std::vector<TextureValues> readTextureValues(const ImportContext& context,
                                                           const nlohmann::json& stated,
                                                           const PersistentTextureSize& size,
                                                           const std::string& place);

} // namespace touchstone
