#include "engine/import/file/gltf_schema.h"

#include "engine/import/file/gltf_kind.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kAny = std::numeric_limits<double>::infinity();
constexpr double kMaxOffset =
    9007199254740991.0;                  // 2^53 - 1: exact in JSON; offsets stay far from 64-bit overflow
constexpr double kMaxInt = 2147483647.0; // limit of an int in the typed model

enum class Type {
    Count,     // integer in [low, high]
    Index,     // integer below the size of the top-level array `target`
    IndexMap,  // object whose values are each an Index
    IndexMaps, // array of them
    Indices,   // array of Index
    Number,    // in [low, high]
    Numbers,   // array of `size` numbers in [low, high]
    Flag,
    Text,
    Object,  // checked with `rules`
    Objects, // array of Object
    TextureInfo,
    Other // any value, not read here or checked where it is read
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
    bool mendable = false; // an error costs a warning and the value, not the file
};

/// For values that neither geometry nor safety depends on.
constexpr Rule mendable(Rule rule) {
    rule.mendable = true;
    return rule;
}
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
constexpr Rule objects(const char* name, std::span<const Rule> rules, bool required = false) {
    return {name, Type::Objects, required, -kAny, kAny, nullptr, 0, rules.data(), rules.size()};
}
constexpr Rule text(const char* name, bool required = false) {
    return {name, Type::Text, required};
}
constexpr Rule flag(const char* name) {
    return {name, Type::Flag};
}
constexpr Rule texture(const char* name) {
    return mendable({name, Type::TextureInfo});
}
constexpr Rule other(const char* name) {
    return {name, Type::Other};
}
constexpr Rule kName = mendable(text("name"));

// Zero-length buffers and views and accessors without elements cannot be wrong; validateGltf reports them.
constexpr Rule kAsset[] = {text("version", true), text("minVersion"), other("generator"), other("copyright")};
constexpr Rule kBuffer[] = {kName, text("uri"), count("byteLength", true, 0, kMaxOffset)};
constexpr Rule kBufferView[] = {kName,
                                index("buffer", "buffers", true),
                                count("byteOffset", false, 0, kMaxOffset),
                                count("byteLength", true, 0, kMaxOffset),
                                count("byteStride", false, 0, kMaxInt),
                                mendable(count("target", false, 0, kMaxInt))};
constexpr Rule kSparseIndices[] = {index("bufferView", "bufferViews", true),
                                   count("byteOffset", false, 0, kMaxInt),
                                   count("componentType", true, 5121, 5125)};
constexpr Rule kSparseValues[] = {index("bufferView", "bufferViews", true),
                                  count("byteOffset", false, 0, kMaxInt)};
constexpr Rule kSparse[] = {count("count", true, 0, kMaxInt), object("indices", kSparseIndices, true),
                            object("values", kSparseValues, true)};
constexpr Rule kAccessor[] = {kName,
                              index("bufferView", "bufferViews"),
                              count("byteOffset", false, 0, kMaxOffset),
                              count("componentType", true, 5120, 5126),
                              count("count", true, 0, kMaxInt),
                              text("type", true),
                              flag("normalized"),
                              object("sparse", kSparse),
                              mendable({"min", Type::Numbers}),
                              mendable({"max", Type::Numbers})};
constexpr Rule kImage[] = {kName, mendable(text("uri")), mendable(index("bufferView", "bufferViews")),
                           mendable(text("mimeType"))};
constexpr Rule kSampler[] = {
    kName, mendable(count("magFilter", false, 0, kMaxInt)), mendable(count("minFilter", false, 0, kMaxInt)),
    mendable(count("wrapS", false, 0, kMaxInt)), mendable(count("wrapT", false, 0, kMaxInt))};
constexpr Rule kTexture[] = {kName, mendable(index("source", "images")),
                             mendable(index("sampler", "samplers"))};
constexpr Rule kTextureInfo[] = {index("index", "textures", true), count("texCoord", false, 0, 1000),
                                 mendable(number("scale", -3e38, 3e38)),
                                 mendable(number("strength", -3e38, 3e38))};
constexpr Rule kPbr[] = {mendable(numbers("baseColorFactor", 4)), texture("baseColorTexture"),
                         mendable(number("metallicFactor")), mendable(number("roughnessFactor")),
                         texture("metallicRoughnessTexture")};
constexpr Rule kMaterial[] = {kName,
                              mendable(object("pbrMetallicRoughness", kPbr)),
                              texture("normalTexture"),
                              texture("occlusionTexture"),
                              texture("emissiveTexture"),
                              mendable(numbers("emissiveFactor", 3)),
                              mendable(text("alphaMode")),
                              mendable(number("alphaCutoff")),
                              mendable(flag("doubleSided"))};
constexpr Rule kPrimitive[] = {{"attributes", Type::IndexMap, true, 0, kAny, "accessors"},
                               index("indices", "accessors"),
                               mendable(index("material", "materials")),
                               count("mode", false, 0, 6),
                               {"targets", Type::IndexMaps, false, 0, kAny, "accessors"}};
constexpr Rule kMesh[] = {kName, objects("primitives", kPrimitive), numbers("weights", 0)};
constexpr Rule kNode[] = {kName,
                          {"children", Type::Indices, false, 0, kAny, "nodes"},
                          mendable(index("camera", "cameras")),
                          index("mesh", "meshes"),
                          index("skin", "skins"),
                          numbers("weights", 0),
                          numbers("matrix", 16),
                          numbers("translation", 3),
                          numbers("rotation", 4),
                          numbers("scale", 3)};
// `skeleton` affects no position (section 3.7.3.2) and is not read.
constexpr Rule kSkin[] = {kName,
                          other("skeleton"),
                          index("inverseBindMatrices", "accessors"),
                          {"joints", Type::Indices, true, 0, kAny, "nodes"}};
constexpr Rule kPerspective[] = {number("aspectRatio"), number("yfov"), number("zfar"), number("znear")};
constexpr Rule kOrthographic[] = {number("xmag"), number("ymag"), number("zfar"), number("znear")};
constexpr Rule kCamera[] = {kName, text("type", true), object("perspective", kPerspective),
                            object("orthographic", kOrthographic)};
constexpr Rule kScene[] = {kName, {"nodes", Type::Indices, false, 0, kAny, "nodes"}};
constexpr Rule kTarget[] = {index("node", "nodes"), text("path", true)};
constexpr Rule kChannel[] = {count("sampler", true, 0, kMaxInt), object("target", kTarget, true)};
constexpr Rule kAnimationSampler[] = {index("input", "accessors", true), index("output", "accessors", true),
                                      text("interpolation")};
constexpr Rule kAnimation[] = {kName, objects("samplers", kAnimationSampler, true),
                               objects("channels", kChannel, true)};

// Invalid geometry is refused. Invalid data for appearance or animation only is dropped: invalid objects of a
// mendable array become objects without properties, so that indices stay valid.
constexpr Rule kRoot[] = {object("asset", kAsset, true),
                          objects("buffers", kBuffer),
                          objects("bufferViews", kBufferView),
                          objects("accessors", kAccessor),
                          mendable(objects("images", kImage)),
                          mendable(objects("samplers", kSampler)),
                          mendable(objects("textures", kTexture)),
                          mendable(objects("materials", kMaterial)),
                          objects("meshes", kMesh),
                          objects("nodes", kNode),
                          objects("skins", kSkin),
                          objects("scenes", kScene),
                          mendable(objects("animations", kAnimation)),
                          mendable(objects("cameras", kCamera)),
                          other("extensionsUsed"),
                          other("extensionsRequired"),
                          index("scene", "scenes")};

/// Checks and repairs: integers written "36.0" become integers, invalid mendable values are removed.
class SchemaCheck {
  public:
    /// `tellUnknown`: warn about properties that glTF does not define.
    SchemaCheck(ImportContext& context, const json& root, bool tellUnknown)
        : context_(context), root_(root), tellUnknown_(tellUnknown) {}

    void checkObject(json& value, std::span<const Rule> rules, const std::string& place) const {
        if (!value.is_object())
            wrongType(place, value, "an object");
        for (const Rule& rule : rules) {
            const auto found = value.find(rule.name);
            const std::string at = place.empty() ? rule.name : place + "." + rule.name;
            if (found == value.end()) {
                if (rule.required)
                    context_.fail(place.empty() ? "root" : place,
                                  std::string("property '") + rule.name + "' is missing");
            } else if (!rule.mendable) {
                check(*found, rule, at);
            } else if (!context_.attempt("it is ignored", [&] { check(*found, rule, at); })) {
                value.erase(found);
            }
        }
        // Known extensions are checked where they are read; here only their container.
        if (const auto found = value.find("extensions"); found != value.end() && !found->is_object()) {
            context_.warn(place.empty() ? "extensions" : place + ".extensions",
                          "should be an object but is " + describe(*found) + "; it is ignored");
            value.erase(found);
        }
        if (tellUnknown_)
            warnOfUnknown(value, rules, place);
    }

  private:
    void warnOfUnknown(const json& value, std::span<const Rule> rules, const std::string& place) const {
        for (const auto& [name, unused] : value.items()) {
            const bool known = name == "extensions" || name == "extras" ||
                               std::any_of(rules.begin(), rules.end(),
                                           [&name = name](const Rule& rule) { return name == rule.name; });
            if (!known)
                context_.warn((place.empty() ? "" : place + ".") + name.substr(0, 60),
                              "is not a property of glTF; it is ignored");
        }
    }

    /// The size of a top-level array, 0 if it is absent (or not an array, which is reported separately).
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

    void check(json& value, const Rule& rule, const std::string& place) const {
        switch (rule.type) {
        case Type::Count:
            checkCount(value, rule, place);
            break;
        case Type::Index:
            checkIndex(value, sizeOf(rule.target), rule.target, place);
            break;
        case Type::IndexMap:
            checkIndexMap(value, rule, place);
            break;
        case Type::IndexMaps:
            if (!value.is_array())
                wrongType(place, value, "an array");
            for (size_t i = 0; i < value.size(); ++i)
                checkIndexMap(value[i], rule, place + "[" + std::to_string(i) + "]");
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
        case Type::Other:
            break;
        }
    }

    /// JSON has one kind of number: "36.0" is an integer (glTF 2.0, section 2.7).
    void checkInteger(json& value, const std::string& place) const {
        if (value.is_number_float() && isWhole(value.get<double>()))
            value = static_cast<int64_t>(value.get<double>());
        if (!value.is_number_integer())
            wrongType(place, value, "an integer");
    }

    void checkCount(json& value, const Rule& rule, const std::string& place) const {
        checkInteger(value, place);
        const double number = value.get<double>();
        if (!(number >= rule.low && number <= rule.high))
            outOfRange(value, rule, place);
    }

    void checkIndex(json& value, size_t size, const char* target, const std::string& place) const {
        checkInteger(value, place);
        const double number = value.get<double>();
        if (!(number >= 0 && number < static_cast<double>(size)))
            context_.fail(place,
                          "refers to " + std::string(target) + "[" + value.dump() + "], but there " +
                              (size == 1 ? "is 1 of them" : "are " + std::to_string(size) + " of them"));
    }

    void checkIndexMap(json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_object())
            wrongType(place, value, "an object");
        for (auto entry = value.begin(); entry != value.end(); ++entry)
            checkIndex(entry.value(), sizeOf(rule.target), rule.target, place + "." + entry.key());
    }

    void checkIndices(json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_array())
            wrongType(place, value, "an array");
        if (value.empty())
            context_.warn(place, kEmpty);
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

    void checkObjects(json& value, const Rule& rule, const std::string& place) const {
        if (!value.is_array())
            wrongType(place, value, "an array");
        if (value.empty())
            context_.warn(place, kEmpty);
        for (size_t i = 0; i < value.size(); ++i) {
            const std::string at = place + "[" + std::to_string(i) + "]";
            const auto checkOne = [&] { checkObject(value[i], {rule.rules, rule.ruleCount}, at); };
            if (!rule.mendable)
                checkOne();
            else if (!context_.attempt("it is left out", checkOne))
                value[i] = json::object();
        }
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

    static constexpr const char* kEmpty = "is empty: the specification asks for at least one entry";
    ImportContext& context_;
    const json& root_;
    bool tellUnknown_;
};

} // namespace

bool isWhole(double number) {
    return std::abs(number) <= kMaxOffset && number == std::floor(number);
}

void checkSchema(ImportContext& context, json& gltf) {
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
    checkGltfVersion(context, gltf);
    SchemaCheck(context, gltf, true).checkObject(gltf, kRoot, "");
}

void checkTextureInfo(ImportContext& context, const json& gltf, const json& info, const std::string& place) {
    json checked = info; // the fields that extensions add to a textureInfo are checked where they are read
    SchemaCheck(context, gltf, false).checkObject(checked, kTextureInfo, place);
}

} // namespace touchstone
