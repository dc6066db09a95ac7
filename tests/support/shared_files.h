#pragma once
// The shared models and broken files, which are not part of the repository. Tests that need them skip without
// them; tools/test counts the skipped ones.

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <optional>
#include <vector>

namespace touchstone::test {

inline constexpr const char* kNoModels = "TOUCHSTONE_MODELS names no folder of glTF models";
inline constexpr const char* kNoHostileFiles = "TOUCHSTONE_HOSTILE names no folder of broken glTF files";

/// The folder of real glTF models, if the environment names one (TOUCHSTONE_MODELS).
inline std::optional<std::filesystem::path> modelsFolder() {
    const char* path = std::getenv("TOUCHSTONE_MODELS");
    return path != nullptr && *path != '\0' ? std::optional<std::filesystem::path>(path) : std::nullopt;
}

/// The folder of broken glTF files, if the environment names one (TOUCHSTONE_HOSTILE).
inline std::optional<std::filesystem::path> hostileFolder() {
    const char* path = std::getenv("TOUCHSTONE_HOSTILE");
    return path != nullptr && *path != '\0' ? std::optional<std::filesystem::path>(path) : std::nullopt;
}

/// Every .gltf and .glb below `folder`, sorted. Throws std::filesystem::filesystem_error without the folder.
inline std::vector<std::filesystem::path> gltfFilesIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder))
        if (entry.path().extension() == ".glb" || entry.path().extension() == ".gltf")
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    return files;
}

} // namespace touchstone::test
