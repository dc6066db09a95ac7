#include "workbench/editor/material_edits.h"

#include "engine/core/json_number.h"
#include "engine/scene/haptic_layers.h"
#include "workbench/editor/haptic_fields.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

template <class Field>
Json wordOf(const Field& field, const HapticStatement& statement) {
    const auto choice = field.get(statement);
    return choice ? Json(field.choices[*choice]) : Json(nullptr);
}

Json numberOr(std::optional<float> value) {
    return value ? jsonOf(*value) : Json(nullptr);
}

Json unless(float value, float unset) {
    return value == unset ? Json(nullptr) : jsonOf(value);
}

void partsOf(const HeightMap& map, Json& json) {
    json["scale"] = jsonOf(map.scale);
    json["midLevel"] = unless(map.midLevel, HeightMap{}.midLevel);
}
void partsOf(const FactorMap& map, Json& json) {
    json["min"] = unless(map.min, FactorMap{}.min);
    json["max"] = unless(map.max, FactorMap{}.max);
}

/// All members of a map, missing ones as null.
template <class Map>
Json jsonOfMap(const Map& map) {
    Json json{{"index", map.texture.texture}};
    json["texCoord"] = map.texture.texCoord == 0 ? Json(nullptr) : Json(map.texture.texCoord);
    partsOf(map, json);
    return json;
}

template <class Map>
void patchMap(const char* name, const std::optional<Map>& from, const std::optional<Map>& to, Json& patch) {
    if (from == to)
        return;
    if (!to) {
        patch[name] = nullptr;
        return;
    }
    Json whole = jsonOfMap(*to);
    if (from) {
        const Json before = jsonOfMap(*from);
        for (const auto& [part, value] : before.items())
            if (whole[part] == value)
                whole.erase(part);
        // KHR_texture_transform may name its own set, which takes precedence.
        if (from->texture.texCoord != to->texture.texCoord)
            whole["extensions"]["KHR_texture_transform"]["texCoord"] = nullptr;
    }
    patch[name] = std::move(whole);
}

/// RFC 7396: what turns `from` into `to`; members that `to` lacks are null.
Json mergePatch(const nlohmann::json& from, const nlohmann::json& to) {
    if (!from.is_object() || !to.is_object())
        return Json(to);
    Json patch = Json::object();
    for (const auto& [name, value] : from.items())
        if (!to.contains(name))
            patch[name] = nullptr;
    for (const auto& [name, value] : to.items())
        if (!from.contains(name))
            patch[name] = value;
        else if (from[name] != value)
            patch[name] = mergePatch(from[name], value);
    return patch;
}

} // namespace

Json patchBetween(const HapticStatement& from, const HapticStatement& to) {
    Json patch = Json::object();
    for (const NumberField& field : numberFields())
        if (field.name.find('.') == std::string_view::npos && field.get(from) != field.get(to))
            patch[std::string(field.name)] = numberOr(field.get(to));
    patchMap("heightTexture", from.height, to.height, patch);
    patchMap("frictionTexture", from.friction, to.friction, patch);
    patchMap("stiffnessTexture", from.stiffnessMap, to.stiffnessMap, patch);
    patchMap("dampingTexture", from.dampingMap, to.dampingMap, patch);
    for (const ChoiceField& field : choiceFields())
        if (field.get(from) != field.get(to))
            patch[std::string(field.name)] = wordOf(field, to);
    if (from.shader != to.shader)
        patch["shader"] = mergePatch(from.shader, to.shader);
    return patch;
}

MaterialEdits::MaterialEdits(const Scene& scene) {
    for (const Material& material : scene.materials) {
        if (material.fileIndex < 0)
            continue;
        const auto index = static_cast<size_t>(material.fileIndex);
        file_.resize(std::max(file_.size(), index + 1));
        file_[index] = material.says.ours;
    }
    now_ = file_;
}

void MaterialEdits::change(size_t material, HapticStatement next, std::string what) {
    if (next == now_[material])
        return;
    ++revision_;
    steps_.resize(at_); // discards undone steps
    if (open_ && at_ > 0 && steps_.back().material == material && steps_.back().what == what) {
        steps_.back().after = next;
    } else {
        steps_.push_back({material, now_[material], next, std::move(what)});
        ++at_;
    }
    open_ = true;
    now_[material] = std::move(next);
}

void MaterialEdits::replace(size_t material, const std::function<HapticStatement(HapticStatement)>& with) {
    ++revision_;
    open_ = false;
    now_[material] = with(std::move(now_[material]));
    for (Step& step : steps_)
        if (step.material == material) {
            step.before = with(std::move(step.before));
            step.after = with(std::move(step.after));
        }
}

void MaterialEdits::replaceNow(size_t material, HapticStatement statement) {
    ++revision_;
    now_[material] = std::move(statement);
}

void MaterialEdits::replaceInFile(size_t material, std::shared_ptr<const SurfaceProgram> program) {
    file_[material].program = std::move(program);
}

void MaterialEdits::undo() {
    open_ = false;
    if (at_ == 0)
        return;
    ++revision_;
    const Step& step = steps_[--at_];
    now_[step.material] = step.before;
}

void MaterialEdits::redo() {
    open_ = false;
    if (at_ == steps_.size())
        return;
    ++revision_;
    const Step& step = steps_[at_++];
    now_[step.material] = step.after;
}

MaterialPatches MaterialEdits::patches() const {
    MaterialPatches patches;
    for (size_t m = 0; m < now_.size(); ++m)
        if (Json patch = edited(m) ? patchBetween(file_[m], now_[m]) : Json(); !patch.empty())
            patches[m] = std::move(patch); // a program in a file of its own leaves none
    return patches;
}

std::vector<Material> editedMaterials(const Scene& scene, std::span<const HapticStatement> statements) {
    std::vector<Material> materials = scene.materials;
    for (Material& material : materials) {
        if (material.fileIndex < 0)
            continue;
        const HapticStatement& ours = statements[static_cast<size_t>(material.fileIndex)];
        if (material.says.ours == ours)
            continue;
        material.says.ours = ours;
        material.haptic = settledHaptics(material.says, scene.images);
    }
    return materials;
}

} // namespace touchstone
