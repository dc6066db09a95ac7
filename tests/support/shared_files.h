#pragma once
// Where the shared models and broken files lie; the tests pass without them, on our own scenes.

#include <cstdlib>
#include <filesystem>
#include <optional>

namespace touchstone::test {

/// The folder of real glTF models, if the environment names one (TOUCHSTONE_MODELS).
inline std::optional<std::filesystem::path> modelsFolder() {
    const char* path = std::getenv("TOUCHSTONE_MODELS");
    return path != nullptr ? std::optional<std::filesystem::path>(path) : std::nullopt;
}

/// The folder of broken glTF files, if the environment names one (TOUCHSTONE_HOSTILE).
inline std::optional<std::filesystem::path> hostileFolder() {
    const char* path = std::getenv("TOUCHSTONE_HOSTILE");
    return path != nullptr ? std::optional<std::filesystem::path>(path) : std::nullopt;
}

} // namespace touchstone::test
