#pragma once

#include "engine/import/file/import_context.h"

#include <nlohmann/json_fwd.hpp>

namespace touchstone {

/// Warns about violations of the specification that the import tolerates: layouts of buffer views and
/// accessors, the formats of vertex attributes, required bounds that are missing. Needs validateGltf's checks
/// of ranges.
void warnOfFlaws(ImportContext& context, const nlohmann::json& gltf);

} // namespace touchstone
