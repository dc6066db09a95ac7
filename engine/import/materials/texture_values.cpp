#include "engine/import/materials/texture_values.h"

#include "engine/import/file/gltf_uri.h"

#include <nlohmann/json.hpp>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <map>
#include <utility>

namespace touchstone {

namespace {

using nlohmann::json;

static_assert(std::endian::native == std::endian::little, "floats are stored as they are in memory");

constexpr const char* kType = "application/zlib";
constexpr size_t kMostObjects = 4096;
/// Of all values of a material together: a few bytes of zlib may stand for each thousand.
constexpr size_t kMostBytes = size_t{512} << 20;
constexpr const char* kRemedy = "save the model again, or take the values out with touchstone edit "
                                "--reset-field shader.persistentTexture.values";

std::string packed(std::span<const float> values) {
    uLongf length = compressBound(static_cast<uLong>(values.size_bytes()));
    std::vector<uint8_t> bytes(length);
    if (compress2(bytes.data(), &length, reinterpret_cast<const Bytef*>(values.data()),
                  static_cast<uLong>(values.size_bytes()), Z_DEFAULT_COMPRESSION) != Z_OK)
        throw Error("persistentTexture.values", "", "could not be compressed", "save the model again");
    bytes.resize(length);
    return dataUriOf(kType, bytes);
}

int indexOf(const json& entry, const char* name) {
    const auto found = entry.find(name);
    if (found == entry.end() || !found->is_number_integer() || found->get<int64_t>() < 0 ||
        found->get<int64_t>() > int64_t{std::numeric_limits<int>::max()})
        return -1;
    return found->get<int>();
}

} // namespace

std::vector<int> surfacesOf(const Scene& scene) {
    std::map<int, int> placed; // by node
    std::vector<int> surfaces;
    for (const Instance& instance : scene.instances)
        surfaces.push_back(placed[instance.node]++);
    return surfaces;
}

json jsonOf(std::span<const TextureValues> objects) {
    json all = json::array();
    for (const TextureValues& each : objects)
        all.push_back({{"node", each.node}, {"surface", each.surface}, {"data", packed(each.values)}});
    return all;
}

std::vector<TextureValues> readTextureValues(const ImportContext& context, const json& stated,
                                             const PersistentTextureSize& size, const std::string& place) {
    if (!stated.is_array() || stated.size() > kMostObjects)
        context.fail(place, "should be an array of at most " + std::to_string(kMostObjects) + " objects",
                     kRemedy);
    if (stated.size() * size.width * size.height > kMostBytes / sizeof(float))
        context.fail(place,
                     "are more than " + std::to_string(kMostBytes >> 20) + " MiB, for " +
                         std::to_string(stated.size()) + " objects",
                     kRemedy);
    std::vector<TextureValues> all;
    for (size_t i = 0; i < stated.size(); ++i) {
        const json& entry = stated[i];
        const std::string at = place + "[" + std::to_string(i) + "]";
        if (!entry.is_object() || indexOf(entry, "node") < 0 || indexOf(entry, "surface") < 0 ||
            !entry.contains("data") || !entry["data"].is_string())
            context.fail(at, "should have a node, a surface and data", kRemedy);
        const auto& uri = entry["data"].get_ref<const std::string&>();
        if (!isDataUri(uri))
            context.fail(at + ".data", "should be a data URI", kRemedy);
        const std::vector<uint8_t> bytes = decodeDataUri(context, at + ".data", uri).bytes;
        TextureValues values{indexOf(entry, "node"), indexOf(entry, "surface"), {}};
        values.values.resize(size_t{size.width} * size.height);
        // One byte more than wanted: what is longer shows.
        std::vector<uint8_t> plain(values.values.size() * sizeof(float) + 1);
        auto length = static_cast<uLongf>(plain.size());
        if (uncompress(plain.data(), &length, bytes.data(), static_cast<uLong>(bytes.size())) != Z_OK ||
            length != plain.size() - 1)
            context.fail(at + ".data",
                         "are not the values of " + std::to_string(size.width) + " x " +
                             std::to_string(size.height) + " texels",
                         kRemedy);
        std::memcpy(values.values.data(), plain.data(), length);
        if (!std::ranges::all_of(values.values, [](float value) { return std::isfinite(value); }))
            context.fail(at + ".data", "have a value that is not finite", kRemedy);
        for (float& value : values.values)
            value = std::clamp(value, size.minimum, size.maximum);
        all.push_back(std::move(values));
    }
    return all;
}

} // namespace touchstone
