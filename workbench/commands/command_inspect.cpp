// Prints a model's contents and haptic properties, or what a haptic program is.

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "workbench/commands/inspect_program.h"
#include "workbench/figures/inspection.h"
#include "workbench/figures/perception_figures.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <string>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

void print(const char* format, const std::string& a, const std::string& b = {}) {
    std::printf(format, a.c_str(), b.c_str());
}

std::string text(const Json& json) {
    return json.is_string() ? json.get<std::string>() : json.dump();
}

void printEffects(const Json& material) {
    for (const auto& [name, field] : material["haptic"].items())
        std::printf("    %-24s %s %s (%s)\n", name.c_str(), text(field["value"]).c_str(),
                    text(field["unit"]).c_str(), text(field["source"]).c_str());
    for (const Json& effect : material["effects"])
        std::printf("    %-3s %-18s %10s bytes %6s ns  %s\n", effect["on"].get<bool>() ? "on" : "off",
                    text(effect["effect"]).c_str(), text(effect["memory_bytes"]).c_str(),
                    effect["ns_per_tick"].is_null() ? "?" : text(effect["ns_per_tick"]).c_str(),
                    text(effect["reason"]).c_str());
    if (material.contains("program")) {
        const Json& program = material["program"];
        std::printf("    program %s: %s instructions, %s registers; %s ns, with gradients %s ns, by central "
                    "differences %s ns; spends %s of its budget of %s%s%s\n",
                    text(program["name"]).c_str(), text(program["instructions"]).c_str(),
                    text(program["registers"]).c_str(), text(program["ns_per_tick"]).c_str(),
                    text(program["ns_with_gradients"]).c_str(), text(program["ns_with_differences"]).c_str(),
                    text(program["cost"]).c_str(), text(program["budget"]).c_str(),
                    program["flagged_share"] > 0.0 ? "; plain at places without a result: " : "",
                    text(program["fault"]).c_str());
        if (program.contains("persistentTexture")) {
            const Json& texture = program["persistentTexture"];
            std::printf("      persistent texture of %s x %s texels on %s objects, %s bytes\n",
                        text(texture["width"]).c_str(), text(texture["height"]).c_str(),
                        text(texture["objects"]).c_str(), text(texture["memory_bytes"]).c_str());
            for (const Json& saved : texture.value("saved", Json::array()))
                std::printf("        %s begins with %.1f %% left, as it was saved\n",
                            saved["object"].get<std::string>().c_str(), saved["left_percent"].get<double>());
        }
        for (const auto& [name, value] : program["parameters"].items())
            print("      %s = %s\n", name, value.dump());
    }
    if (material.contains("not_yet_available"))
        print("    not yet available: %s\n", material["not_yet_available"].dump());
}

/// What the file is made of.
void printContents(const Json& json) {
    print("%s\n", text(json["scene"]));
    std::printf("  %s triangles in %s meshes, %s instances, %s materials, %s images\n",
                text(json["triangles"]).c_str(), text(json["meshes"]).c_str(),
                text(json["instances"]).c_str(), std::to_string(json["materials"].size()).c_str(),
                std::to_string(json["images"].size()).c_str());
    if (json["lines"] > 0 || json["points"] > 0)
        print("  %s line segments and %s points, which are drawn but not felt\n", text(json["lines"]),
              text(json["points"]));
    if (!json["bounds_m"].is_null())
        print("  bounds %s to %s m", text(json["bounds_m"]["low"]), text(json["bounds_m"]["high"]));
    print(", fitted to the workspace by a factor of %s\n", text(json["workspace_from_scene_scale"]));
    if (json.contains("volume")) {
        const Json& volume = json["volume"];
        std::printf("  %s volume: %s voxels of %s, %s m apart, values %s to %s, surface at %s (Otsu's "
                    "threshold or what "
                    "the file states: %s)\n",
                    text(volume["format"]).c_str(), text(volume["voxels"]).c_str(),
                    text(volume["type"]).c_str(), text(volume["spacing_m"]).c_str(),
                    text(volume["values"]["low"]).c_str(), text(volume["values"]["high"]).c_str(),
                    text(volume["iso"]).c_str(), text(volume["default_iso"]).c_str());
        print("    %s bytes of values, %s bytes of the field that is felt\n", text(volume["memory_bytes"]),
              text(volume["field_memory_bytes"]));
    }
    if (!json["extensions_used"].empty())
        print("  extensions %s\n", json["extensions_used"].dump());
    for (size_t a = 0; a < json["animations"].size(); ++a) {
        const Json& animation = json["animations"][a];
        std::printf("  animation '%s', %s s: number %zu, deforms %s meshes%s\n",
                    text(animation["name"]).c_str(), text(animation["duration_s"]).c_str(), a,
                    text(animation["deformed_meshes"]).c_str(), animation["plays"] == true ? ", plays" : "");
    }
    for (const Json& camera : json["cameras"])
        std::printf("  camera %s '%s' at the node '%s', %s\n", text(camera["index"]).c_str(),
                    text(camera["name"]).c_str(), text(camera["node"]).c_str(), text(camera["type"]).c_str());
}

/// Its pictures and objects, as they are read for touch.
void printParts(const Json& json) {
    const auto decoded = std::count_if(json["images"].begin(), json["images"].end(),
                                       [](const Json& image) { return image["decoded"].get<bool>(); });
    if (!json["images"].empty())
        std::printf("  %td of %zu images decoded: those that the effects below read\n", decoded,
                    json["images"].size());
    for (const Json& object : json["objects"])
        if (const auto field = object.find("field"); field != object.end())
            std::printf("  object '%s': a distance field with voxels of %.3g mm, at most %.2g mm from its "
                        "triangles, %s bytes\n",
                        text(object["name"]).c_str(), 1e3 * (*field)["voxel_m"].get<double>(),
                        1e3 * (*field)["error_m"].get<double>(), text((*field)["memory_bytes"]).c_str());
        else
            std::printf("  object '%s': %s triangles, %s, %s vertices welded, %s triangles dropped\n",
                        text(object["name"]).c_str(), text(object["triangles"]).c_str(),
                        object["closed"].get<bool>() ? "closed" : "open",
                        text(object["welded_vertices"]).c_str(), text(object["dropped_triangles"]).c_str());
    print("%s", perceptionText(json["perception"]));
}

/// What it feels like, and what that costs.
void printFeel(const Json& json) {
    for (const Json& material : json["materials"]) {
        print("  material %s '%s'\n", text(material["index"]), text(material["name"]));
        printEffects(material);
    }
    if (!json["tick_p50_ns"].is_null()) {
        std::printf("  ns per tick in contact (median of a stroke):");
        for (const auto& [stage, cost] : json["tick_p50_ns"].items())
            if (stage != "ticks_in_contact")
                std::printf(" %s %s", stage.c_str(), text(cost).c_str());
        std::printf("\n");
    }
    const Json& walk = json["neighbourhood"];
    std::printf(
        "  contact=neighbourhood would take %s bytes and %.3f s; %s border edges, %s of more than two "
        "triangles\n",
        text(walk["memory_bytes"]).c_str(), walk["build_s"].get<double>(), text(walk["border_edges"]).c_str(),
        text(walk["non_manifold_edges"]).c_str());
    if (const Json& slopes = json["slopes"]; slopes["memory_bytes"] > 0)
        std::printf("  textureGradient=precomputed would take %s bytes and %.3f s\n",
                    text(slopes["memory_bytes"]).c_str(), slopes["build_s"].get<double>());
}

void printInspection(const Json& json) {
    printContents(json);
    printParts(json);
    printFeel(json);
    for (const Json& warning : json["warnings"])
        print("  warning: %s: %s\n", text(warning["place"]), text(warning["message"]));
}

} // namespace

int inspectCommand(const InspectOptions& options) {
    if (isProgramFile(options.scene)) {
        if (options.iso)
            throw Error(options.scene.string(), "", "a program has no value at its surface",
                        "leave out --iso");
        return inspectProgram(options.scene, options.json);
    }
    const Model model =
        loadModelToTouch(options.scene, Fit::Workspace, nullptr, options.iso, options.animation);
    const Json json = inspectionOf(model);
    printInspection(json);
    // A name that is not UTF-8 is replaced, so that the output stays valid.
    if (!options.json.empty())
        writeFile(options.json, json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n");
    return 0;
}

} // namespace touchstone
