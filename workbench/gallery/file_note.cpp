#include "workbench/gallery/file_note.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <cstdint>
#include <cstring>
#include <fstream>
#include <system_error>

namespace touchstone {

namespace {

constexpr uint64_t kMaxJson = 16u << 20; // bytes
constexpr size_t kLongest = 200;         // bytes of a note

/// The JSON of a .gltf, or the first chunk of a .glb.
std::string jsonOf(const std::filesystem::path& model) {
    std::ifstream stream(model, std::ios::binary);
    std::array<char, 20> head{}; // magic, version, length; the chunk's length and kind
    stream.read(head.data(), head.size());
    const bool binary = stream && std::memcmp(head.data(), "glTF", 4) == 0;
    uint64_t length = 0;
    if (binary) {
        uint32_t chunk = 0;
        std::memcpy(&chunk, head.data() + 12, sizeof chunk);
        length = std::memcmp(head.data() + 16, "JSON", 4) == 0 ? chunk : 0;
    } else {
        std::error_code error;
        length = std::filesystem::file_size(model, error);
        stream.clear();
        stream.seekg(0);
    }
    if (length == 0 || length > kMaxJson)
        return {};
    std::string text(length, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(length));
    return stream ? text : std::string();
}

} // namespace

std::string fileNote(const std::filesystem::path& model) {
    const auto json = nlohmann::json::parse(jsonOf(model), nullptr, false);
    const nlohmann::json* at = &json;
    for (const char* name : {"asset", "extras", "description"}) {
        if (!at->is_object() || !at->contains(name))
            return {};
        at = &at->at(name);
    }
    if (!at->is_string())
        return {};
    std::string note = at->get<std::string>();
    note.resize(std::min({note.size(), kLongest, note.find('\n')}));
    std::ranges::replace_if(
        note, [](char c) { return static_cast<unsigned char>(c) < ' '; }, ' ');
    return note;
}

std::vector<std::string> notesOf(std::span<const std::filesystem::path> models) {
    std::vector<std::string> notes(models.size());
    std::ranges::transform(models, notes.begin(), fileNote);
    return notes;
}

} // namespace touchstone
