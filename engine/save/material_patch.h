#pragma once
// Writes a user's changes of haptic materials into the source file: only
// `materials[i].extensions.TOUCHSTONE_materials_haptic` and `extensionsUsed` change, everything else keeps
// its bytes (in a GLB except for the two lengths and the JSON chunk's padding).

#include "engine/core/checksum.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <span>
#include <string>
#include <vector>

namespace touchstone {

/// Changes of the extension by the material's index in the file, each a merge patch (RFC 7396): members are
/// set, null ones removed, objects merged. An extension that becomes empty is removed, and its name in
/// `extensionsUsed` when it was the last.
using MaterialPatches = std::map<size_t, nlohmann::ordered_json>;

/// Converts to JSON, {"0": {...}}, and back; empty for none. patchesFrom throws Error where the text is
/// invalid.
[[nodiscard]] std::string textOf(const MaterialPatches& patches);
[[nodiscard]] MaterialPatches patchesFrom(const std::string& text);

/// The .gltf or .glb in `bytes` with the patches applied. `shownAs` names it in messages. Without patches the
/// same bytes. Throws Error where it is no glTF, or has no material of such an index.
[[nodiscard]] std::vector<uint8_t> withMaterials(std::span<const uint8_t> bytes,
                                                 const MaterialPatches& patches, const std::string& shownAs);

/// The text of a program that is a file beside the model.
struct ProgramFile {
    std::filesystem::path file;
    std::string text;
};

[[nodiscard]] bool inOneFolder(const std::filesystem::path& a, const std::filesystem::path& b);

/// Writes `source` with the patches to `target` (which may be the same file), as a whole or not at all. An
/// OBJ, STL or PLY is written as a new GLB. Throws Error where the source no longer has the bytes `loaded`,
/// so that no other program's changes are overwritten; where the target would be of another kind (.glb,
/// .gltf); and where the source refers to buffers or images beside it and the target is in another folder.
/// Programs beside it (docs/programs.md) come along into that folder, with the text of `programs` where they
/// are among these; another text that has such a name there is not replaced: Error. Returns the target's new
/// stamp.
[[nodiscard]] FileStamp saveMaterials(const std::filesystem::path& source, const FileStamp& loaded,
                                      const MaterialPatches& patches, const std::filesystem::path& target,
                                      std::span<const ProgramFile> programs = {});

} // namespace touchstone
