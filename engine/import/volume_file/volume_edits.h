#pragma once
// The value at a volume's surface beside the edits of materials, in recordings.

#include "engine/scene/scene.h"

#include <optional>
#include <string>

namespace touchstone {

/// `edits` (MaterialPatches as text) with the value at the surface of the scene's volume as its member
/// "iso"; the same where the scene has no volume.
[[nodiscard]] std::string withIso(const std::string& edits, const Scene& scene);

/// Removes the member; none, and the text as it is, where it has none or is no JSON object.
[[nodiscard]] std::optional<double> takeIso(std::string& edits);

} // namespace touchstone
