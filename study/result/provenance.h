#pragma once

#include "study/result/result.h"

#include <string>

namespace touchstone::study {

/// The processor's name as /proc/cpuinfo has it; "unknown" where there is none.
[[nodiscard]] std::string processorName();

/// This machine, this build, now. `command`: how the study was asked for.
[[nodiscard]] Provenance provenanceOf(const std::string& command);

} // namespace touchstone::study
