#include "engine/save/material_patch.h"

#include "engine/core/error.h"
#include "engine/import/file/gltf_file.h"
#include "engine/import/file/gltf_uri.h"
#include "engine/import/mesh_file/mesh_import.h"
#include "engine/import/volume_file/volume_format.h"
#include "engine/save/json_parts.h"
#include "engine/save/replace_file.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <string_view>
#include <system_error>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kOurs = "TOUCHSTONE_materials_haptic";
constexpr const char* kReexport = "re-export the model";

/// Position of a file's JSON. In a GLB it follows the header (12 bytes) and its chunk's (8).
struct TextSpan {
    size_t begin = 0, end = 0;
    bool isGlb = false;
};

uint32_t wordAt(std::span<const uint8_t> bytes, size_t at) {
    uint32_t word = 0;
    for (size_t i = 4; i-- > 0;)
        word = word << 8 | bytes[at + i];
    return word;
}

void putWord(std::vector<uint8_t>& bytes, size_t at, uint64_t word) {
    for (size_t i = 0; i < 4; ++i)
        bytes[at + i] = static_cast<uint8_t>(word >> 8 * i);
}

TextSpan textSpan(std::span<const uint8_t> bytes, bool isGlb) {
    constexpr size_t kJson = 20, kLength = 12;
    return isGlb ? TextSpan{kJson, kJson + wordAt(bytes, kLength), true} : TextSpan{0, bytes.size(), false};
}

/// The value that a patch creates where there is none: without members that only remove.
Json withoutNulls(const Json& value) {
    if (!value.is_object())
        return value;
    Json result = Json::object();
    for (const auto& [name, member] : value.items()) {
        if (member.is_null())
            continue;
        Json kept = withoutNulls(member);
        if (!kept.is_object() || !kept.empty() || member.empty())
            result[name] = std::move(kept);
    }
    return result;
}

/// RFC 7396 on text, so that members outside the patch keep their spelling.
std::string merged(std::string_view object, const Json& patch) {
    std::string result(object);
    for (const auto& [name, value] : patch.items()) {
        if (value.is_null()) {
            result = withoutMember(result, name);
            continue;
        }
        const auto member = jsonMember(result, name);
        if (value.is_object() && member && member->of(result).starts_with('{')) {
            result = withMember(result, name, merged(member->of(result), value));
            continue;
        }
        const Json kept = withoutNulls(value);
        if (!kept.is_object() || !kept.empty() || value.empty())
            result = withMember(result, name, kept.dump());
    }
    return result;
}

bool isEmpty(std::string_view object) {
    return jsonParts(object).empty();
}

std::string patchedMaterial(std::string_view material, const Json& patch) {
    const auto extensions = jsonMember(material, "extensions");
    const std::string all(extensions ? extensions->of(material) : "{}");
    const auto ours = jsonMember(all, kOurs);
    const std::string stated = merged(ours ? ours->of(all) : "{}", patch);
    const std::string rest = isEmpty(stated) ? withoutMember(all, kOurs) : withMember(all, kOurs, stated);
    return isEmpty(rest) ? withoutMember(material, "extensions") : withMember(material, "extensions", rest);
}

/// The array `materials` with the patches applied, from the last to the first: earlier offsets stay valid.
std::string patchedMaterials(std::string_view materials, const MaterialPatches& patches,
                             const std::string& shownAs) {
    const std::vector<JsonPart> parts = jsonParts(materials);
    std::string result(materials);
    for (auto patch = patches.rbegin(); patch != patches.rend(); ++patch) {
        const auto& [index, change] = *patch;
        if (index >= parts.size())
            throw Error(shownAs, "materials[" + std::to_string(index) + "]",
                        "the file has no such material: it has " + std::to_string(parts.size()),
                        "open it again, or name one that it has");
        const JsonPart& part = parts[index];
        result.replace(part.begin, part.end - part.begin, patchedMaterial(part.of(materials), change));
    }
    return result;
}

/// Lists the extension in `extensionsUsed` exactly if some material has it.
std::string withExtensionNamed(std::string root, const std::string& shownAs) {
    const auto used = jsonMember(root, "extensionsUsed");
    const std::string name = Json(kOurs).dump();
    const bool wanted = countKeys(root, kOurs) > 0;
    if (!used)
        return wanted ? withMember(root, "extensionsUsed", "[" + name + "]") : root;
    const std::string list(used->of(root));
    const nlohmann::json names = nlohmann::json::parse(list);
    if (!names.is_array())
        throw Error(shownAs, "extensionsUsed", "should be an array", kReexport);
    const bool named = std::find(names.begin(), names.end(), kOurs) != names.end();
    if (named == wanted)
        return root;
    if (wanted)
        return withMember(root, "extensionsUsed", withElement(list, name));
    const std::string left = withoutMember(list, kOurs);
    return isEmpty(left) ? withoutMember(root, "extensionsUsed") : withMember(root, "extensionsUsed", left);
}

std::string patchedRoot(std::string_view root, const MaterialPatches& patches, const std::string& shownAs) {
    const auto materials = jsonMember(root, "materials");
    std::string list =
        patchedMaterials(materials ? materials->of(root) : std::string_view("[]"), patches, shownAs);
    return withExtensionNamed(withMember(root, "materials", list), shownAs);
}

/// The file with other JSON. A GLB's chunk is padded with spaces to a multiple of four, as the format
/// requires.
std::vector<uint8_t> withText(std::span<const uint8_t> bytes, const TextSpan& span, std::string text,
                              const std::string& shownAs) {
    if (span.isGlb)
        text.append((4 - text.size() % 4) % 4, ' ');
    const size_t length = span.end - span.begin;
    std::vector<uint8_t> result(bytes.size() - length + text.size());
    auto out = std::copy_n(bytes.begin(), span.begin, result.begin());
    out = std::copy(text.begin(), text.end(), out);
    std::copy(bytes.begin() + static_cast<std::ptrdiff_t>(span.end), bytes.end(), out);
    if (span.isGlb) {
        const uint64_t total = uint64_t{wordAt(bytes, 8)} - length + text.size();
        if (total > kMaxFileBytes)
            throw Error(shownAs, "", "would be larger than the 4 GiB that a GLB can be",
                        "save it as .gltf with a modelling program first");
        putWord(result, 8, total);
        putWord(result, 12, text.size());
    }
    return result;
}

/// The first external file that it needs; empty: none.
std::string externalUri(const nlohmann::json& root) {
    for (const char* array : {"buffers", "images"})
        if (const auto list = root.find(array); list != root.end() && list->is_array())
            for (const nlohmann::json& each : *list)
                if (each.is_object() && each.contains("uri") && each["uri"].is_string() &&
                    !isDataUri(each["uri"].get_ref<const std::string&>()))
                    return each["uri"];
    return {};
}

GltfFile takenApart(std::span<const uint8_t> bytes, const std::string& shownAs) {
    const LoadOptions options;
    ImportContext context(shownAs, options);
    return takeGltfApart(context, {bytes.begin(), bytes.end()}, {});
}

std::filesystem::path folderOf(const std::filesystem::path& file) {
    std::error_code ignored;
    return std::filesystem::weakly_canonical(std::filesystem::absolute(file), ignored).parent_path();
}

/// The programs beside a model that some material names.
std::vector<std::string> programUris(const nlohmann::json& root) {
    std::vector<std::string> uris;
    const nlohmann::json none = nlohmann::json::array();
    const auto materials = root.find("materials");
    for (const nlohmann::json& material : materials != root.end() ? *materials : none) {
        if (!material.is_object())
            continue;
        const nlohmann::json::json_pointer at("/extensions/" + std::string(kOurs) + "/shader/source");
        if (!material.contains(at) || !material[at].is_string())
            continue;
        const auto& uri = material[at].get_ref<const std::string&>();
        if (!isDataUri(uri) && std::ranges::find(uris, uri) == uris.end())
            uris.push_back(uri);
    }
    return uris;
}

/// Programs beside `source`, for a target in another folder: the files to write there. One that cannot be
/// read is left out: the model says so whenever it is opened.
std::vector<ProgramFile> programsFor(ImportContext& context, const nlohmann::json& root,
                                     const std::filesystem::path& source, const std::filesystem::path& target,
                                     std::span<const ProgramFile> edited) {
    std::vector<ProgramFile> files;
    const std::filesystem::path from = source.parent_path(), to = target.parent_path();
    if (inOneFolder(source, target))
        return files;
    for (const std::string& uri : programUris(root)) {
        ProgramFile file;
        bool exists = false;
        try {
            const std::filesystem::path own = resolveUri(context, "shader.source", from, uri);
            file.file = resolveUri(context, "shader.source", to, uri);
            const auto typed = std::ranges::find(edited, own, &ProgramFile::file);
            const auto text = [&](const std::filesystem::path& path) {
                const std::vector<uint8_t> bytes = readWholeFile(path, path.string());
                return std::string(bytes.begin(), bytes.end());
            };
            file.text = typed != edited.end() ? typed->text : text(own);
            std::error_code none;
            exists = std::filesystem::exists(file.file, none);
            if (exists && text(file.file) == file.text)
                continue;
        } catch (const Error&) {
            continue;
        }
        if (exists)
            throw Error(file.file.string(), "", "is another program than the model's; nothing was written",
                        "move it away, or save the model into another folder");
        files.push_back(std::move(file));
    }
    return files;
}

void checkTarget(const GltfFile& file, const std::filesystem::path& source,
                 const std::filesystem::path& target) {
    namespace fs = std::filesystem;
    std::string ending = target.extension().string();
    std::transform(ending.begin(), ending.end(), ending.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    const std::string_view right = file.isGlb ? ".glb" : ".gltf";
    if (ending != right && !(ending == ".vrm" && file.isGlb))
        throw Error(target.string(), "", "would be a " + std::string(right) + " of another name",
                    "end the name in " + std::string(right) + (file.isGlb ? "" : ", as what was opened is"));
    const fs::path from = folderOf(source), to = folderOf(target);
    if (const std::string uri = externalUri(file.json); from != to && !uri.empty())
        throw Error(target.string(), "",
                    "would not find \"" + uri.substr(0, 200) + "\" and what else it needs",
                    "save it beside that, in " + from.string());
}

} // namespace

bool inOneFolder(const std::filesystem::path& a, const std::filesystem::path& b) {
    return folderOf(a) == folderOf(b);
}

std::string textOf(const MaterialPatches& patches) {
    Json json = Json::object();
    for (const auto& [index, patch] : patches)
        json[std::to_string(index)] = patch;
    return json.empty() ? std::string() : json.dump();
}

MaterialPatches patchesFrom(const std::string& text) {
    MaterialPatches patches;
    if (text.empty())
        return patches;
    const Json json = Json::parse(text, nullptr, false);
    const auto bad = [] { return Error("edits of materials", "", "are damaged", "record them again"); };
    if (!json.is_object())
        throw bad();
    for (const auto& [name, patch] : json.items()) {
        size_t index = 0;
        const auto [end, error] = std::from_chars(name.data(), name.data() + name.size(), index);
        if (error != std::errc{} || end != name.data() + name.size() || !patch.is_object())
            throw bad();
        patches[index] = patch;
    }
    return patches;
}

std::vector<uint8_t> withMaterials(std::span<const uint8_t> bytes, const MaterialPatches& patches,
                                   const std::string& shownAs) {
    const GltfFile file = takenApart(bytes, shownAs);
    if (patches.empty())
        return {bytes.begin(), bytes.end()};
    const TextSpan span = textSpan(bytes, file.isGlb);
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()) + span.begin,
                                span.end - span.begin);
    std::string patched = patchedRoot(text, patches, shownAs);
    if (span.isGlb)
        patched.erase(patched.find_last_not_of(' ') + 1);
    return withText(bytes, span, std::move(patched), shownAs);
}

FileStamp saveMaterials(const std::filesystem::path& source, const FileStamp& loaded,
                        const MaterialPatches& patches, const std::filesystem::path& target,
                        std::span<const ProgramFile> programs) {
    const std::string shownAs = source.string();
    if (volumeFormatNamed(source))
        throw Error(shownAs, "", "a volume has no place for what is felt; nothing was written",
                    "record the session: a recording keeps the changes");
    std::vector<uint8_t> bytes = readWholeFile(source, shownAs);
    if (stampOf(bytes) != loaded)
        throw Error(shownAs, "", "has changed since it was opened; nothing was written",
                    "open it again and make the changes anew, or copy this version elsewhere");
    const LoadOptions options;
    ImportContext context(shownAs, options);
    std::error_code none; // of a target that does not exist
    if (const auto format = meshFormatOf(context, bytes)) {
        if (std::filesystem::equivalent(source, target, none))
            throw Error(shownAs, "",
                        std::string(nameOf(*format)) + " has no place for what is felt; nothing was written",
                        "save it as a new .glb");
        bytes = asGltf(context, std::move(bytes));
    }
    const GltfFile file = takenApart(bytes, shownAs);
    checkTarget(file, source, target);
    const std::vector<uint8_t> result = withMaterials(bytes, patches, shownAs);
    for (const ProgramFile& program : programsFor(context, file.json, source, target, programs)) {
        std::filesystem::create_directories(program.file.parent_path());
        replaceFile(program.file,
                    {reinterpret_cast<const uint8_t*>(program.text.data()), program.text.size()});
    }
    replaceFile(target, result);
    return stampOf(result);
}

} // namespace touchstone
