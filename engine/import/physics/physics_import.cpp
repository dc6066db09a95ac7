#include "engine/import/physics/physics_import.h"

#include <cmath>

namespace touchstone {

using nlohmann::json;

const json* PhysicsImport::statedAt(size_t n, const char* part, std::string& place) const {
    const auto gltfNode = static_cast<size_t>(forest.gltfOfNode[n]);
    const json* stated =
        extensionOf(context, document.json["nodes"][gltfNode], kPhysics, element("nodes", gltfNode));
    if (stated == nullptr || !stated->contains(part))
        return nullptr;
    place = placeOf(n) + "." + part;
    const json& found = (*stated)[part];
    if (!found.is_object())
        context.fail(place, "should be an object");
    return &found;
}

const json* PhysicsImport::listOf(const char* extension, const char* name) const {
    const json* root = extensionOf(context, document.json, extension, "");
    if (root == nullptr || !root->contains(name))
        return nullptr;
    const json& list = (*root)[name];
    if (!list.is_array())
        context.fail(std::string("extensions.") + extension + "." + name, "should be an array");
    return &list;
}

std::optional<std::vector<double>> PhysicsImport::numbers(const json& object, const char* name,
                                                          const std::string& place, size_t count) const {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    if (!found->is_array() || (count > 0 && found->size() != count))
        context.fail(at, "should be an array" +
                             (count > 0 ? " of " + std::to_string(count) + " numbers" : std::string()));
    std::vector<double> values;
    for (const json& value : *found) {
        if (!value.is_number() || !(std::abs(value.get<double>()) < kAny))
            context.fail(at, "has an element that is no finite number");
        values.push_back(value.get<double>());
    }
    return values;
}

} // namespace touchstone
