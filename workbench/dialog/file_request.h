#pragma once

#include "engine/load/model_endings.h"

#include <array>
#include <filesystem>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// What the files that are offered have in common.
struct FileKind {
    const char* name;
    std::span<const std::string_view> endings; ///< empty: any
};

namespace file_kinds {
inline constexpr std::array<std::string_view, 14> kOpened = {".glb", ".gltf",   ".vrm",  ".obj",  ".stl",
                                                             ".ply", ".nrrd",   ".nhdr", ".mhd",  ".mha",
                                                             ".nii", ".nii.gz", ".vdb",  ".tsrec"};
inline constexpr std::array<std::string_view, 1> kRecording = {".tsrec"};
} // namespace file_kinds

inline constexpr std::array<FileKind, 4> kFileKinds = {{{"Models and recordings", file_kinds::kOpened},
                                                        {"Models", kModelEndings},
                                                        {"Recordings", file_kinds::kRecording},
                                                        {"All files", {}}}};

enum class FilePurpose : uint8_t { Open, SaveMaterials, SaveSculpture };

/// A folder to which the browser jumps.
struct FilePlace {
    std::string name;
    std::filesystem::path folder;
};

/// What is asked of the user.
struct FileRequest {
    FilePurpose purpose = FilePurpose::Open;
    std::filesystem::path folder; ///< in which it begins
    std::string name;             ///< suggested, of a file to be saved
    std::string ending;           ///< that a file to be saved gets where it has none: ".glb"
    std::vector<FilePlace> places;

    [[nodiscard]] bool saves() const { return purpose != FilePurpose::Open; }
};

/// What a person types for a path: a leading ~ or ~user is that home folder, spaces at the ends are dropped,
/// and what is relative is relative to `folder`. Without such a home folder the ~ stays.
[[nodiscard]] std::filesystem::path typedPath(std::string_view typed, const std::filesystem::path& folder);
/// Whether a typed text names a path, and not a part of a name.
[[nodiscard]] bool isPath(std::string_view typed);

/// The home folder, the desktop's and the downloads' where they exist, and the folders of `files`, each once.
[[nodiscard]] std::vector<FilePlace> usualPlaces(std::span<const std::filesystem::path> samples,
                                                 std::span<const std::filesystem::path> recent);

} // namespace touchstone
