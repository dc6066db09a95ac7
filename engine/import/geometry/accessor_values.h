#pragma once

#include "engine/import/materials/gltf_document.h"

namespace touchstone {

/// Warns about what the declared values of accessors get wrong though nothing breaks by it: numbers that are
/// not finite, declared minima and maxima that do not hold (we compute bounds ourselves). Stops silently
/// after reading a few times the file's own size, since accessors may overlap without end.
void warnOfAccessorValues(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
