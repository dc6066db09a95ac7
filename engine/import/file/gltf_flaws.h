#pragma once

#include "engine/import/file/import_context.h"

#include <nlohmann/json.hpp>

namespace touchstone {

/// Warns about what the specification forbids and we read all the same: layouts of buffer views and
/// accessors, the formats of vertex attributes, bounds that must be declared and are not. Needs
/// validateGltf's checks of ranges.
void warnOfFlaws(ImportContext& context, const nlohmann::json& gltf);

} // namespace touchstone
