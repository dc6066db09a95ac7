#pragma once
// What `run` and `touch` make of a stroke that met nothing.

#include "devices/stroke/stroke_library.h"

#include <cstdint>
#include <filesystem>

namespace touchstone {

/// Nothing where the simulated hand touched. Throws Error where it went once round (`seconds` of the stroke's
/// `period`) and never did; a shorter run gets a note on stderr.
void requireTouch(const std::filesystem::path& scene, const StrokeRequest& stroke, double period,
                  double seconds, uint64_t ticksInContact);

} // namespace touchstone
