#pragma once
// Which extensions are read, which may be missed, and what a file loses by it.

#include "engine/import/file/import_context.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// Throws Error where the file requires an extension without which its geometry would be wrong. One warning
/// for every extension that it uses or requires and that is not read, saying what is lost; one for the
/// undeclared ones. Removes a malformed extensionsUsed from `gltf`.
void checkExtensions(ImportContext& context, nlohmann::json& gltf);

} // namespace touchstone
