#pragma once
// The structure of the JSON: type, range and target of every property. After this check the import may read
// known properties without checking their types. Source: the glTF 2.0 specification, section 5 (properties
// reference).

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Throws Error for a wrong type, a missing required property, a value out of range or an index out of
/// bounds, where geometry depends on it. Elsewhere (names, appearance, images, animations, cameras) it
/// removes invalid data from `gltf` and warns; objects of arrays remain, without properties. Integers written
/// "36.0" become integers.
void checkSchema(ImportContext& context, nlohmann::json& gltf);

/// True if `number` has no fraction and is exact in JSON, |number| < 2^53.
[[nodiscard]] bool isWhole(double number);

/// Throws unless `info` is a well-formed textureInfo (also for extensions, whose JSON checkSchema never
/// sees).
void checkTextureInfo(ImportContext& context, const nlohmann::json& gltf, const nlohmann::json& info,
                      const std::string& place);

} // namespace touchstone
