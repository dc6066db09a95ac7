#include "engine/import/geometry/instancing.h"

#include "engine/import/file/json_fields.h"
#include "engine/import/geometry/gltf_accessors.h"
#include "engine/scene/animation.h"

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

constexpr const char* kExtension = "EXT_mesh_gpu_instancing";

/// One of the three attributes that place copies: empty if the file does not contain it.
struct Attribute {
    std::string place;
    int accessor = -1;
    std::vector<float> values;

    [[nodiscard]] bool stated() const { return accessor >= 0; }
};

class CopyReader {
  public:
    CopyReader(ImportContext& context, const GltfDocument& document, const nlohmann::json& attributes,
               std::string place, uint64_t before)
        : context_(context), document_(document), attributes_(attributes), place_(std::move(place)),
          before_(before) {}

    std::optional<std::vector<glm::dmat4>> read() {
        Attribute translation = find("TRANSLATION", 3), rotation = find("ROTATION", 4),
                  scale = find("SCALE", 3);
        if (!count_)
            return std::nullopt;
        checkLimit(*count_);
        for (Attribute* attribute : {&translation, &rotation, &scale})
            fill(*attribute);
        context_.spendGeometry(*count_ * sizeof(glm::dmat4), place_);
        std::vector<glm::dmat4> copies(*count_);
        size_t lost = 0;
        for (size_t i = 0; i < copies.size(); ++i) {
            Node copy;
            if (translation.stated())
                copy.translation = vectorAt(translation, i);
            if (scale.stated())
                copy.scale = vectorAt(scale, i);
            if (rotation.stated() && !setRotation(&rotation.values[4 * i], copy))
                ++lost;
            copies[i] = parentFromNode(copy);
        }
        if (lost > 0)
            context_.warn(rotation.place,
                          std::to_string(lost) +
                              " rotations are quaternions of length 0; these copies are not turned");
        return copies;
    }

  private:
    Attribute find(const char* name, int components) {
        Attribute attribute;
        attribute.place = place_ + ".attributes." + name;
        const auto accessor = indexField(context_, attributes_, name, place_ + ".attributes",
                                         document_.model.accessors.size(), "accessors");
        if (!accessor)
            return attribute;
        if (accessorComponents(document_, *accessor) != components)
            context_.fail(attribute.place, "should have " + std::to_string(components) + " components");
        if (!accessorHasData(document_, *accessor)) {
            context_.warn(attribute.place, "its buffer is declared without data; ignored");
            return attribute;
        }
        const size_t count = accessorCount(document_, *accessor);
        if (count_ && *count_ != count)
            context_.fail(attribute.place, "has " + std::to_string(count) +
                                               " copies where another attribute has " +
                                               std::to_string(*count_));
        count_ = count;
        attribute.accessor = *accessor;
        return attribute;
    }

    void checkLimit(uint64_t count) const {
        const uint64_t limit = std::max(kFreeCopies, context_.fileBytes() / kFileBytesPerCopy);
        if (before_ + count > limit)
            context_.fail(place_,
                          "the file places more than " + std::to_string(limit) +
                              " copies of meshes, far beyond its own data",
                          "place fewer copies, or split the model into several files");
    }

    void fill(Attribute& attribute) const {
        if (!attribute.stated())
            return;
        attribute.values = readFloats(context_, document_, attribute.accessor, attribute.place);
        const auto broken = std::find_if(attribute.values.begin(), attribute.values.end(),
                                         [](float value) { return !std::isfinite(value); });
        const size_t components = attribute.values.size() / std::max<size_t>(*count_, 1);
        if (broken != attribute.values.end())
            context_.fail(
                attribute.place,
                "copy " +
                    std::to_string(static_cast<size_t>(broken - attribute.values.begin()) / components) +
                    " is not a finite number");
    }

    static glm::dvec3 vectorAt(const Attribute& attribute, size_t i) {
        return {attribute.values[3 * i], attribute.values[3 * i + 1], attribute.values[3 * i + 2]};
    }

    static bool setRotation(const float* xyzw, Node& copy) {
        const glm::dquat stated(xyzw[3], xyzw[0], xyzw[1], xyzw[2]);
        const double length = glm::length(stated);
        if (length > 1e-6)
            copy.rotation = stated / length;
        return length > 1e-6;
    }

    ImportContext& context_;
    const GltfDocument& document_;
    const nlohmann::json& attributes_;
    std::string place_;
    uint64_t before_;
    std::optional<size_t> count_;
};

} // namespace

std::optional<std::vector<glm::dmat4>> readCopies(ImportContext& context, const GltfDocument& document,
                                                  size_t gltfNode, uint64_t before) {
    const std::string place = element("nodes", gltfNode);
    const nlohmann::json* extension =
        extensionOf(context, document.json["nodes"][gltfNode], kExtension, place);
    if (extension == nullptr)
        return std::nullopt;
    const std::string at = place + ".extensions." + kExtension;
    const auto attributes = extension->find("attributes");
    if (attributes == extension->end() || !attributes->is_object())
        context.fail(at, "should have an object 'attributes'");
    auto copies = CopyReader(context, document, *attributes, at, before).read();
    if (!copies)
        context.warn(at, "has no TRANSLATION, ROTATION or SCALE: the mesh is placed once");
    return copies;
}

} // namespace touchstone
