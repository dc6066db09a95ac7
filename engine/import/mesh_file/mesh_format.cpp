#include "engine/import/mesh_file/mesh_format.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <string>
#include <string_view>

namespace touchstone {

namespace {

struct Names {
    MeshFormat format;
    const char* name;
    const char* ending;
};
constexpr Names kNames[] = {
    {MeshFormat::Obj, "OBJ", "obj"}, {MeshFormat::Stl, "STL", "stl"}, {MeshFormat::Ply, "PLY", "ply"}};

/// Text: lines from "solid" to "endsolid". Binary: 80 bytes, the number of triangles, 50 bytes each.
bool isStl(std::string_view all) {
    constexpr size_t kHead = 80, kTriangle = 50;
    if (all.starts_with("solid") && all.substr(0, 1024).find("facet") != std::string_view::npos)
        return true;
    if (all.size() < kHead + 4 + kTriangle)
        return false;
    uint64_t count = 0;
    for (size_t i = 4; i-- > 0;)
        count = count << 8 | static_cast<uint8_t>(all[kHead + i]);
    return count * kTriangle + kHead + 4 == all.size();
}

/// Some of the first lines begin with the keywords of OBJ, and none with anything else.
bool isObj(std::string_view all) {
    constexpr size_t kLooked = 4096;
    constexpr int kEnough = 3;
    static constexpr std::array<std::string_view, 10> kKeywords = {"v", "vn", "vt",     "f",      "o",
                                                                   "g", "s",  "usemtl", "mtllib", "l"};
    std::string_view rest = all.substr(0, kLooked);
    int known = 0;
    while (!rest.empty()) {
        const size_t end = rest.find('\n');
        if (end == std::string_view::npos && all.size() > kLooked)
            break; // cut off in the middle
        std::string_view line = rest.substr(0, end);
        rest = end == std::string_view::npos ? std::string_view() : rest.substr(end + 1);
        line = line.substr(0, line.find_first_of(" \t\r"));
        if (line.empty() || line.front() == '#')
            continue;
        if (std::find(kKeywords.begin(), kKeywords.end(), line) == kKeywords.end())
            return false;
        ++known;
    }
    return known >= kEnough;
}

} // namespace

const char* nameOf(MeshFormat format) {
    return kNames[static_cast<size_t>(format)].name;
}

const char* endingOf(MeshFormat format) {
    return kNames[static_cast<size_t>(format)].ending;
}

std::optional<MeshFormat> meshFormatOf(std::span<const uint8_t> bytes) {
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (all.starts_with("ply\n") || all.starts_with("ply\r"))
        return MeshFormat::Ply;
    if (isStl(all))
        return MeshFormat::Stl;
    if (isObj(all))
        return MeshFormat::Obj;
    return std::nullopt;
}

std::optional<MeshFormat> meshFormatNamed(const std::filesystem::path& file) {
    std::string ending = file.extension().string();
    std::ranges::transform(ending, ending.begin(),
                           [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    for (const Names& names : kNames)
        if (ending.size() > 1 && ending.substr(1) == names.ending)
            return names.format;
    return std::nullopt;
}

} // namespace touchstone
