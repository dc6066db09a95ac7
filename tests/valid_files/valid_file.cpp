#include "tests/valid_files/valid_file.h"

#include "tests/valid_files/material_parts.h"
#include "tests/valid_files/mesh_parts.h"
#include "tests/valid_files/node_parts.h"

namespace touchstone::test {
namespace {

using nlohmann::json;

void addOddities(FileDraft& draft) {
    json& file = draft.maker.json;
    if (draft.has(Feature::Extras)) {
        file["extras"] = {{"author", {{"name", "nobody"}}}, {"list", {1, nullptr, "three"}}};
        for (const char* array :
             {"nodes", "meshes", "materials", "accessors", "bufferViews", "textures", "animations"})
            if (file.contains(array))
                for (json& entry : file[array])
                    entry["extras"] = draft.draw.pick(
                        std::vector<json>{1, "text", {{"a", {1, 2}}}, nullptr, json::array()});
    }
    if (draft.has(Feature::UnknownExtensions)) {
        draft.use("ACME_colour_of_smell");
        file["extensions"]["ACME_colour_of_smell"] = {{"smells", {{{"note", "lemon"}}}}};
        file["nodes"][0]["extensions"]["ACME_colour_of_smell"] = {{"smell", 0}};
        draft.use("KHR_lights_punctual");
        file["extensions"]["KHR_lights_punctual"] = {{"lights", {{{"type", "point"}}}}};
    }
    if (draft.has(Feature::OddNames)) {
        file["nodes"][0]["name"] = "Knoten \u00e4\u00f6\u00fc \u6728 \"quoted\"\n\t\\";
        file["meshes"][0]["name"] = "";
        for (json& material : file.contains("materials") ? file["materials"] : file["meshes"])
            material["name"] = std::string(300, 'n');
    }
}

} // namespace

std::vector<uint8_t> validFile(const Recipe& recipe) {
    FileDraft draft(recipe);
    addMaterials(draft);
    for (size_t n = draft.has(Feature::SeveralMeshes) ? 2 + draft.draw.below(3) : 1; n > 0; --n)
        (void)addMesh(draft);
    addNodes(draft);
    addForeignHaptics(draft);
    addAnimations(draft);
    addOddities(draft);
    if (!draft.has(Feature::DataUris))
        return draft.maker.glb();
    draft.maker.json["buffers"] = {
        {{"byteLength", draft.maker.bytes.size()},
         {"uri", "data:application/octet-stream;base64," + base64(draft.maker.bytes)}}};
    const std::string text = draft.maker.json.dump(draft.draw.chance(0.5) ? 2 : -1);
    return {text.begin(), text.end()};
}

} // namespace touchstone::test
