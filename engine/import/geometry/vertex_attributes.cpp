#include "engine/import/geometry/vertex_attributes.h"

#include "engine/import/geometry/gltf_accessors.h"
#include "engine/import/geometry/morph.h"

#include <algorithm>
#include <cmath>
#include <cstring>

namespace touchstone {
namespace {

/// A unit vector this far off in length is reported to the user; less is rounding and quantisation.
constexpr float kUnitTolerance = 0.1f;

class AttributeReader {
  public:
    AttributeReader(ImportContext& context, const GltfDocument& document,
                    const tinygltf::Primitive& primitive, DracoPrimitive* draco, const MorphTargets* morph,
                    const std::string& place)
        : context_(context), document_(document), primitive_(primitive), draco_(draco), morph_(morph),
          place_(place + ".attributes.") {}

    [[nodiscard]] std::string at(const char* name) const { return place_ + name; }

    /// Treatment of numbers that are not finite: an Error, or 0 and a warning.
    enum class NotFinite { Refuse, Zero };

    /// The values of an attribute, all finite; empty if it is absent. `count` 0 accepts any number of
    /// vertices.
    std::optional<RawAttribute> raw(const char* name, size_t count, std::initializer_list<int> components,
                                    NotFinite notFinite = NotFinite::Refuse) {
        const auto found = primitive_.attributes.find(name);
        if (found == primitive_.attributes.end())
            return std::nullopt;
        RawAttribute attribute = take(name, found->second);
        if (std::find(components.begin(), components.end(), attribute.components) == components.end())
            context_.fail(at(name), "has " + std::to_string(attribute.components) + " components");
        const size_t vertices = attribute.values.size() / static_cast<size_t>(attribute.components);
        if (count != 0 && vertices != count)
            context_.fail(at(name), "has " + std::to_string(vertices) + " vertices where POSITION has " +
                                        std::to_string(count));
        if (morph_ != nullptr)
            morph_->displace(name, attribute);
        size_t broken = 0;
        for (size_t i = 0; i < attribute.values.size(); ++i) {
            if (std::isfinite(attribute.values[i]))
                continue;
            if (notFinite == NotFinite::Refuse)
                context_.fail(at(name),
                              "vertex " + std::to_string(i / static_cast<size_t>(attribute.components)) +
                                  " is not a finite number",
                              "remove the broken vertex, or re-export the model");
            attribute.values[i] = 0.0f;
            ++broken;
        }
        if (broken > 0)
            context_.warn(at(name), std::to_string(broken) + " numbers are not finite; they are taken as 0");
        return attribute;
    }

    template <class Vector>
    std::vector<Vector> vectors(const char* name, size_t count, NotFinite notFinite = NotFinite::Refuse) {
        const auto attribute = raw(name, count, {static_cast<int>(Vector::length())}, notFinite);
        if (!attribute)
            return {};
        std::vector<Vector> result(attribute->values.size() / static_cast<size_t>(Vector::length()));
        static_assert(sizeof(Vector) == sizeof(float) * Vector::length());
        if (!result.empty()) // memcpy accepts no null pointer, even for zero bytes
            std::memcpy(result.data(), attribute->values.data(), attribute->values.size() * sizeof(float));
        return result;
    }

    std::vector<float> factors(const char* name, size_t count) {
        auto attribute = raw(name, count, {1});
        if (!attribute)
            return {};
        for (size_t i = 0; i < attribute->values.size(); ++i)
            if (attribute->values[i] < 0.0f)
                context_.fail(at(name), "vertex " + std::to_string(i) + " is negative",
                              "correct the value in the file");
        return std::move(attribute->values);
    }

  private:
    RawAttribute take(const char* name, int accessor) {
        if (draco_ != nullptr) {
            const auto decoded = draco_->attributes.find(name);
            if (decoded != draco_->attributes.end())
                return std::move(decoded->second);
        }
        return {accessorComponents(document_, accessor), readFloats(context_, document_, accessor, at(name))};
    }

    ImportContext& context_;
    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    DracoPrimitive* draco_;
    const MorphTargets* morph_; ///< null: as stored
    std::string place_;
};

/// Normalises `vectors`. Those without a direction become zero and are counted. A length changed by morph
/// targets (`displaced`) is no flaw of the file.
template <class Vector>
size_t normaliseAll(ImportContext& context, std::vector<Vector>& vectors, bool displaced,
                    const std::string& place) {
    size_t odd = 0, lost = 0;
    for (Vector& v : vectors) {
        const glm::dvec3 exact(v.x, v.y, v.z);
        const double length = glm::length(exact);
        const bool usable = length > 1e-12;
        if (!usable)
            ++lost;
        else if (std::abs(length - 1.0) > static_cast<double>(kUnitTolerance))
            ++odd;
        const glm::vec3 unit = usable ? glm::vec3(exact / length) : glm::vec3(0.0f);
        v.x = unit.x;
        v.y = unit.y;
        v.z = unit.z;
    }
    if (odd > 0 && !displaced)
        context.warn(place, std::to_string(odd) + " vectors are not of unit length and were normalised");
    if (lost > 0)
        context.warn(place, std::to_string(lost) + " vectors have no direction and were computed anew");
    return lost;
}

void readColors(ImportContext& context, AttributeReader& reader, size_t count, bool displaced,
                std::vector<glm::vec4>& colors) {
    const auto raw = reader.raw("COLOR_0", count, {3, 4}, AttributeReader::NotFinite::Zero);
    if (!raw)
        return;
    const size_t components = static_cast<size_t>(raw->components);
    colors.resize(count);
    size_t outside = 0;
    for (size_t i = 0; i < count; ++i) {
        const float* c = &raw->values[i * components];
        const glm::vec4 stated(c[0], c[1], c[2], components == 4 ? c[3] : 1.0f);
        colors[i] = glm::clamp(stated, 0.0f, 1.0f);
        outside += colors[i] != stated ? 1 : 0;
    }
    if (outside > 0 && !displaced)
        context.warn(reader.at("COLOR_0"),
                     std::to_string(outside) + " colours are outside 0..1 and were clamped");
}

/// Tangents with known handedness; empty where one of them has none, since generated frames are better than
/// frames with gaps.
void readTangents(ImportContext& context, AttributeReader& reader, size_t count, bool displaced,
                  std::vector<glm::vec4>& tangents) {
    tangents = reader.vectors<glm::vec4>("TANGENT", count, AttributeReader::NotFinite::Zero);
    constexpr float kRounding = 1e-3f, kSign = 0.5f;
    size_t odd = 0, lost = 0;
    for (glm::vec4& tangent : tangents) {
        odd += std::abs(std::abs(tangent.w) - 1.0f) > kRounding ? 1 : 0;
        lost += std::abs(tangent.w) < kSign ? 1 : 0;
        tangent.w = tangent.w < 0.0f ? -1.0f : 1.0f;
    }
    if (odd > 0)
        context.warn(reader.at("TANGENT"), std::to_string(odd) + " have a w that is neither 1 nor -1; " +
                                               (lost > 0 ? "all are computed anew" : "its sign is taken"));
    if (normaliseAll(context, tangents, displaced, reader.at("TANGENT")) > 0 || lost > 0)
        tangents.clear();
}

} // namespace

void readVertexAttributes(ImportContext& context, const GltfDocument& document,
                          const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                          const MorphTargets& morph, const std::string& place, Mesh& mesh) {
    AttributeReader reader(context, document, primitive, draco, &morph, place);
    mesh.positions = reader.vectors<glm::vec3>("POSITION", 0);
    const size_t count = mesh.positions.size();
    constexpr auto kZero = AttributeReader::NotFinite::Zero;
    // The model has the same shape without them.
    const auto optional = [&](auto&& read) { (void)context.attempt("it is left out", read); };
    optional([&] { mesh.normals = reader.vectors<glm::vec3>("NORMAL", count, kZero); });
    mesh.normalsFromFile = !mesh.normals.empty();
    (void)normaliseAll(context, mesh.normals, morph.displaces("NORMAL"), reader.at("NORMAL"));
    optional([&] { readTangents(context, reader, count, morph.displaces("TANGENT"), mesh.tangents); });
    mesh.tangentsFromFile = !mesh.tangents.empty();
    optional([&] { mesh.uv0 = reader.vectors<glm::vec2>("TEXCOORD_0", count, kZero); });
    optional([&] { mesh.uv1 = reader.vectors<glm::vec2>("TEXCOORD_1", count, kZero); });
    optional([&] { readColors(context, reader, count, morph.displaces("COLOR_0"), mesh.colors); });
    mesh.stiffness = reader.factors("_STIFFNESS", count);
    mesh.damping = reader.factors("_DAMPING", count);
    mesh.friction = reader.factors("_FRICTION", count);
    if (auto heights = reader.raw("_HEIGHT", count, {1}))
        mesh.heights = std::move(heights->values);
}

RawAttribute readAttribute(ImportContext& context, const GltfDocument& document,
                           const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                           const std::string& place, const std::string& name, size_t count, int components) {
    return *AttributeReader(context, document, primitive, draco, nullptr, place)
                .raw(name.c_str(), count, {components});
}

} // namespace touchstone
