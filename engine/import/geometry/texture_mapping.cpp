#include "engine/import/geometry/texture_mapping.h"

#include "engine/import/file/choice_field.h"
#include "engine/import/file/json_fields.h"
#include "engine/scene/mesh_vertices.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>
#include <vector>

namespace touchstone {

namespace {

using nlohmann::json;
using Surface = TextureMapping::Surface;
using Ray = TextureMapping::Ray;

/// Coordinates of three corners, and whether u is defined at each (not at a pole).
struct Corners {
    std::array<glm::dvec2, 3> uv{};
    std::array<bool, 3> turns{true, true, true};
};

class Mapper {
  public:
    Mapper(const TextureMapping& mapping, const Mesh& mesh)
        : mapping_(mapping), mesh_(mesh), toSurface_(glm::conjugate(mapping.rotation)) {
        glm::dvec3 low(std::numeric_limits<double>::infinity()), high = -low;
        for (const glm::vec3& position : mesh.positions) {
            const glm::dvec3 at = toSurface_ * glm::dvec3(position);
            low = glm::min(low, at);
            high = glm::max(high, at);
        }
        middle_ = 0.5 * (low + high);
        half_ = 0.5 * (high - low);
        for (glm::length_t k = 0; k < 3; ++k)
            half_[k] = half_[k] > 0.0 ? half_[k] : 1.0;
    }

    Corners of(size_t triangle) const {
        std::array<glm::dvec3, 3> at, normal;
        for (size_t k = 0; k < 3; ++k) {
            const uint32_t vertex = mesh_.indices[3 * triangle + k];
            at[k] = toSurface_ * glm::dvec3(mesh_.positions[vertex]) - middle_;
            normal[k] = toSurface_ * glm::dvec3(mesh_.normals[vertex]);
        }
        Corners corners;
        if (mapping_.surface == Surface::Box) {
            const auto [axis, sign] = faceOf(at, normal);
            for (size_t k = 0; k < 3; ++k)
                corners.uv[k] = onFace(at[k], axis, sign);
        } else {
            for (size_t k = 0; k < 3; ++k)
                corners.uv[k] = onRound(at[k], normal[k], corners.turns[k]);
            if (mapping_.surface != Surface::Plane)
                close(corners);
        }
        for (glm::dvec2& uv : corners.uv)
            uv *= mapping_.repeat;
        return corners;
    }

  private:
    /// Where the plane, the cylinder and the sphere have the corner; 0 to 1.
    glm::dvec2 onRound(const glm::dvec3& at, const glm::dvec3& normal, bool& turns) const {
        const glm::dvec3& d = mapping_.ray == Ray::Normal ? normal : at;
        const glm::dvec3 scaled = at / half_;
        if (mapping_.surface == Surface::Plane)
            return {0.5 + 0.5 * scaled.x, 0.5 - 0.5 * scaled.y};
        const double across = std::hypot(d.x, d.y), length = glm::length(d);
        turns = across > 1e-9 * length;
        const double u = turns ? std::atan2(d.y, d.x) / (2.0 * std::numbers::pi) + 0.5 : 0.5;
        if (mapping_.surface == Surface::Cylinder)
            return {u, 0.5 - 0.5 * scaled.z};
        return {u, length > 0.0 ? std::acos(std::clamp(d.z / length, -1.0, 1.0)) / std::numbers::pi : 0.5};
    }

    /// Of the triangle as a whole.
    std::pair<glm::length_t, double> faceOf(const std::array<glm::dvec3, 3>& at,
                                            const std::array<glm::dvec3, 3>& normal) const {
        const glm::dvec3 d =
            mapping_.ray == Ray::Normal ? normal[0] + normal[1] + normal[2] : (at[0] + at[1] + at[2]) / half_;
        const glm::dvec3 size = glm::abs(d);
        const glm::length_t axis = size.x >= size.y && size.x >= size.z ? 0 : size.y >= size.z ? 1 : 2;
        return {axis, d[axis] < 0.0 ? -1.0 : 1.0};
    }

    /// Upright as seen from outside; z up on the four sides.
    glm::dvec2 onFace(const glm::dvec3& at, glm::length_t axis, double sign) const {
        const glm::dvec3 s = at / half_;
        const double u = axis == 0 ? sign * s.y : axis == 1 ? -sign * s.x : sign * s.x;
        return {0.5 + 0.5 * u, 0.5 - 0.5 * (axis == 2 ? s.y : s.z)};
    }

    /// A triangle that crosses the image's ends goes on beyond them; a pole has the mean of the others.
    static void close(Corners& corners) {
        double sum = 0.0, first = 0.0;
        int count = 0;
        for (size_t k = 0; k < 3; ++k) {
            if (!corners.turns[k])
                continue;
            double& u = corners.uv[k].x;
            if (count == 0)
                first = u;
            u += std::round(first - u);
            sum += u;
            ++count;
        }
        for (size_t k = 0; k < 3; ++k)
            if (!corners.turns[k] && count > 0)
                corners.uv[k].x = sum / count;
    }

    const TextureMapping& mapping_;
    const Mesh& mesh_;
    glm::dquat toSurface_;
    glm::dvec3 middle_{0.0}, half_{1.0};
};

glm::dquat rotationOf(const ImportContext& context, const json& object, const std::string& place) {
    const auto found = object.find("rotation");
    if (found == object.end())
        return {1.0, 0.0, 0.0, 0.0};
    std::array<double, 4> q{};
    bool numbers = found->is_array() && found->size() == q.size();
    for (size_t i = 0; i < q.size() && numbers; ++i) {
        numbers = (*found)[i].is_number() && std::abs((*found)[i].get<double>()) <= 1.0;
        q[i] = numbers ? (*found)[i].get<double>() : 0.0;
    }
    const double length = std::sqrt(q[0] * q[0] + q[1] * q[1] + q[2] * q[2] + q[3] * q[3]);
    if (!numbers || !(std::abs(length - 1.0) < 1e-3))
        context.fail(place + ".rotation", "should be a unit quaternion: x, y, z, w",
                     "[0, 0, 0, 1] turns nothing");
    return {q[3] / length, q[0] / length, q[1] / length, q[2] / length};
}

} // namespace

TextureMapping readTextureMapping(ImportContext& context, const json& stated, const std::string& place) {
    if (!stated.is_object())
        context.fail(place, "should be an object", "give its surface: plane, cylinder, sphere or box");
    static constexpr std::array<std::pair<const char*, Surface>, 4> kSurfaces = {
        {{"plane", Surface::Plane},
         {"cylinder", Surface::Cylinder},
         {"sphere", Surface::Sphere},
         {"box", Surface::Box}}};
    static constexpr std::array<std::pair<const char*, Ray>, 2> kRays = {
        {{"position", Ray::Position}, {"normal", Ray::Normal}}};
    TextureMapping mapping;
    mapping.surface = choiceField(context, stated, "surface", place, kSurfaces).value_or(mapping.surface);
    mapping.ray = choiceField(context, stated, "by", place, kRays).value_or(mapping.ray);
    if (const std::optional<glm::vec2> repeat = pairField(context, stated, "repeat", place))
        mapping.repeat = glm::dvec2(*repeat);
    const bool round = mapping.surface == Surface::Cylinder || mapping.surface == Surface::Sphere;
    if (!(glm::all(glm::greaterThan(glm::abs(mapping.repeat), glm::dvec2(1e-3))) &&
          glm::all(glm::lessThan(glm::abs(mapping.repeat), glm::dvec2(1e4)))) ||
        (round && mapping.repeat.x != std::round(mapping.repeat.x)))
        context.fail(place + ".repeat",
                     "cannot be: from 0.001 to 10000, around a cylinder or sphere a whole number",
                     "[1, 1] shows the image once");
    mapping.rotation = rotationOf(context, stated, place);
    for (const auto& [name, value] : stated.items())
        if (constexpr std::array<std::string_view, 6> kKnown{"surface", "by", "repeat", "rotation",
                                                             "extensions", "extras"};
            std::ranges::find(kKnown, std::string_view(name)) == kKnown.end())
            context.warn(place + "." + name.substr(0, 40), "is not a known field; felt without it");
    return mapping;
}

std::optional<TextureMapping> readTextureMapping(ImportContext& context, const GltfDocument& document,
                                                 int material, std::string& place) {
    constexpr const char* kOurs = "TOUCHSTONE_materials_haptic";
    if (material < 0)
        return std::nullopt;
    const auto index = static_cast<size_t>(material);
    const std::string owner = "materials[" + std::to_string(index) + "]";
    const json* ours = extensionOf(context, document.json["materials"][index], kOurs, owner);
    const auto found = ours != nullptr ? ours->find("textureMapping") : json::const_iterator();
    if (ours == nullptr || found == ours->end())
        return std::nullopt;
    place = owner + ".extensions." + kOurs + ".textureMapping";
    return readTextureMapping(context, *found, place);
}

size_t mapTexture(const TextureMapping& mapping, Mesh& mesh) {
    constexpr uint32_t kNone = std::numeric_limits<uint32_t>::max();
    const size_t before = mesh.positions.size();
    mesh.tangents = {};
    mesh.tangentsFromFile = false;
    mesh.uv0 = {};
    const Mapper mapper(mapping, mesh);
    std::vector<glm::vec2> uv(before);
    std::vector<uint32_t> next(before, kNone), from(before); // other copies of the vertex; its first one
    std::vector<bool> used(before, false);
    for (uint32_t vertex = 0; vertex < before; ++vertex)
        from[vertex] = vertex;
    std::vector<uint32_t> indices = mesh.indices;
    for (size_t t = 0; t < mesh.triangleCount(); ++t) {
        const Corners corners = mapper.of(t);
        for (size_t k = 0; k < 3; ++k) {
            const glm::vec2 here(corners.uv[k]);
            uint32_t vertex = mesh.indices[3 * t + k];
            while (used[vertex] && uv[vertex] != here) {
                if (next[vertex] == kNone) {
                    next[vertex] = static_cast<uint32_t>(uv.size());
                    uv.push_back(here);
                    next.push_back(kNone);
                    from.push_back(from[vertex]);
                    used.push_back(false);
                }
                vertex = next[vertex];
            }
            used[vertex] = true;
            uv[vertex] = here;
            indices[3 * t + k] = vertex;
        }
    }
    forEachVertexArray(mesh, [&](const char*, auto& values) {
        if (values.empty())
            return;
        values.reserve(from.size());
        for (size_t vertex = before; vertex < from.size(); ++vertex)
            values.push_back(values[from[vertex]]);
    });
    if (!mesh.sources.empty())
        for (size_t vertex = before; vertex < from.size(); ++vertex)
            mesh.sources.push_back(mesh.sources[from[vertex]]);
    mesh.uv0 = std::move(uv);
    mesh.indices = std::move(indices);
    return from.size() - before;
}

} // namespace touchstone
