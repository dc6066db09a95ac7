#include "engine/import/file/gltf_extensions.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <set>
#include <string_view>

namespace touchstone {
namespace {

using nlohmann::json;

/// Supported, or irrelevant to appearance and touch.
constexpr std::array<std::string_view, 23> kRead = {
    "KHR_mesh_quantization",
    "KHR_texture_transform",
    "KHR_draco_mesh_compression",
    "EXT_mesh_gpu_instancing",
    "EXT_meshopt_compression",
    "EXT_texture_webp",
    "TOUCHSTONE_materials_haptic",
    "TOUCHSTONE_soft_body",
    "MPEG_haptic_material",
    "MPEG_material_haptic",
    "KHR_physics_rigid_bodies",
    "KHR_implicit_shapes",
    "KHR_collision_shapes",
    "KHR_materials_clearcoat",
    "KHR_materials_emissive_strength",
    "KHR_materials_ior",
    "KHR_materials_pbrSpecularGlossiness",
    "KHR_materials_sheen",
    "KHR_materials_specular",
    "KHR_materials_transmission",
    "KHR_materials_unlit",
    "KHR_materials_volume",
    "KHR_xmp_json_ld", // metadata
};

struct Missed {
    std::string_view name; ///< or its beginning, with a '*' at the end
    const char* loss;
    bool geometry = false; ///< the geometry would be wrong for a file that requires it
};
/// The first match counts.
constexpr Missed kMissed[] = {
    {"KHR_texture_basisu", "its compressed textures are left out"},
    {"MSFT_texture_dds", "its compressed textures are left out"},
    {"EXT_texture_avif", "its AVIF textures are left out"},
    {"EXT_texture_astc", "its compressed textures are left out"},
    {"KHR_materials_variants", "its materials cannot be switched, the default ones are drawn"},
    {"KHR_materials_*", "its materials look simpler than intended"},
    {"ADOBE_materials_*", "its materials look simpler than intended"},
    {"KHR_techniques_webgl", "its materials are drawn without its shaders"},
    {"KHR_blend", "its materials are drawn without its blending"},
    {"KHR_lights_punctual", "its lamps do not shine"},
    {"EXT_lights_*", "its lamps do not shine"},
    {"KHR_node_visibility", "hidden nodes are shown", true},
    {"KHR_animation_pointer", "only nodes are animated"},
    {"KHR_audio*", "its sounds are not played"},
    {"MSFT_audio_emitter", "its sounds are not played"},
    {"MSFT_lod", "only the finest level of detail is shown"},
    {"KHR_interactivity", "it does not react"},
    {"MPEG_scene_interactivity", "it does not react"},
    {"MPEG_node_interactivity", "it does not react"},
    {"MPEG_haptic", "its recorded haptic signals are not played"},
    {"MPEG_audio_spatial", "its sounds are not played"},
    {"MPEG_viewport_recommended", "its recommended views are not shown"},
    {"VRM*", "it is shown without what VRM adds to avatars"},
    {"AGI_articulations", "its parts cannot be moved"},
    {"CESIUM_primitive_outline", "its outlines are not drawn"},
    {"CESIUM_RTC", "it is placed about its own origin"},
    {"EXT_structural_metadata", "its metadata are not shown"},
    {"EXT_mesh_features", "its metadata are not shown"},
    {"EXT_instance_features", "its metadata are not shown"},
};

const Missed* missed(std::string_view name) {
    for (const Missed& each : kMissed) {
        const bool open = each.name.ends_with('*');
        if (open ? name.starts_with(each.name.substr(0, each.name.size() - 1)) : name == each.name)
            return &each;
    }
    return nullptr;
}

bool isRead(std::string_view name) {
    return std::find(kRead.begin(), kRead.end(), name) != kRead.end();
}

/// The names in extensionsUsed or extensionsRequired, each once.
std::set<std::string> namesIn(ImportContext& context, const json& gltf, const char* list) {
    std::set<std::string> names;
    const auto found = gltf.find(list);
    if (found == gltf.end())
        return names;
    if (!found->is_array())
        context.fail(list, "should be an array of strings");
    for (size_t i = 0; i < found->size(); ++i) {
        if (!(*found)[i].is_string())
            context.fail(element(list, i), "should be a string");
        const std::string name = (*found)[i];
        if (!names.insert(name).second)
            context.warn(list, name.substr(0, 60) + " is named twice");
    }
    return names;
}

/// The names of all extensions anywhere in the file except in its extras. Excludes the extensions' own
/// content.
void collectExtensions(const json& value, std::set<std::string>& names) {
    if (value.is_object()) {
        for (const auto& [name, child] : value.items())
            if (name == "extensions" && child.is_object())
                for (const auto& [extension, unused] : child.items())
                    names.insert(extension);
            else if (name != "extras" && name != "extensions")
                collectExtensions(child, names);
    } else if (value.is_array()) {
        for (const json& child : value)
            if (child.is_structured())
                collectExtensions(child, names);
    }
}

} // namespace

void checkExtensions(ImportContext& context, json& gltf) {
    std::set<std::string> used;
    if (!context.attempt("it is ignored", [&] { used = namesIn(context, gltf, "extensionsUsed"); }))
        gltf.erase("extensionsUsed");
    const std::set<std::string> required = namesIn(context, gltf, "extensionsRequired");
    for (const std::string& name : required) {
        const Missed* loss = missed(name);
        if (!isRead(name) && (loss == nullptr || loss->geometry))
            context.fail("extensionsRequired",
                         "the file needs the extension " + name.substr(0, 60) + ", which is not supported",
                         "re-export the model without " + name.substr(0, 60));
        if (!used.contains(name))
            context.warn("extensionsRequired",
                         name.substr(0, 60) + " is required but not named in extensionsUsed");
    }
    const auto tell = [&](const char* place, const std::string& name) {
        const Missed* loss = missed(name);
        if (!isRead(name))
            context.warn(place, name.substr(0, 60) + " is not supported: " +
                                    (loss != nullptr ? loss->loss : "what it adds is left out"));
    };
    for (const std::string& name : used)
        tell(required.contains(name) ? "extensionsRequired" : "extensionsUsed", name);
    if (const auto root = gltf.find("extensions"); root != gltf.end())
        for (const auto& [name, value] : root->items())
            if (!value.is_object() && !isRead(name))
                context.warn("extensions." + name.substr(0, 60), "should be an object; it is ignored");
    std::set<std::string> present;
    collectExtensions(gltf, present);
    for (const std::string& name : present)
        if (!used.contains(name) && !required.contains(name)) {
            context.warn("extensions", name.substr(0, 60) + " is used but not named in extensionsUsed");
            tell("extensions", name);
        }
}

} // namespace touchstone
