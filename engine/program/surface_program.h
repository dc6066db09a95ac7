#pragma once
// A haptic program that compiled, and what a material makes of it. The hand's executor (haptics/program) and
// the renderer share one object: both run its SPIR-V.

#include "engine/program/program_source.h"

#include <nlohmann/json_fwd.hpp>

#include <array>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone {

/// Immutable; copies of a scene share it.
struct SurfaceProgram {
    ProgramSource source; ///< its name as messages show it, its parameters with their defaults
    std::string text;     ///< the whole source, as in the file
    /// One function, `main`; inputs, outputs and parameters as in shaders/material/interface.glsl, the
    /// parameters in the uniform block of set 0, binding 0 (std140), members in the order of
    /// source.parameters.
    std::vector<uint32_t> spirv;
    std::filesystem::path file; ///< beside the model; empty: the source is inside the model's file
};

class PreparedProgram; // engine/process/prepared_program.h

/// Compiles a source, by installedProgramCompiler(). Programs of the same name, text and file that are still
/// held somewhere are shared and not compiled again. Throws Error, whose place is the line, and Cancelled;
/// `stop` is asked every 20 ms. Any thread but the servo.
[[nodiscard]] std::shared_ptr<const SurfaceProgram> compileSurfaceProgram(const std::string& name,
                                                                          std::string_view text,
                                                                          const std::filesystem::path& file,
                                                                          const std::function<bool()>& stop);
/// The same, by this compiler.
[[nodiscard]] std::shared_ptr<const SurfaceProgram>
compileSurfaceProgram(const std::string& name, std::string_view text, const std::filesystem::path& file,
                      const std::function<bool()>& stop, PreparedProgram& compiler);

/// Sides of a persistent texture, at most.
inline constexpr uint32_t kMaxPersistentSide = 2048;

/// `persistentTexture` of a shader: floats addressed by the texture coordinates, which touch changes.
struct PersistentTextureSize {
    uint32_t width = 0, height = 0;       ///< 0: none
    float initial = 1.0f;                 ///< every texel's value when the scene is loaded
    float minimum = 0.0f, maximum = 1.0f; ///< what touch cannot go beyond; `initial` lies inside
    bool operator==(const PersistentTextureSize&) const = default;
};

/// A program as one material uses it.
struct MaterialProgram {
    std::shared_ptr<const SurfaceProgram> compiled; ///< null: the surface is plain
    /// Of compiled->source.parameters, in their order; unused components are 0. Inside of the declared
    /// ranges.
    std::vector<std::array<double, 4>> values;
    PersistentTextureSize texture;

    [[nodiscard]] explicit operator bool() const { return compiled != nullptr; }
    bool operator==(const MaterialProgram&) const = default;
};

/// The program with the `parameters` and the `persistentTexture` of a material's `shader` (JSON, unchecked).
/// Throws Error where a value is wrong: its file is the program's name, its place the line that declares the
/// parameter, or the member of `shader` that is wrong.
[[nodiscard]] MaterialProgram materialProgram(std::shared_ptr<const SurfaceProgram> compiled,
                                              const nlohmann::json& shader);

/// `shader` with other values of one parameter; as many as it has components. The declared default takes the
/// member away.
[[nodiscard]] nlohmann::json withParameter(const nlohmann::json& shader, const ProgramParameter& parameter,
                                           const std::array<double, 4>& value);

} // namespace touchstone
