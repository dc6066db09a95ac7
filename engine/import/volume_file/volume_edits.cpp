#include "engine/import/volume_file/volume_edits.h"

#include "engine/core/error.h"

#include <nlohmann/json.hpp>

namespace touchstone {

namespace {

using Json = nlohmann::ordered_json;

Json objectIn(const std::string& edits) {
    Json object = edits.empty() ? Json::object() : Json::parse(edits, nullptr, false);
    if (!object.is_object())
        throw Error("edits", "", "are no JSON object", "record again");
    return object;
}

} // namespace

std::string withIso(const std::string& edits, const Scene& scene) {
    if (scene.volume == nullptr)
        return edits;
    Json object = objectIn(edits);
    object["iso"] = scene.iso;
    return object.dump();
}

std::optional<double> takeIso(std::string& edits) {
    Json object = objectIn(edits);
    const auto found = object.find("iso");
    if (found == object.end() || !found->is_number())
        return std::nullopt;
    const double iso = found->get<double>();
    object.erase("iso");
    edits = object.empty() ? std::string() : object.dump();
    return iso;
}

} // namespace touchstone
