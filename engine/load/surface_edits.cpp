#include "engine/load/surface_edits.h"

#include "engine/core/error.h"
#include "engine/core/json_number.h"
#include "engine/scene/haptic_layers.h"
#include "engine/scene/haptic_numbers.h"

#include <nlohmann/json.hpp>

namespace touchstone {

namespace {

constexpr const char* kSurface = "surface";

nlohmann::ordered_json editsFrom(const std::string& edits) {
    return edits.empty() ? nlohmann::ordered_json::object()
                         : nlohmann::ordered_json::parse(edits, nullptr, false);
}

} // namespace

std::string withSurfaceNumbers(const std::string& edits, const SurfaceNumbers& numbers) {
    if (numbers.empty())
        return edits;
    nlohmann::ordered_json object = editsFrom(edits);
    for (const auto& [name, value] : numbers)
        object[kSurface][name] = jsonOf(value);
    return object.dump();
}

SurfaceNumbers takeSurfaceNumbers(std::string& edits) {
    nlohmann::ordered_json object = editsFrom(edits);
    if (!object.is_object() || !object.contains(kSurface))
        return {};
    SurfaceNumbers numbers;
    for (const auto& [name, value] : object[kSurface].items()) {
        const HapticNumber* const number = findHapticNumber(name);
        if (number == nullptr || number->settled == nullptr || !value.is_number() ||
            !(value.get<float>() >= number->least && value.get<float>() <= number->most))
            throw Error("edits", kSurface, "has a number '" + name + "' that cannot be", "record again");
        numbers[name] = value.get<float>();
    }
    object.erase(kSurface);
    edits = object.empty() ? std::string() : object.dump();
    return numbers;
}

void stateSurfaceNumbers(Scene& scene, const SurfaceNumbers& numbers) {
    for (Material& material : scene.materials) {
        if (material.fileIndex >= 0 || numbers.empty())
            continue;
        for (const auto& [name, value] : numbers)
            material.says.ours.*findHapticNumber(name)->stated = value;
        material.haptic = settledHaptics(material.says, scene.images);
    }
}

} // namespace touchstone
