#pragma once
// OBJ, STL and PLY: meshes without units, scene or materials that could be felt.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <span>

namespace touchstone {

enum class MeshFormat : uint8_t { Obj, Stl, Ply };

/// "OBJ"; as the ending of a name: "obj".
[[nodiscard]] const char* nameOf(MeshFormat format);
[[nodiscard]] const char* endingOf(MeshFormat format);

/// What the bytes are, whatever the file is called; none for anything else, and where they are too broken to
/// tell.
[[nodiscard]] std::optional<MeshFormat> meshFormatOf(std::span<const uint8_t> bytes);
/// What the file is called.
[[nodiscard]] std::optional<MeshFormat> meshFormatNamed(const std::filesystem::path& file);

} // namespace touchstone
