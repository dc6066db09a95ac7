#pragma once
// The choices of a scene beside the edits of its materials, in recordings: the value at a volume's surface,
// and the animation that plays.

#include "engine/scene/scene.h"

#include <optional>
#include <string>

namespace touchstone {

/// `edits` (MaterialPatches as text) with the value at the surface of the scene's volume as its member "iso"
/// Scene::animation as "animation" and Physics::loose as "loose"; the same where the scene has no volume and
/// none was chosen.
[[nodiscard]] std::string withChoices(const std::string& edits, const Scene& scene);

/// Removes the member; none, and the text as it is, where it has none or is no JSON object.
[[nodiscard]] std::optional<double> takeIso(std::string& edits);
/// The same of the animation: an index as text, as LoadOptions::animation takes it.
[[nodiscard]] std::optional<std::string> takeAnimation(std::string& edits);
/// `edits` of a scene whose objects are all made bodies (Physics::loose), and the removal of that.
[[nodiscard]] std::string withLoose(const std::string& edits);
[[nodiscard]] bool takeLoose(std::string& edits);

} // namespace touchstone
