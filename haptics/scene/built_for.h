#pragma once
// What settings need besides the effect plan: structures of the scene that only some configurations read.

namespace touchstone {

class HapticScene;
struct HapticSettings;

/// True where `scene` has what `settings` need. Any thread.
[[nodiscard]] bool isBuiltFor(const HapticScene& scene, const HapticSettings& settings) noexcept;

/// Builds what isBuiltFor misses. Slow; any thread but the servo's, one at a time.
void buildFor(const HapticScene& scene, const HapticSettings& settings);

} // namespace touchstone
