#pragma once
// The supported extensions, the ones that may be ignored, and the consequences.

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Throws Error where the file requires an extension without which its geometry would be wrong. Warns once
/// for every used or required extension that is not read, with the consequence, and once for undeclared ones.
/// Removes a malformed extensionsUsed from `gltf`.
void checkExtensions(ImportContext& context, nlohmann::json& gltf);

} // namespace touchstone
