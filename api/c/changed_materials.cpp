#include "api/c/changed_materials.h"

#include "engine/core/json_number.h"
#include "engine/save/material_patch.h"
#include "engine/scene/haptic_layers.h"
#include "engine/scene/haptic_numbers.h"

#include <cmath>
#include <limits>
#include <sstream>

namespace touchstone::api {

namespace {

const HapticNumber& numberOf(std::string_view name) {
    const HapticNumber* number = findHapticNumber(name);
    if (number == nullptr || number->settled == nullptr)
        refuseArgument("name", "'" + std::string(name) + "' is no number of a material that may change");
    return *number;
}

void requireMaterial(uint64_t material, size_t count) {
    if (material >= count)
        refuseArgument("material", std::to_string(material) + ", and there are " + std::to_string(count));
}

void requireWithin(const HapticNumber& number, double value) {
    if (value >= number.least && value <= number.most)
        return;
    std::ostringstream text;
    text << number.name << " is not within " << number.least << " .. " << number.most << " " << number.unit;
    refuseArgument("value", text.str());
}

} // namespace

ChangedMaterials::ChangedMaterials(std::shared_ptr<TouchedScene> scene)
    : scene_(std::move(scene)), materials_(scene_->source()->materials), haptic_(scene_->haptic()) {}

void ChangedMaterials::set(uint64_t material, std::string_view name, double value) {
    const HapticNumber& number = numberOf(name);
    requireMaterial(material, materials_.size());
    const Scene& source = *scene_->source();
    const auto index = static_cast<size_t>(material);
    std::optional<float> stated = source.materials[index].says.ours.*number.stated;
    if (!std::isnan(value)) {
        requireWithin(number, value);
        stated = static_cast<float>(value);
    }
    std::vector<Material> after = materials_;
    after[index].says.ours.*number.stated = stated;
    after[index].haptic = settledHaptics(after[index].says, source.images);
    haptic_ = withMaterials(*haptic_, source, materials_, after);
    materials_ = std::move(after);
    if (std::isnan(value))
        changes_[index].erase(std::string(name));
    else
        changes_[index][std::string(name)] = *stated;
}

SceneIdentity ChangedMaterials::identity() const {
    SceneIdentity identity = scene_->identity();
    MaterialPatches patches;
    for (const auto& [material, values] : changes_) {
        const int inFile = materials_[material].fileIndex;
        for (const auto& [name, value] : values)
            if (inFile >= 0)
                patches[static_cast<size_t>(inFile)][name] = jsonOf(value);
    }
    if (!patches.empty())
        identity.edits = touchstone::textOf(patches); // in a unit with calls.cpp its own would hide it
    identity.feltHash = feltHash(*haptic_, *scene_->source());
    return identity;
}

double feltNumber(const Scene& scene, uint64_t material, std::string_view name) {
    const HapticNumber& number = numberOf(name);
    requireMaterial(material, scene.materials.size());
    const std::optional<float> value =
        (scene.materials[static_cast<size_t>(material)].haptic.*number.settled).value;
    return value ? *value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace touchstone::api
