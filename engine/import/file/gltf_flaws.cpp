#include "engine/import/file/gltf_flaws.h"

#include "engine/import/file/gltf_validation.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <set>
#include <span>
#include <string_view>
#include <vector>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr int kVertices = 34962, kIndices = 34963; // bufferView.target

const json& arrayOf(const json& gltf, const char* name) {
    static const json kNone = json::array();
    const auto found = gltf.find(name);
    return found == gltf.end() ? kNone : *found;
}

/// A permitted format of a vertex attribute (glTF 2.0, section 3.7.2.1; KHR_mesh_quantization).
struct Format {
    std::string_view semantic; ///< or its beginning, up to the set number
    bool quantized;            ///< with KHR_mesh_quantization only
    int componentType;
    bool normalized;
};
constexpr int kByte = 5120, kUnsignedByte = 5121, kShort = 5122, kUnsignedShort = 5123, kUnsignedInt = 5125,
              kFloat = 5126;
constexpr Format kFormats[] = {
    {"POSITION", false, kFloat, false},
    {"POSITION", true, kByte, false},
    {"POSITION", true, kByte, true},
    {"POSITION", true, kUnsignedByte, false},
    {"POSITION", true, kUnsignedByte, true},
    {"POSITION", true, kShort, false},
    {"POSITION", true, kShort, true},
    {"POSITION", true, kUnsignedShort, false},
    {"POSITION", true, kUnsignedShort, true},
    {"NORMAL", false, kFloat, false},
    {"NORMAL", true, kByte, true},
    {"NORMAL", true, kShort, true},
    {"TANGENT", false, kFloat, false},
    {"TANGENT", true, kByte, true},
    {"TANGENT", true, kShort, true},
    {"TEXCOORD_", false, kFloat, false},
    {"TEXCOORD_", false, kUnsignedByte, true},
    {"TEXCOORD_", false, kUnsignedShort, true},
    {"TEXCOORD_", true, kByte, false},
    {"TEXCOORD_", true, kByte, true},
    {"TEXCOORD_", true, kUnsignedByte, false},
    {"TEXCOORD_", true, kShort, false},
    {"TEXCOORD_", true, kShort, true},
    {"TEXCOORD_", true, kUnsignedShort, false},
    {"COLOR_", false, kFloat, false},
    {"COLOR_", false, kUnsignedByte, true},
    {"COLOR_", false, kUnsignedShort, true},
    {"JOINTS_", false, kUnsignedByte, false},
    {"JOINTS_", false, kUnsignedShort, false},
    {"WEIGHTS_", false, kFloat, false},
    {"WEIGHTS_", false, kUnsignedByte, true},
    {"WEIGHTS_", false, kUnsignedShort, true},
};

bool isSemantic(std::string_view semantic, std::string_view name) {
    if (!semantic.ends_with('_'))
        return name == semantic;
    return name.starts_with(semantic) && name.size() > semantic.size() &&
           std::all_of(name.begin() + static_cast<std::ptrdiff_t>(semantic.size()), name.end(),
                       [](char c) { return c >= '0' && c <= '9'; });
}

/// The users of a buffer view, for comparison with its target and stride.
struct ViewUse {
    bool indices = false, vertices = false;
    std::set<size_t> accessors; ///< of vertices
};

class Flaws {
  public:
    Flaws(ImportContext& context, const json& gltf)
        : context_(context), gltf_(gltf), uses_(arrayOf(gltf, "bufferViews").size()) {
        for (const json& name : arrayOf(gltf, "extensionsUsed"))
            quantized_ = quantized_ || name == "KHR_mesh_quantization";
    }

    void buffers() {
        const json& buffers = arrayOf(gltf_, "buffers");
        for (size_t i = 0; i < buffers.size(); ++i)
            if (buffers[i]["byteLength"] == 0)
                context_.warn(element("buffers", i), "has no bytes");
    }

    void meshes() {
        const json& meshes = arrayOf(gltf_, "meshes");
        for (size_t m = 0; m < meshes.size(); ++m) {
            if (!meshes[m].contains("primitives"))
                context_.warn(element("meshes", m), "has no primitives");
            const json& primitives = arrayOf(meshes[m], "primitives");
            for (size_t p = 0; p < primitives.size(); ++p)
                primitive(primitives[p], element("meshes", m) + "." + element("primitives", p));
        }
    }

    void accessors() {
        const json& accessors = arrayOf(gltf_, "accessors");
        for (size_t i = 0; i < accessors.size(); ++i)
            accessor(accessors[i], element("accessors", i));
    }

    /// After meshes().
    void views() {
        const json& views = arrayOf(gltf_, "bufferViews");
        for (size_t i = 0; i < views.size(); ++i)
            view(views[i], uses_[i], element("bufferViews", i));
    }

    void animations() {
        const json& animations = arrayOf(gltf_, "animations");
        for (size_t a = 0; a < animations.size(); ++a) {
            const json& samplers = arrayOf(animations[a], "samplers");
            for (size_t s = 0; s < samplers.size(); ++s)
                if (const json& input = accessorAt(samplers[s]["input"]);
                    !input.contains("min") || !input.contains("max"))
                    context_.warn(element("animations", a) + "." + element("samplers", s) + ".input",
                                  "is an accessor without the min and max that it must have");
        }
    }

  private:
    [[nodiscard]] const json& accessorAt(const json& index) const {
        return gltf_["accessors"][index.get<size_t>()];
    }

    void primitive(const json& primitive, const std::string& place) {
        for (const auto& [name, index] : primitive["attributes"].items())
            attribute(name, index, place + ".attributes." + name.substr(0, 60));
        if (!primitive.contains("indices"))
            return;
        const json& indices = accessorAt(primitive["indices"]);
        if (indices.contains("bufferView"))
            uses_[indices["bufferView"].get<size_t>()].indices = true;
        if (indices.value("normalized", false))
            context_.warn(place + ".indices", "is a normalised accessor, which indices must not be");
    }

    void attribute(const std::string& name, const json& index, const std::string& place) {
        const json& accessor = accessorAt(index);
        if (accessor.contains("bufferView")) {
            ViewUse& use = uses_[accessor["bufferView"].get<size_t>()];
            use.vertices = true;
            use.accessors.insert(index.get<size_t>());
        }
        if (name == "POSITION" && (!accessor.contains("min") || !accessor.contains("max")))
            context_.warn(place,
                          "is an accessor without the min and max that it must have; they are computed");
        const int type = accessor["componentType"];
        const bool normalized = accessor.value("normalized", false);
        if (name.starts_with('_')) {
            if (type == kUnsignedInt)
                context_.warn(place,
                              "is stored as unsigned 32-bit integers, which vertex attributes must not be");
            return;
        }
        const auto known = [&](const Format& format) { return isSemantic(format.semantic, name); };
        if (std::ranges::none_of(kFormats, known))
            context_.warn(place, "is not an attribute that glTF defines; it is ignored");
        else if (std::ranges::none_of(kFormats, [&](const Format& format) {
                     return known(format) && (quantized_ || !format.quantized) &&
                            format.componentType == type && format.normalized == normalized;
                 }))
            context_.warn(place, "is stored as component type " + std::to_string(type) +
                                     (normalized ? ", normalised," : "") +
                                     " which this attribute must not have");
    }

    void accessor(const json& accessor, const std::string& place) {
        const int type = accessor["componentType"];
        if (accessor["count"] == 0)
            context_.warn(place, "has no elements");
        if (accessor.value("normalized", false) && (type == kFloat || type == kUnsignedInt))
            context_.warn(place, "is normalised, which floats and 32-bit integers must not be");
        const uint64_t offset = accessor.value("byteOffset", uint64_t{0});
        if (!accessor.contains("bufferView")) {
            if (accessor.contains("byteOffset"))
                context_.warn(place + ".byteOffset", "is given without a bufferView; all elements are 0");
        } else {
            const json& view = gltf_["bufferViews"][accessor["bufferView"].get<size_t>()];
            if ((view.value("byteOffset", uint64_t{0}) + offset) % componentBytes(type) != 0)
                context_.warn(place + ".byteOffset",
                              "with its buffer view's is no multiple of the components' size");
        }
        for (const char* bound : {"min", "max"})
            if (accessor.contains(bound) &&
                accessor[bound].size() != static_cast<size_t>(componentCount(accessor["type"])))
                context_.warn(place + "." + bound,
                              "has " + std::to_string(accessor[bound].size()) +
                                  " numbers where the accessor has another number of components");
    }

    void view(const json& view, const ViewUse& use, const std::string& place) {
        const uint64_t length = view["byteLength"];
        if (length == 0)
            context_.warn(place, "has no bytes");
        if (view.contains("target")) {
            const int target = view["target"];
            if (target != kVertices && target != kIndices)
                context_.warn(place + ".target", std::to_string(target) + " is no target");
            if (use.indices && target == kVertices)
                context_.warn(place + ".target", "is for vertex attributes, but indices are read from it");
            if (use.vertices && target == kIndices)
                context_.warn(place + ".target", "is for indices, but vertex attributes are read from it");
        }
        if (use.indices && use.vertices)
            context_.warn(place, "holds both indices and vertex attributes");
        if (view.contains("byteStride")) {
            const uint64_t stride = view["byteStride"];
            if (stride > 252 || stride < 4 || stride % 4 != 0)
                context_.warn(place + ".byteStride", "is " + std::to_string(stride) +
                                                         ", it should be a multiple of four from 4 to 252");
            if (stride > length)
                context_.warn(place + ".byteStride", "is larger than the buffer view");
            if (use.indices && !use.vertices)
                context_.warn(place + ".byteStride", "is given for indices, which must have none");
        } else if (use.accessors.size() > 1) {
            context_.warn(place, "holds several vertex attributes without a byteStride");
        }
    }

    ImportContext& context_;
    const json& gltf_;
    std::vector<ViewUse> uses_;
    bool quantized_ = false;
};

} // namespace

void warnOfFlaws(ImportContext& context, const json& gltf) {
    Flaws flaws(context, gltf);
    flaws.buffers();
    flaws.accessors();
    flaws.meshes();
    flaws.views();
    flaws.animations();
}

} // namespace touchstone
