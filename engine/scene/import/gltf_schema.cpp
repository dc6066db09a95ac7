#include "engine/scene/import/gltf_schema.h"

#include <cmath>
#include <initializer_list>
#include <limits>
#include <span>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kMaxOffset =
    9007199254740991.0;                  // 2^53 - 1: exact in JSON; offsets stay far from 64-bit overflow
constexpr double kMaxInt = 2147483647.0; // what the typed model holds in an int

enum class Type {
    Count,    // integer in [low, high]
    Index,    // integer below the size of the top-level array `target`
    IndexMap, // object whose values are each an Index
    Indices,  // array of Index
    Number,   // in [low, high]
    Numbers,  // array of `size` numbers in [low, high]
    Flag,
    Text,
    Object,  // checked with `rules`
    Objects, // array of them, at least `size` of them
    TextureInfo
};

struct Rule {
    const char* name;
    Type type;
    bool required = false;
    double low = -kAny, high = kAny;
    const char* target = nullptr;
    size_t size = 0;
    const Rule* rules = nullptr;
    size_t ruleCount = 0;
};

constexpr Rule count(const char* name, bool required, double low, double high) {
    return {name, Type::Count, required, low, high};
}
constexpr Rule index(const char* name, const char* target, bool required = false) {
    return {name, Type::Index, required, 0, kAny, target};
}
constexpr Rule number(const char* name, double low = -kAny, double high = kAny) {
    return {name, Type::Number, false, low, high};
}
constexpr Rule numbers(const char* name, size_t size, double low = -kAny, double high = kAny) {
    return {name, Type::Numbers, false, low, high, nullptr, size};
}
constexpr Rule object(const char* name, std::span<const Rule> rules, bool required = false) {
    return {name, Type::Object, required, -kAny, kAny, nullptr, 0, rules.data(), rules.size()};
}
constexpr Rule objects(const char* name, std::span<const Rule> rules, bool required, size_t atLeast) {
    return {name, Type::Objects, required, -kAny, kAny, nullptr, atLeast, rules.data(), rules.size()};
}
constexpr Rule text(const char* name, bool required = false) {
    return {name, Type::Text, required};
}
constexpr Rule flag(const char* name) {
    return {name, Type::Flag};
}
constexpr Rule texture(const char* name) {
    return {name, Type::TextureInfo};
}

constexpr Rule kAsset[] = {text("version", true), text("minVersion")};
constexpr Rule kBuffer[] = {text("name"), text("uri"), count("byteLength", true, 1, kMaxOffset)};
constexpr Rule kBufferView[] = {text("name"),
                                index("buffer", "buffers", true),
                                count("byteOffset", false, 0, kMaxOffset),
                                count("byteLength", true, 1, kMaxOffset),
                                count("byteStride", false, 4, 252),
                                count("target", false, 0, kMaxInt)};
constexpr Rule kSparseIndices[] = {index("bufferView", "bufferViews", true),
                                   count("byteOffset", false, 0, kMaxInt),
                                   count("componentType", true, 5121, 5125)};
constexpr Rule kSparseValues[] = {index("bufferView", "bufferViews", true),
                                  count("byteOffset", false, 0, kMaxInt)};
constexpr Rule kSparse[] = {count("count", true, 1, kMaxInt), object("indices", kSparseIndices, true),
                            object("values", kSparseValues, true)};
constexpr Rule kAccessor[] = {text("name"),
                              index("bufferView", "bufferViews"),
                              count("byteOffset", false, 0, kMaxOffset),
                              count("componentType", true, 5120, 5126),
                              count("count", true, 1, kMaxInt),
                              text("type", true),
                              flag("normalized"),
                              object("sparse", kSparse),
                              {"min", Type::Numbers},
                              {"max", Type::Numbers}};
constexpr Rule kImage[] = {text("name"), text("uri"), index("bufferView", "bufferViews"), text("mimeType")};
constexpr Rule kSampler[] = {text("name"), count("magFilter", false, 0, kMaxInt),
                             count("minFilter", false, 0, kMaxInt), count("wrapS", false, 0, kMaxInt),
                             count("wrapT", false, 0, kMaxInt)};
constexpr Rule kTexture[] = {text("name"), index("source", "images"), index("sampler", "samplers")};
constexpr Rule kTextureInfo[] = {index("index", "textures", true), count("texCoord", false, 0, 1000),
                                 number("scale"), number("strength")};
constexpr Rule kPbr[] = {numbers("baseColorFactor", 4), texture("baseColorTexture"), number("metallicFactor"),
                         number("roughnessFactor"), texture("metallicRoughnessTexture")};
constexpr Rule kMaterial[] = {text("name"),
                              object("pbrMetallicRoughness", kPbr),
                              texture("normalTexture"),
                              texture("occlusionTexture"),
                              texture("emissiveTexture"),
                              numbers("emissiveFactor", 3),
                              text("alphaMode"),
                              number("alphaCutoff"),
                              flag("doubleSided")};
constexpr Rule kPrimitive[] = {{"attributes", Type::IndexMap, true, 0, kAny, "accessors"},
                               index("indices", "accessors"),
                               index("material", "materials"),
                               count("mode", false, 0, 6)};
constexpr Rule kMesh[] = {text("name"), objects("primitives", kPrimitive, true, 1)};
constexpr Rule kNode[] = {text("name"),
                          {"children", Type::Indices, false, 0, kAny, "nodes"},
                          index("mesh", "meshes"),
                          numbers("matrix", 16),
                          numbers("translation", 3),
                          numbers("rotation", 4),
                          numbers("scale", 3)};
constexpr Rule kScene[] = {text("name"), {"nodes", Type::Indices, false, 0, kAny, "nodes", 1}};
constexpr Rule kTarget[] = {index("node", "nodes"), text("path", true)};
constexpr Rule kChannel[] = {count("sampler", true, 0, kMaxInt), object("target", kTarget, true)};
constexpr Rule kAnimationSampler[] = {index("input", "accessors", true), index("output", "accessors", true),
                                      text("interpolation")};
constexpr Rule kAnimation[] = {text("name"), objects("samplers", kAnimationSampler, true, 0),
                               objects("channels", kChannel, true, 0)};

// Empty top-level arrays are errors of the file (section 5: minItems 1), like a wrong type is.
constexpr Rule kRoot[] = {object("asset", kAsset, true),
                          objects("buffers", kBuffer, false, 1),
                          objects("bufferViews", kBufferView, false, 1),
                          objects("accessors", kAccessor, false, 1),
                          objects("images", kImage, false, 1),
                          objects("samplers", kSampler, false, 1),
                          objects("textures", kTexture, false, 1),
                          objects("materials", kMaterial, false, 1),
                          objects("meshes", kMesh, false, 1),
                          objects("nodes", kNode, false, 1),
                          objects("scenes", kScene, false, 1),
                          objects("animations", kAnimation, false, 0),
                          index("scene", "scenes")};

class SchemaCheck {
  public:
    SchemaCheck(const ImportContext& context, const json& root) : context_(context), root_(root) {}

    void checkObject(const json& value, std::span<const Rule> rules, const std::string& place) const {
        if (!value.is_object())
            wrongType(place, value, "an object");
        for (const Rule& rule : rules) {
            const auto found = value.find(rule.name);
            const std::string at = place.empty() ? rule.name : place + "." + rule.name;
            if (found != value.end())
                check(*found, rule, at);
            else if (rule.required)
                context_.fail(place.empty() ? "root" : place,
                              std::string("property '") + rule.name + "' is missing");
        }
        // Extensions that we know are checked where they are read; here only their container.
        if (!place.empty() && value.contains("extensions") && !value["extensions"].is_object())
            wrongType(place + ".extensions", value["extensions"], "an object");
    }

  private:
    /// The size of a top-level array, 0 if it is absent (or not an array: told in its own place).
    [[nodiscard]] size_t sizeOf(const char* name) const {
        const auto found = root_.find(name);
        return found != root_.end() && found->is_array() ? found->size() : 0;
    }

    [[noreturn]] void wrongType(const std::string& place, const json& value, const char* expected) const {
        context_.fail(place, std::string("should be ") + expected + " but is " + describe(value));
    }

    static std::string describe(const json& value) {
        switch (value.type()) {
        case json::value_t::null:
            return "null";
        case json::value_t::object:
            return "an object";
        case json::value_t::array:
            return "an array";
        case json::value_t::string:
            return "a string";
        case json::value_t::boolean:
            return "a boolean";
        default:
            return "the number " + value.dump();
        }
    }

    void check(const json& value, const Rule& rule, const std::string& place) const {
        switch (rule.type) {
        case Type::Count:
            checkCount(value, rule, place);
            break;
        case Type::Index:
            checkIndex(value, sizeOf(rule.target), rule.target, place);
            break;
        case Type::IndexMap:
            if (!value.is_object())
                wrongType(place, value, "an object");
            for (const auto& [name, entry] : value.items())
                checkIndex(entry, sizeOf(rule.target), rule.target, place + "." + name);
            break;
        case Type::Indices:
            checkIndices(value, rule, place);
            break;
        case Type::Number:
            checkNumber(value, rule, place);
            break;
        case Type::Numbers:
            checkNumbers(value, rule, place);
            break;
        case Type::Flag:
            if (!value.is_boolean())
                wrongType(place, value, "true or false");
            break;
        case Type::Text:
            if (!value.is_string())
                wrongType(place, value, "a string");
            break;
        case Type::Object:
            checkObject(value, {rule.rules, rule.ruleCount}, place);
            break;
        case Type::Objects:
            checkObjects(value, rule, place);
            break;
        case Type::TextureInfo:
            checkObject(value, kTextureInfo, place);
            break;
        }
    }

    void checkCount(const json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_number_integer())
            wrongType(place, value, "an integer");
        const double number = value.get<double>();
        if (!(number >= rule.low && number <= rule.high))
            outOfRange(value, rule, place);
    }

    void checkIndex(const json& value, size_t size, const char* target, const std::string& place) const {
        if (!value.is_number_integer())
            wrongType(place, value, "an integer");
        const double number = value.get<double>();
        if (!(number >= 0 && number < static_cast<double>(size)))
            context_.fail(place,
                          "refers to " + std::string(target) + "[" + value.dump() + "], but there " +
                              (size == 1 ? "is 1 of them" : "are " + std::to_string(size) + " of them"));
    }

    void checkIndices(const json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_array())
            wrongType(place, value, "an array");
        if (value.size() < rule.size)
            context_.fail(place, "is empty", "remove the empty array, or re-export the model");
        const size_t size = sizeOf(rule.target);
        for (size_t i = 0; i < value.size(); ++i)
            checkIndex(value[i], size, rule.target, place + "[" + std::to_string(i) + "]");
    }

    void checkNumber(const json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_number())
            wrongType(place, value, "a number");
        const double number = value.get<double>();
        if (!(number >= rule.low && number <= rule.high))
            outOfRange(value, rule, place);
    }

    void checkNumbers(const json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_array())
            wrongType(place, value, "an array of numbers");
        if (rule.size != 0 && value.size() != rule.size)
            context_.fail(place, "should hold " + std::to_string(rule.size) + " numbers but holds " +
                                     std::to_string(value.size()));
        for (const json& each : value)
            checkNumber(each, rule, place);
    }

    void checkObjects(const json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_array())
            wrongType(place, value, "an array");
        if (value.size() < rule.size)
            context_.fail(place, "is empty", "remove the empty array, or re-export the model");
        for (size_t i = 0; i < value.size(); ++i)
            checkObject(value[i], {rule.rules, rule.ruleCount}, place + "[" + std::to_string(i) + "]");
    }

    [[noreturn]] void outOfRange(const json& value, const Rule& rule, const std::string& place) const {
        const auto shown = [](double v) {
            return v == std::floor(v) && std::abs(v) < 1e6 ? json(static_cast<int>(v)).dump()
                                                           : json(v).dump();
        };
        std::string allowed = "at least " + shown(rule.low);
        if (rule.high < 1e6)
            allowed += " and at most " + shown(rule.high);
        context_.fail(place, value.dump() + " is out of range, it must be " + allowed);
    }

    const ImportContext& context_;
    const json& root_;
};

} // namespace

void checkSchema(ImportContext& context, const json& gltf) {
    size_t total = 0;
    for (const auto& [name, value] : gltf.items())
        total += value.is_array() ? value.size() : 0;
    if (total > kMaxJsonObjects)
        context.fail("",
                     "holds " + std::to_string(total) + " objects, more than the limit of " +
                         std::to_string(kMaxJsonObjects),
                     "split the model into several files");
    const auto materials = gltf.find("materials");
    if (materials != gltf.end() && materials->size() > kMaxMaterials)
        context.fail("materials", "holds more than the limit of " + std::to_string(kMaxMaterials),
                     "split the model into several files");
    SchemaCheck(context, gltf).checkObject(gltf, kRoot, "");
    for (const char* unused : {"cameras", "skins"}) {
        const auto found = gltf.find(unused);
        if (found != gltf.end() && (!found->is_array() || found->empty()))
            context.warn(unused, "is not an array with entries; it is not used here");
    }
}

void checkTextureInfo(ImportContext& context, const json& gltf, const json& info, const std::string& place) {
    SchemaCheck(context, gltf).checkObject(info, kTextureInfo, place);
}

} // namespace touchstone
