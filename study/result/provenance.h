#pragma once

#include "study/result/result.h"

#include <string>

namespace touchstone::study {

/// The processor's name from /proc/cpuinfo; "unknown" where there is none.
[[nodiscard]] std::string processorName();

/// This machine, this build, now. `command`: the command line of the study.
[[nodiscard]] Provenance provenanceOf(const std::string& command);

} // namespace touchstone::study
