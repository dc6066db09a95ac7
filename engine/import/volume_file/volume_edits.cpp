#include "engine/import/volume_file/volume_edits.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

/// Discarded where the text is no JSON.
Json parsed(const std::string& edits) {
    return edits.empty() ? Json::object() : Json::parse(edits, nullptr, false);
}

} // namespace

std::string withIso(const std::string& edits, const Scene& scene) {
    if (scene.volume == nullptr)
        return edits;
    Json object = parsed(edits);
    if (!object.is_object())
        throw Error("edits", "", "are no JSON object", "record again");
    object["iso"] = scene.iso;
    return object.dump();
}

std::optional<double> takeIso(std::string& edits) {
    Json object = parsed(edits);
    if (!object.is_object())
        return std::nullopt;
    const auto found = object.find("iso");
    if (found == object.end() || !found->is_number())
        return std::nullopt;
    const double iso = found->get<double>();
    object.erase("iso");
    edits = object.empty() ? std::string() : object.dump();
    return iso;
}

} // namespace touchstone
