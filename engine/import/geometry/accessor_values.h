#pragma once

#include "engine/import/materials/gltf_document.h"

namespace touchstone {

/// Warns about harmless errors in declared values of accessors: numbers that are not finite, declared minima
/// and maxima that do not hold (the import computes its own bounds). Stops silently after reading a few times
/// the file's own size, since accessors may overlap without limit.
void warnOfAccessorValues(ImportContext& context, const GltfDocument& document);

} // namespace touchstone
