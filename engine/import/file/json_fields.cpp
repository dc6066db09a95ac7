#include "engine/import/file/json_fields.h"

#include "engine/import/file/gltf_schema.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <limits>

namespace touchstone {

using nlohmann::json;

const json* extensionOf(const ImportContext& context, const json& object, const char* name,
                        const std::string& place) {
    const auto extensions = object.find("extensions");
    if (extensions == object.end() || !extensions->is_object())
        return nullptr;
    const auto found = extensions->find(name);
    if (found == extensions->end())
        return nullptr;
    if (!found->is_object())
        context.fail((place.empty() ? "" : place + ".") + "extensions." + name, "should be an object");
    return &*found;
}

std::optional<float> numberField(const ImportContext& context, const json& object, const char* name,
                                 const std::string& place, double low, double high) {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    if (!found->is_number())
        context.fail(at, "should be a number", "correct the value in the file");
    const double value = found->get<double>();
    constexpr double kMaxFloat = std::numeric_limits<float>::max();
    if (!(value >= std::max(low, -kMaxFloat) && value <= std::min(high, kMaxFloat)))
        context.fail(at, found->dump() + " is out of range",
                     "give a value " + (high < kMaxFloat
                                            ? "from " + json(low).dump() + " to " + json(high).dump()
                                            : "of at least " + json(low).dump()));
    return static_cast<float>(value);
}

std::optional<int> indexField(const ImportContext& context, const json& object, const char* name,
                              const std::string& place, size_t size, const char* what) {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    if (!found->is_number() || !isWhole(found->get<double>()))
        context.fail(at, "should be an integer", "correct the value in the file");
    const double value = found->get<double>();
    if (!(value >= 0 && value < static_cast<double>(size)))
        context.fail(at,
                     "refers to " + std::string(what) + "[" + found->dump() + "], but there are " +
                         std::to_string(size) + " of them",
                     "correct the index in the file");
    return found->get<int>();
}

std::optional<std::string> textField(const ImportContext& context, const json& object, const char* name,
                                     const std::string& place) {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    if (!found->is_string())
        context.fail(place + "." + name, "should be a string", "correct the value in the file");
    return found->get<std::string>();
}

std::optional<glm::vec2> pairField(const ImportContext& context, const json& object, const char* name,
                                   const std::string& place) {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    if (!found->is_array() || found->size() != 2 || !(*found)[0].is_number() || !(*found)[1].is_number())
        context.fail(place + "." + name, "should be two numbers", "correct the value in the file");
    const glm::vec2 pair((*found)[0].get<double>(), (*found)[1].get<double>());
    if (!std::isfinite(pair.x) || !std::isfinite(pair.y))
        context.fail(place + "." + name, "is beyond what a 32-bit number holds",
                     "correct the value in the file");
    return pair;
}

} // namespace touchstone
