#pragma once
// Structures of the scene that only some settings need, besides the effect plan.

namespace touchstone {

class HapticScene;
struct HapticSettings;

/// True where `scene` has all that `settings` need. Any thread.
[[nodiscard]] bool isBuiltFor(const HapticScene& scene, const HapticSettings& settings) noexcept;

/// Builds what isBuiltFor finds missing. Slow; any thread but the servo's, one at a time.
void buildFor(const HapticScene& scene, const HapticSettings& settings);

} // namespace touchstone
