#pragma once

#include <cstdint>
#include <string_view>

namespace touchstone {

/// `header`: of a volume whose values lie in a file of their own; else null.
using VolumeRead = void (*)(std::string_view format, uint64_t most, const char* header);

/// Calls `read` with "FORMAT MOST [HEADER]" of the command line. What it throws becomes the answer's line,
/// and ends the process with status 1.
void runVolumeReader(int argc, char** argv, VolumeRead read);

} // namespace touchstone
