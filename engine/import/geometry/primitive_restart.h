#pragma once

#include "engine/import/file/import_context.h"

#include <cstdint>
#include <string>
#include <vector>

namespace touchstone {

/// Indices without the restart value, which glTF forbids and some exporters write. Where a vertex of that
/// number exists, the index refers to it. Otherwise it ends a primitive: lists lose an incomplete primitive
/// before it, strips of triangles are joined by triangles without area. Warns where it occurs; throws Error
/// in fans and in strips of lines, which cannot be joined. `mode` is glTF's, `place` the indices' place in
/// the file.
[[nodiscard]] std::vector<uint32_t> withoutRestarts(ImportContext& context, std::vector<uint32_t> indices,
                                                    uint32_t restart, size_t vertexCount, int mode,
                                                    const std::string& place);

} // namespace touchstone
