#pragma once
// The shape of the JSON: which property of which object has which type, range and target. After this check
// the rest of the import may read the properties it knows without asking for their types again. Source: the
// glTF 2.0 specification, section 5 (properties reference).

#include "engine/import/file/import_context.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// Throws Error for a wrong type, a missing required property, a value out of range or an index that leads
/// nowhere, where geometry depends on it. Elsewhere (names, looks, images, animations) it removes what is
/// wrong from `gltf` and warns; objects of arrays stay, without properties. Integers written "36.0" become
/// integers.
void checkSchema(ImportContext& context, nlohmann::json& gltf);

/// Whether `number` has no fraction and is exact in JSON, |number| < 2^53.
[[nodiscard]] bool isWhole(double number);

/// Throws unless `info` is a well-formed textureInfo (also for extensions, whose JSON checkSchema never
/// sees).
void checkTextureInfo(ImportContext& context, const nlohmann::json& gltf, const nlohmann::json& info,
                      const std::string& place);

} // namespace touchstone
