#include "engine/import/file/gltf_kind.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cctype>
#include <initializer_list>
#include <string_view>

namespace touchstone {
namespace {

using nlohmann::json;
using namespace std::string_view_literals;

constexpr const char* kUnpack = "unpack it and open the .gltf or .glb inside";
constexpr const char* kConvert =
    "convert it to glTF, for example with Blender: File > Import, then File > Export > glTF 2.0";
constexpr const char* kDownload = "download the file itself, on GitHub with the \"Raw\" button";
constexpr const char* kOpenModel = "open a .gltf or .glb file";

struct Magic {
    std::string_view bytes;
    const char* what;
    const char* remedy;
};
constexpr Magic kMagics[] = {
    {"version https://git-lfs"sv, "a Git LFS pointer, which stands for the model",
     "fetch the model with: git lfs pull"},
    {"\x1f\x8b"sv, "a gzip archive", kUnpack},
    {"PK\x03\x04"sv, "a zip archive", kUnpack},
    {"7z\xbc\xaf\x27\x1c"sv, "a 7z archive", kUnpack},
    {"Rar!"sv, "a RAR archive", kUnpack},
    {"BZh"sv, "a bzip2 archive", kUnpack},
    {"\xfd"
     "7zXZ"sv,
     "an xz archive", kUnpack},
    {"\x28\xb5\x2f\xfd"sv, "a zstd archive", kUnpack},
    {"Kaydara FBX Binary"sv, "an FBX file", kConvert},
    {"; FBX"sv, "an FBX file", kConvert},
    {"OFF\n"sv, "an OFF file", kConvert},
    {"PXR-USDC"sv, "a USD file", kConvert},
    {"#usda"sv, "a USD file", kConvert},
    {"BLENDER"sv, "a Blender file", "open it in Blender and export it: File > Export > glTF 2.0"},
    {"b3dm"sv, "a 3D Tiles file",
     "extract its GLB, for example with: npx 3d-tiles-tools b3dmToGlb -i FILE -o model.glb"},
    {"\x89PNG"sv, "a PNG picture", kOpenModel},
    {"\xff\xd8\xff"sv, "a JPEG picture", kOpenModel},
    {"%PDF"sv, "a PDF document", kOpenModel},
};

bool startsWithIgnoringCase(std::string_view text, std::string_view lower) {
    return text.size() >= lower.size() &&
           std::equal(lower.begin(), lower.end(), text.begin(), [](char a, char b) {
               return a == static_cast<char>(std::tolower(static_cast<unsigned char>(b)));
           });
}

std::string_view withoutLeadingSpace(std::string_view text) {
    if (text.starts_with("\xEF\xBB\xBF"))
        text.remove_prefix(3);
    const size_t start = text.find_first_not_of(" \t\r\n");
    return start == std::string_view::npos ? std::string_view() : text.substr(start);
}

} // namespace

void refuseOtherFormats(const ImportContext& context, std::span<const uint8_t> bytes) {
    const std::string_view all(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const auto refuse = [&](const std::string& what, const char* remedy) {
        context.fail("", "is " + what + ", not a glTF file", remedy);
    };
    for (const Magic& magic : kMagics)
        if (all.starts_with(magic.bytes))
            refuse(magic.what, magic.remedy);
    const std::string_view text = withoutLeadingSpace(all);
    if (startsWithIgnoringCase(text, "<!doctype html") || startsWithIgnoringCase(text, "<html"))
        refuse("a web page (HTML)", kDownload);
    if (text.starts_with("<?xml") || text.starts_with("<COLLADA"))
        text.substr(0, 1024).find("<COLLADA") != std::string_view::npos ? refuse("a COLLADA file", kConvert)
                                                                        : refuse("an XML file", kOpenModel);
}

void checkGltfVersion(const ImportContext& context, const json& gltf) {
    const auto asset = gltf.find("asset");
    const bool hasAsset = asset != gltf.end() && asset->is_object();
    const json version = hasAsset ? asset->value("version", json()) : json();
    const bool isTwo = version.is_string() && version.get<std::string>().size() >= 3 &&
                       version.get<std::string>().starts_with("2.");
    // glTF 1.0 stores its objects by name and need not state its version.
    const bool byName = std::ranges::any_of(
        std::initializer_list<const char*>{"accessors", "bufferViews", "buffers", "meshes", "nodes"},
        [&](const char* name) {
            const auto found = gltf.find(name);
            return found != gltf.end() && found->is_object();
        });
    const bool statesOne = (version.is_string() && version.get<std::string>().starts_with("1")) ||
                           (version.is_number() && version.get<double>() < 2.0);
    if (!isTwo && (statesOne || (version.is_null() && byName)))
        context.fail("asset.version",
                     version.is_string() ? "glTF version \"" + version.get<std::string>().substr(0, 20) +
                                               "\" is not supported: the file is glTF 1.0"
                                         : "the file is glTF 1.0, which is not supported",
                     kConvertGltf1);
    if (version.is_string() && !isTwo)
        context.fail("asset.version",
                     "glTF version \"" + version.get<std::string>().substr(0, 20) + "\" is not supported",
                     "export it as glTF 2.0");
    if (!hasAsset || !asset->contains("minVersion"))
        return;
    const json& least = (*asset)["minVersion"];
    if (least.is_string() && least != "2.0")
        context.fail("asset.minVersion", "the file demands glTF " + least.get<std::string>().substr(0, 20),
                     "export it as glTF 2.0");
}

} // namespace touchstone
