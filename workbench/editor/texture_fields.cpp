#include "workbench/editor/texture_fields.h"

#include "engine/core/error.h"
#include "engine/import/file/gltf_file.h"
#include "engine/import/geometry/texture_mapping.h"
#include "engine/import/mesh_file/mesh_format.h"
#include "engine/import/volume_file/volume_format.h"
#include "engine/program/surface_program.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

using nlohmann::json;

constexpr std::string_view kPersistent = "shader.persistentTexture", kMapping = "textureMapping";
constexpr const char* kMember = "persistentTexture";
constexpr std::array<std::string_view, 5> kMembers{"width", "height", "initial", "minimum", "maximum"};

bool isPartOf(std::string_view name, std::string_view whole) {
    return name == whole || (name.starts_with(whole) && name[whole.size()] == '.');
}
/// What follows the dot; empty for the whole.
std::string memberOf(std::string_view name, std::string_view whole) {
    return std::string(name.size() > whole.size() ? name.substr(whole.size() + 1) : std::string_view());
}

/// "1,2.5" as JSON numbers, whole ones as integers; empty where it is no list of numbers.
json listOf(std::string_view text) {
    json numbers = json::array();
    while (true) {
        const size_t end = std::min(text.find(','), text.size());
        double number = 0.0;
        const auto [stop, error] = std::from_chars(text.data(), text.data() + end, number);
        if (error != std::errc{} || stop != text.data() + end || !std::isfinite(number))
            return json::array();
        constexpr double kWhole = 1e9;
        if (number == std::floor(number) && std::abs(number) < kWhole)
            numbers.push_back(static_cast<int64_t>(number));
        else
            numbers.push_back(number);
        if (end == text.size())
            return numbers;
        text.remove_prefix(end + 1);
    }
}

} // namespace

bool isPersistentField(std::string_view name) {
    return isPartOf(name, kPersistent);
}

std::string setPersistentField(HapticStatement& statement, std::string_view name, std::string_view text) {
    if (statement.program == nullptr)
        return "the material has no program that compiles";
    const std::string member = memberOf(name, kPersistent);
    const json numbers = listOf(text);
    json shader = static_cast<const json&>(statement.shader);
    json& texture = shader[kMember];
    if (texture.is_null())
        texture = json::object();
    if (member.empty()) {
        if (numbers.size() != 2)
            return "give WIDTH,HEIGHT in texels";
        texture["width"] = numbers[0];
        texture["height"] = numbers[1];
    } else if (std::ranges::find(kMembers, member) == kMembers.end()) {
        return "there are shader.persistentTexture=WIDTH,HEIGHT and its width, height, initial, minimum and "
               "maximum; --reset-field also knows values";
    } else if (numbers.size() != 1) {
        return "'" + std::string(text) + "' is not a number";
    } else {
        texture[member] = numbers[0];
    }
    if (member.empty() || member == "width" || member == "height")
        texture.erase("values"); // of another size
    try {
        (void)materialProgram(statement.program, shader);
    } catch (const Error& error) {
        return error.problem() + "; " + error.remedy();
    }
    statement.shader = KeptJson(std::move(shader));
    return {};
}

bool resetPersistentField(HapticStatement& statement, std::string_view name) {
    const std::string member = memberOf(name, kPersistent);
    json shader = static_cast<const json&>(statement.shader);
    if (!shader.is_object() || !shader.contains(kMember) || !shader[kMember].is_object())
        return false;
    if (member == "width" || member == "height")
        return false; // no texture is without them
    if ((member.empty() ? shader : shader[kMember]).erase(member.empty() ? kMember : member) == 0)
        return false;
    statement.shader = KeptJson(std::move(shader));
    return true;
}

bool isMappingField(std::string_view name) {
    return isPartOf(name, kMapping);
}

json mappingInFile(const std::filesystem::path& file, size_t material) {
    if (meshFormatNamed(file) || volumeFormatNamed(file))
        return nullptr;
    const LoadOptions options;
    ImportContext context(file.string(), options);
    const GltfFile gltf = readGltfFile(context, file);
    const json::json_pointer at("/materials/" + std::to_string(material) +
                                "/extensions/TOUCHSTONE_materials_haptic/" + std::string(kMapping));
    return gltf.json.contains(at) ? gltf.json[at] : json();
}

json withMappingField(json mapping, std::string_view name, std::string_view text) {
    const std::string member = memberOf(name, kMapping);
    if (member.empty() && text == "none")
        return nullptr;
    if (!mapping.is_object())
        mapping = json::object();
    if (member.empty() || member == "surface")
        mapping["surface"] = text;
    else if (member == "by")
        mapping["by"] = text;
    else if (member == "repeat" || member == "rotation")
        mapping[member] = listOf(text);
    else
        throw Error("--field", "", "'" + std::string(name) + "' is no field of textureMapping",
                    "there are textureMapping, .by, .repeat and .rotation");
    const LoadOptions options;
    ImportContext context("--field", options);
    (void)readTextureMapping(context, mapping, std::string(kMapping));
    return mapping;
}

std::string textureFieldHelp() {
    return "  shader.persistentTexture    WIDTH,HEIGHT: texels that touch changes; .initial, .minimum, "
           ".maximum: numbers\n"
           "  textureMapping              texture coordinates from the shape: plane, cylinder, sphere, box "
           "or "
           "none; .by:\n"
           "                              position or normal; .repeat: two numbers; .rotation: a quaternion "
           "x,y,z,w\n";
}

} // namespace touchstone
