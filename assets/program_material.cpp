#include "assets/program_material.h"

#include <fstream>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>

namespace touchstone::assets {

namespace {

std::string sourceOf(const std::string& program) {
    std::ifstream file(std::string(TOUCHSTONE_PROGRAM_SOURCES) + "/" + program, std::ios::binary);
    std::string text((std::istreambuf_iterator<char>(file)), {});
    if (text.empty())
        throw std::runtime_error("there is no program " + program);
    return text;
}

} // namespace

int addMaterial(GlbWriter& glb, const ProgramMaterial& stated) {
    Json haptic = stated.haptic;
    haptic["shader"] = {{"bufferView", glb.addText(sourceOf(stated.program))}, {"name", stated.program}};
    if (!stated.parameters.empty())
        haptic["shader"]["parameters"] = stated.parameters;
    if (!stated.texture.empty())
        haptic["shader"]["persistentTexture"] = stated.texture;
    Json material{{"name", stated.program},
                  {"pbrMetallicRoughness",
                   {{"baseColorFactor", {stated.colour.x, stated.colour.y, stated.colour.z, 1.0}},
                    {"metallicFactor", stated.metallic},
                    {"roughnessFactor", stated.roughness}}}};
    material["extensions"]["TOUCHSTONE_materials_haptic"] = haptic;
    return glb.addMaterial(std::move(material));
}

} // namespace touchstone::assets
