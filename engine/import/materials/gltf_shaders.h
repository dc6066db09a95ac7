#pragma once
// Haptic programs of a file's materials (docs/programs.md): `shader` of TOUCHSTONE_materials_haptic.

#include "engine/import/materials/gltf_document.h"
#include "engine/program/surface_program.h"
#include "engine/scene/material.h"

#include <cstddef>
#include <filesystem>
#include <map>
#include <memory>
#include <string>

namespace touchstone {

/// Sources that one file may have: each takes a process of its own for some 10 ms.
inline constexpr size_t kMaxFilePrograms = 64;

/// A source as it is stated.
struct ShaderText {
    std::string name, text;
    std::filesystem::path file; ///< empty: it is inside the model's file
};

/// The source of `shader` in the model at `path`, which is read again; not compiled. Throws Error where there
/// is none.
[[nodiscard]] ShaderText readShaderText(const std::filesystem::path& path, const nlohmann::json& shader);

/// Reads and compiles them, each source once. One import, one thread.
class ShaderReader {
  public:
    ShaderReader(ImportContext& context, const GltfDocument& document)
        : context_(context), document_(document) {}

    /// Fills ours.shader and ours.program. `shader`: unchecked JSON at `place`. Throws Error where it is no
    /// object with one source; any other flaw (source not found, not UTF-8 or not compiling, wrong
    /// parameters) costs a warning, and the surface is plain.
    void read(const nlohmann::json& shader, const std::string& place, HapticStatement& ours);

    [[nodiscard]] ShaderText textOf(const nlohmann::json& shader, const std::string& place) const;

  private:
    struct Outcome {
        std::shared_ptr<const SurfaceProgram> program; ///< null: it has a flaw
        std::string flaw;
    };
    [[nodiscard]] const Outcome& compiled(const nlohmann::json& shader, const std::string& place);

    ImportContext& context_;
    const GltfDocument& document_;
    std::map<std::string, Outcome> outcomes_; ///< by source: each is read and compiled once
};

} // namespace touchstone
