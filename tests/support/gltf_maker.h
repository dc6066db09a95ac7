#pragma once
// Small glTF files made in memory, for tests that need a certain feature or a certain flaw.

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <initializer_list>
#include <string>
#include <vector>

namespace touchstone::test {

/// As a data URI has it.
inline std::string base64(const std::vector<uint8_t>& bytes) {
    static constexpr char kAlphabet[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (size_t i = 0; i < bytes.size(); i += 3) {
        const size_t left = std::min<size_t>(3, bytes.size() - i);
        uint32_t bits = 0;
        for (size_t k = 0; k < 3; ++k)
            bits = bits << 8 | (k < left ? bytes[i + k] : 0);
        for (size_t k = 0; k < 4; ++k)
            text += k <= left ? kAlphabet[bits >> (18 - 6 * k) & 63] : '=';
    }
    return text;
}

/// Grows a glTF: `json` may be changed at will, `add…` put bytes into the one buffer and return indices.
struct GltfMaker {
    nlohmann::json json = {{"asset", {{"version", "2.0"}}}};
    std::vector<uint8_t> bytes;

    /// Appends an entry to a top-level array and returns its index.
    size_t append(const char* array, nlohmann::json entry) {
        json[array].push_back(std::move(entry));
        return json[array].size() - 1;
    }

    /// A buffer view over a copy of `data`, on a multiple of four bytes.
    size_t addView(const void* data, size_t size, size_t stride = 0) {
        while (bytes.size() % 4 != 0)
            bytes.push_back(0);
        const size_t offset = bytes.size();
        const auto* from = static_cast<const uint8_t*>(data);
        bytes.insert(bytes.end(), from, from + size);
        nlohmann::json view = {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", size}};
        if (stride != 0)
            view["byteStride"] = stride;
        return append("bufferViews", std::move(view));
    }

    template <class T>
    static constexpr int componentTypeOf() {
        if constexpr (std::is_same_v<T, int8_t>)
            return 5120;
        else if constexpr (std::is_same_v<T, uint8_t>)
            return 5121;
        else if constexpr (std::is_same_v<T, int16_t>)
            return 5122;
        else if constexpr (std::is_same_v<T, uint16_t>)
            return 5123;
        else if constexpr (std::is_same_v<T, uint32_t>)
            return 5125;
        else
            return 5126;
    }

    template <class T>
    size_t addAccessor(const std::vector<T>& values, const char* type, bool normalized = false) {
        const std::string name = type;
        const size_t components = name == "SCALAR" ? 1 : static_cast<size_t>(name.back() - '0');
        const size_t view = addView(values.data(), values.size() * sizeof(T));
        nlohmann::json accessor = {{"bufferView", view},
                                   {"componentType", componentTypeOf<T>()},
                                   {"count", values.size() / components},
                                   {"type", type}};
        if (normalized)
            accessor["normalized"] = true;
        return append("accessors", std::move(accessor));
    }

    /// A node in the default scene that shows the mesh.
    size_t show(size_t mesh) {
        const size_t node = append("nodes", {{"mesh", mesh}});
        if (!json.contains("scenes"))
            json["scenes"] = {{{"nodes", nlohmann::json::array()}}};
        json["scenes"][0]["nodes"].push_back(node);
        return node;
    }

    /// The file as GLB. `json["buffers"]` is made unless it is there already.
    [[nodiscard]] std::vector<uint8_t> glb() const {
        nlohmann::json whole = json;
        if (!bytes.empty() && !whole.contains("buffers"))
            whole["buffers"] = {{{"byteLength", bytes.size()}}};
        std::string text = whole.dump();
        while (text.size() % 4 != 0)
            text.push_back(' ');
        std::vector<uint8_t> binary = bytes;
        while (binary.size() % 4 != 0)
            binary.push_back(0);
        std::vector<uint8_t> out;
        const auto word = [&](size_t value) {
            for (int shift = 0; shift < 32; shift += 8)
                out.push_back(static_cast<uint8_t>(value >> shift));
        };
        word(0x46546C67);
        word(2);
        word(12 + 8 + text.size() + (binary.empty() ? 0 : 8 + binary.size()));
        word(text.size());
        word(0x4E4F534A);
        out.insert(out.end(), text.begin(), text.end());
        if (!binary.empty()) {
            word(binary.size());
            word(0x004E4942);
            out.insert(out.end(), binary.begin(), binary.end());
        }
        return out;
    }

    /// A unit square in the xy plane, two triangles, normals +z, uv with v down; shown by a node. Mesh 0.
    static GltfMaker square() {
        GltfMaker maker;
        const size_t positions = maker.addAccessor<float>({0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0}, "VEC3");
        maker.json["accessors"][positions]["min"] = {0, 0, 0};
        maker.json["accessors"][positions]["max"] = {1, 1, 0};
        const size_t normals = maker.addAccessor<float>({0, 0, 1, 0, 0, 1, 0, 0, 1, 0, 0, 1}, "VEC3");
        const size_t uv = maker.addAccessor<float>({0, 1, 1, 1, 1, 0, 0, 0}, "VEC2");
        const size_t indices = maker.addAccessor<uint16_t>({0, 1, 2, 0, 2, 3}, "SCALAR");
        maker.append("meshes",
                     {{"primitives",
                       {{{"attributes", {{"POSITION", positions}, {"NORMAL", normals}, {"TEXCOORD_0", uv}}},
                         {"indices", indices}}}}});
        maker.show(0);
        return maker;
    }

    /// The first primitive of mesh 0.
    nlohmann::json& primitive() { return json["meshes"][0]["primitives"][0]; }
};

inline void writeFile(const std::filesystem::path& path, const void* data, size_t size) {
    std::filesystem::create_directories(path.parent_path());
    std::ofstream(path, std::ios::binary)
        .write(static_cast<const char*>(data), static_cast<std::streamsize>(size));
}

inline void writeFile(const std::filesystem::path& path, const std::string& text) {
    writeFile(path, text.data(), text.size());
}
inline void writeFile(const std::filesystem::path& path, const std::vector<uint8_t>& bytes) {
    writeFile(path, bytes.data(), bytes.size());
}

/// A folder of its own, gone with the object.
class TemporaryFolder {
  public:
    TemporaryFolder() {
        std::string pattern = (std::filesystem::temp_directory_path() / "touchstone-XXXXXX").string();
        path_ = mkdtemp(pattern.data());
    }
    ~TemporaryFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    TemporaryFolder(const TemporaryFolder&) = delete;
    TemporaryFolder& operator=(const TemporaryFolder&) = delete;
    [[nodiscard]] const std::filesystem::path& path() const { return path_; }

  private:
    std::filesystem::path path_;
};

} // namespace touchstone::test
