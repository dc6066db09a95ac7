#include "api/c/changed_materials.h"

#include "engine/core/json_number.h"
#include "engine/import/volume_file/volume_edits.h"
#include "engine/load/surface_edits.h"
#include "engine/save/material_patch.h"
#include "engine/scene/haptic_layers.h"
#include "engine/scene/haptic_numbers.h"

#include <algorithm>
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
    requireBelow(material, materials_.size(), "material");
    const Scene& source = *scene_->source();
    const auto index = static_cast<size_t>(material);
    if (!std::isnan(value))
        requireWithin(number, value);
    std::vector<Material> after = materials_;
    for (size_t i = 0; i < after.size(); ++i) {
        if (std::max(after[i].fileIndex, -1) != std::max(after[index].fileIndex, -1))
            continue;
        after[i].says.ours.*number.stated = std::isnan(value) ? source.materials[i].says.ours.*number.stated
                                                              : std::optional(static_cast<float>(value));
        after[i].haptic = settledHaptics(after[i].says, source.images);
    }
    haptic_ = withMaterials(*haptic_, source, materials_, after);
    materials_ = std::move(after);
    auto& changes = changes_[std::max(materials_[index].fileIndex, -1)];
    if (std::isnan(value))
        changes.erase(std::string(name));
    else
        changes[std::string(name)] = static_cast<float>(value);
}

SceneIdentity ChangedMaterials::identity(bool felt) const {
    SceneIdentity identity = scene_->identity();
    MaterialPatches patches;
    SurfaceNumbers surface;
    for (const auto& [inFile, values] : changes_) {
        if (inFile < 0)
            surface = values;
        for (const auto& [name, value] : values)
            if (inFile >= 0)
                patches[static_cast<size_t>(inFile)][name] = jsonOf(value);
    }
    identity.edits =
        withChoices(withSurfaceNumbers(touchstone::textOf(patches), surface), // not textOf of calls.h
                    *scene_->source());
    if (felt)
        identity.feltHash = feltHash(*haptic_, *scene_->source());
    return identity;
}

double feltNumber(const std::vector<Material>& materials, uint64_t material, std::string_view name) {
    const HapticNumber& number = numberOf(name);
    requireBelow(material, materials.size(), "material");
    const std::optional<float> value =
        (materials[static_cast<size_t>(material)].haptic.*number.settled).value;
    return value ? *value : std::numeric_limits<double>::quiet_NaN();
}

} // namespace touchstone::api
