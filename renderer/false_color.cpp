#include "renderer/false_color.h"

#include "renderer/haptic_quantity.h"
#include "shaders/shared/false_color.h"

#include <meshoptimizer.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace touchstone {

const std::vector<float>* vertexValues(const Mesh& mesh, const Material& material, ViewMode mode) {
    const std::vector<float>* values = nullptr;
    // As they are felt: a height map comes before the heights of the vertices.
    if (mode == ViewMode::Height && !hapticQuantity(material, mode).base)
        values = &mesh.heights;
    if (mode == ViewMode::Friction)
        values = &mesh.friction;
    if (mode == ViewMode::Stiffness)
        values = &mesh.stiffness;
    if (mode == ViewMode::Damping)
        values = &mesh.damping;
    return values != nullptr && !values->empty() ? values : nullptr;
}

HapticQuantity hapticQuantity(const Material& material, ViewMode mode) {
    const HapticMaterial& haptic = material.haptic;
    HapticQuantity quantity;
    const auto factor = [&](const HapticMaterial::Field<float>& value,
                            const HapticMaterial::Field<FactorMap>& map) {
        quantity.base = value.value;
        if (map.value && map.value->texture) {
            quantity.texture = map.value->texture;
            quantity.offset = map.value->min;
            quantity.gain = map.value->max - map.value->min;
        }
    };
    switch (mode) {
    case ViewMode::Friction:
        factor(haptic.staticFriction, haptic.friction);
        break;
    case ViewMode::Stiffness:
        factor(haptic.stiffness, haptic.stiffnessMap);
        break;
    case ViewMode::Damping:
        factor(haptic.damping, haptic.dampingMap);
        break;
    case ViewMode::Height:
        if (haptic.height.value && haptic.height.value->texture) {
            const HeightMap& height = *haptic.height.value;
            quantity = {1.0f, height.texture, -height.midLevel * height.scale, height.scale};
        }
        break;
    case ViewMode::Tilt:
        // The haptic texture: the normal map, else the height map.
        quantity.offset = material.normalScale * haptic.normalTextureInfluence.value.value_or(1.0f);
        if (material.normalTexture && quantity.offset > 0.0f) {
            quantity.texture = material.normalTexture;
        } else if (haptic.height.value && haptic.height.value->texture) {
            quantity.texture = haptic.height.value->texture;
            quantity.gain = haptic.height.value->scale;
        }
        break;
    case ViewMode::Shaded:
    case ViewMode::Normals:
    case ViewMode::Uv:
    case ViewMode::Dihedral:
    case ViewMode::Effects:
    case ViewMode::Perception:
        break;
    }
    return quantity;
}

namespace {

/// Vertices at one position are one place.
struct Places {
    std::vector<uint32_t> of; ///< by vertex
    size_t count = 0;
};

Places placesOf(const Mesh& mesh) {
    Places places{std::vector<uint32_t>(mesh.positions.size()), 0};
    if (!mesh.positions.empty())
        places.count =
            meshopt_generateVertexRemap(places.of.data(), nullptr, mesh.positions.size(),
                                        mesh.positions.data(), mesh.positions.size(), sizeof(glm::vec3));
    return places;
}

} // namespace

std::vector<float> dihedralAngles(const Mesh& mesh) {
    const size_t corners = mesh.indices.size();
    std::vector<float> angles(mesh.positions.size(), 0.0f);
    if (corners == 0)
        return angles;
    // Three corners, and after each the vertex across the edge to the next one; on a border the corner
    // itself.
    std::vector<uint32_t> around(2 * corners);
    meshopt_generateAdjacencyIndexBuffer(around.data(), mesh.indices.data(), corners, &mesh.positions[0].x,
                                         mesh.positions.size(), sizeof(glm::vec3));
    const auto normal = [&](uint32_t a, uint32_t b, uint32_t c) {
        const glm::dvec3 origin(mesh.positions[a]);
        return glm::cross(glm::dvec3(mesh.positions[b]) - origin, glm::dvec3(mesh.positions[c]) - origin);
    };
    for (size_t t = 0; t < 2 * corners; t += 6) {
        const glm::dvec3 own = normal(around[t], around[t + 2], around[t + 4]);
        for (size_t edge = 0; edge < 3; ++edge) {
            const uint32_t a = around[t + 2 * edge], b = around[t + (2 * edge + 2) % 6],
                           across = around[t + 2 * edge + 1];
            if (across == a || across == b)
                continue;
            const glm::dvec3 other = normal(b, a, across);
            const auto angle = static_cast<float>(
                glm::degrees(std::atan2(glm::length(glm::cross(own, other)), glm::dot(own, other))));
            angles[a] = std::max(angles[a], angle);
            angles[b] = std::max(angles[b], angle);
        }
    }
    // Vertices at one position may differ by normals or texture coordinates; an edge connects its own ones
    // only.
    const Places places = placesOf(mesh);
    std::vector<float> most(places.count, 0.0f);
    for (size_t v = 0; v < angles.size(); ++v)
        most[places.of[v]] = std::max(most[places.of[v]], angles[v]);
    for (size_t v = 0; v < angles.size(); ++v)
        angles[v] = most[places.of[v]];
    return angles;
}

namespace {

/// One side of an edge: its ends' places, lower first, and the triangle with the corner where it starts.
struct EdgeSide {
    uint32_t low = 0, high = 0;
    uint32_t triangle = 0, corner = 0;
};

std::vector<EdgeSide> edgeSidesOf(const Mesh& mesh, const std::vector<uint32_t>& place) {
    std::vector<EdgeSide> sides;
    sides.reserve(mesh.indices.size());
    for (uint32_t t = 0; 3 * t < mesh.indices.size(); ++t)
        for (uint32_t k = 0; k < 3; ++k) {
            const uint32_t from = place[mesh.indices[3 * t + k]],
                           to = place[mesh.indices[3 * t + (k + 1) % 3]];
            if (from != to)
                sides.push_back({std::min(from, to), std::max(from, to), t, k});
        }
    std::sort(sides.begin(), sides.end(), [](const EdgeSide& a, const EdgeSide& b) {
        return std::tie(a.low, a.high, a.triangle) < std::tie(b.low, b.high, b.triangle);
    });
    return sides;
}

/// The vertex of a side at the place `end`.
uint32_t vertexAt(const Mesh& mesh, const std::vector<uint32_t>& place, const EdgeSide& side, uint32_t end) {
    const uint32_t from = mesh.indices[3 * side.triangle + side.corner],
                   to = mesh.indices[3 * side.triangle + (side.corner + 1) % 3];
    return place[from] == end ? from : to;
}

bool isCrease(const Mesh& mesh, const std::vector<uint32_t>& place, const EdgeSide& a, const EdgeSide& b) {
    constexpr double kSameNormal = 0.9998476952; // cosine of 1 degree
    if (mesh.normals.empty())
        return false;
    const auto differ = [&](uint32_t end) {
        const uint32_t first = vertexAt(mesh, place, a, end), second = vertexAt(mesh, place, b, end);
        return first != second &&
               glm::dot(glm::dvec3(mesh.normals[first]), glm::dvec3(mesh.normals[second])) < kSameNormal;
    };
    return differ(a.low) || differ(a.high);
}

/// Degrees; negative where a facet has no direction.
double angleBetween(const Mesh& mesh, uint32_t a, uint32_t b) {
    const auto area = [&](uint32_t t) {
        const glm::dvec3 p(mesh.positions[mesh.indices[3 * t]]), q(mesh.positions[mesh.indices[3 * t + 1]]),
            r(mesh.positions[mesh.indices[3 * t + 2]]);
        return glm::cross(q - p, r - p);
    };
    const glm::dvec3 first = area(a), second = area(b);
    if (!(glm::dot(first, first) > 0.0 && glm::dot(second, second) > 0.0))
        return -1.0;
    return glm::degrees(std::atan2(glm::length(glm::cross(first, second)), glm::dot(first, second)));
}

} // namespace

std::vector<float> feltSteps(const Mesh& mesh) {
    const Places places = placesOf(mesh);
    const std::vector<uint32_t>& place = places.of;
    std::vector<float> most(places.count, -1.0f);
    const std::vector<EdgeSide> sides = edgeSidesOf(mesh, place);
    for (size_t i = 0, end = 0; i < sides.size(); i = end) {
        for (end = i + 1;
             end < sides.size() && sides[end].low == sides[i].low && sides[end].high == sides[i].high; ++end)
            continue;
        if (end != i + 2 || isCrease(mesh, place, sides[i], sides[i + 1]))
            continue;
        const double angle = angleBetween(mesh, sides[i].triangle, sides[i + 1].triangle);
        if (angle < 0.0)
            continue;
        const auto steps = static_cast<float>(
            std::count_if(kFeltAngles.begin(), kFeltAngles.end(), [&](double felt) { return angle > felt; }));
        most[sides[i].low] = std::max(most[sides[i].low], steps);
        most[sides[i].high] = std::max(most[sides[i].high], steps);
    }
    std::vector<float> shown(mesh.positions.size());
    for (size_t v = 0; v < shown.size(); ++v)
        shown[v] = most[place[v]];
    return shown;
}

FalseColorScale falseColorScale(const Scene& scene, ViewMode mode) {
    FalseColorScale scale;
    switch (mode) {
    case ViewMode::Height:
        scale.unit = "m";
        break;
    case ViewMode::Friction:
        scale.unit = "1";
        break;
    case ViewMode::Stiffness:
        scale.unit = "N/m";
        break;
    case ViewMode::Damping:
        scale.unit = "N·s/m";
        break;
    case ViewMode::Tilt:
        return {0.0, kMaxTilt, "°", true};
    case ViewMode::Perception:
        return {0.0, static_cast<double>(kFeltAngles.size()), "", true};
    case ViewMode::Dihedral: {
        float most = 0.0f;
        for (const Mesh& mesh : scene.meshes)
            for (const float angle : dihedralAngles(mesh))
                most = std::max(most, angle);
        return {0.0, most > 0.0f ? static_cast<double>(most) : 1.0, "°", true};
    }
    case ViewMode::Shaded:
    case ViewMode::Normals:
    case ViewMode::Uv:
    case ViewMode::Effects:
        return scale;
    }
    double low = 1e300, high = -1e300;
    for (const Mesh& mesh : scene.meshes) {
        const Material& material = scene.materials[static_cast<size_t>(mesh.material)];
        const HapticQuantity quantity = hapticQuantity(material, mode);
        const auto include = [&](float value) {
            for (const float map : {quantity.offset, quantity.offset + quantity.gain}) {
                low = std::min(low, static_cast<double>(value * map));
                high = std::max(high, static_cast<double>(value * map));
            }
        };
        if (const std::vector<float>* values = vertexValues(mesh, material, mode))
            for (const float value : *values)
                include(value);
        else if (quantity.base)
            include(*quantity.base);
    }
    if (low > high)
        return scale;
    scale.meaningful = true;
    // A constant quantity still needs a scale with two ends; it starts at zero.
    if (low == high)
        low = std::min(0.0, low);
    if (low == high)
        high = low + 1.0;
    scale.low = low;
    scale.high = high;
    return scale;
}

glm::vec3 falseColor(double t) {
    return shared::falseColorAt(static_cast<float>(t));
}

} // namespace touchstone
