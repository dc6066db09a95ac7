#include "engine/import/volume_file/volume_edits.h"

#include "engine/core/error.h"
#include "engine/scene/physics.h"

#include <nlohmann/json.hpp>

#include <cstdint>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

/// Discarded where the text is no JSON.
Json parsed(const std::string& edits) {
    return edits.empty() ? Json::object() : Json::parse(edits, nullptr, false);
}

/// Removes a number; none where there is none.
std::optional<double> taken(std::string& edits, const char* name) {
    Json object = parsed(edits);
    if (!object.is_object())
        return std::nullopt;
    const auto found = object.find(name);
    if (found == object.end() || !found->is_number())
        return std::nullopt;
    const double value = found->get<double>();
    object.erase(name);
    edits = object.empty() ? std::string() : object.dump();
    return value;
}

} // namespace

std::string withChoices(const std::string& edits, const Scene& scene) {
    const bool loose = scene.physics != nullptr && scene.physics->loose;
    if (scene.volume == nullptr && scene.animation < 0 && !loose)
        return edits;
    Json object = parsed(edits);
    if (!object.is_object())
        throw Error("edits", "", "are no JSON object", "record again");
    if (scene.volume != nullptr)
        object["iso"] = scene.iso;
    if (scene.animation >= 0)
        object["animation"] = scene.animation;
    if (loose)
        object["loose"] = 1;
    return object.dump();
}

std::optional<double> takeIso(std::string& edits) {
    return taken(edits, "iso");
}

std::optional<std::string> takeAnimation(std::string& edits) {
    const std::optional<double> index = taken(edits, "animation");
    return index && *index >= 0.0 ? std::optional(std::to_string(static_cast<uint64_t>(*index)))
                                  : std::nullopt;
}

std::string withLoose(const std::string& edits) {
    Json object = parsed(edits);
    object["loose"] = 1;
    return object.dump();
}

bool takeLoose(std::string& edits) {
    return taken(edits, "loose").value_or(0.0) > 0.0;
}

} // namespace touchstone
