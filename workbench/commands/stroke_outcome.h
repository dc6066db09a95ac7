#pragma once
// Result of a stroke without contact, for `run` and `touch`.

#include "devices/stroke/stroke_library.h"

#include <cstdint>
#include <filesystem>

namespace touchstone {

/// Does nothing if the simulated hand was in contact. Throws Error where it completed a round (`seconds` of
/// the stroke's `period`) without contact; a shorter run gets a note on stderr.
void requireTouch(const std::filesystem::path& scene, const StrokeRequest& stroke, double period,
                  double seconds, uint64_t ticksInContact);

} // namespace touchstone
