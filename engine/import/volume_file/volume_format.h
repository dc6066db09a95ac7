#pragma once
// Files of volumes.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string_view>

namespace touchstone {

enum class VolumeFormat : uint8_t { Nrrd, Meta, Nifti, Vdb };

/// "NRRD"; as its reader's command line has it: "nrrd".
[[nodiscard]] const char* nameOf(VolumeFormat format);
[[nodiscard]] const char* wordOf(VolumeFormat format);

/// What the file is called.
[[nodiscard]] std::optional<VolumeFormat> volumeFormatNamed(const std::filesystem::path& file);

} // namespace touchstone
