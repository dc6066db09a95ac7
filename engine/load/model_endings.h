#pragma once

#include <array>
#include <filesystem>
#include <span>
#include <string_view>

namespace touchstone {

/// The endings of what loadScene reads, in lower case. (Of meshes it goes by the bytes, not by the name.)
inline constexpr std::array<std::string_view, 13> kModelEndings = {".glb", ".gltf",   ".vrm",  ".obj", ".stl",
                                                                   ".ply", ".nrrd",   ".nhdr", ".mhd", ".mha",
                                                                   ".nii", ".nii.gz", ".vdb"};

/// Whether the file's name ends in one of `endings`, in any case.
[[nodiscard]] bool endsIn(const std::filesystem::path& file, std::span<const std::string_view> endings);

} // namespace touchstone
