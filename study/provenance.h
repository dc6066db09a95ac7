#pragma once

#include "study/result.h"

#include <string>

namespace touchstone::study {

/// This machine, this build, now. `command`: how the study was asked for.
[[nodiscard]] Provenance provenanceOf(const std::string& command);

} // namespace touchstone::study
