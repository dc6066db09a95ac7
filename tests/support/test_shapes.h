#pragma once
// Scenes in closed form for tests of the eye: no file, no loader.

#include "engine/scene/scene.h"

#include <glm/gtc/constants.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <string>

namespace touchstone::test {

/// A grid of (columns + 1) x (rows + 1) vertices over the unit square of (u, v), counter-clockwise where the
/// surface is seen with u to the right and v downwards, as glTF's UVs run. `at` gives position, unit normal
/// and unit tangent (the direction of growing u).
struct SurfacePoint {
    glm::dvec3 position, normal, tangent;
};

inline Mesh gridMesh(int columns, int rows, const std::function<SurfacePoint(double u, double v)>& at,
                     glm::vec2 uvRepeats = glm::vec2(1.0f)) {
    Mesh mesh;
    for (int j = 0; j <= rows; ++j)
        for (int i = 0; i <= columns; ++i) {
            const double u = static_cast<double>(i) / columns, v = static_cast<double>(j) / rows;
            const SurfacePoint point = at(u, v);
            mesh.positions.emplace_back(point.position);
            mesh.normals.emplace_back(point.normal);
            mesh.tangents.emplace_back(glm::vec3(point.tangent), 1.0f);
            mesh.uv0.push_back(uvRepeats * glm::vec2(glm::dvec2(u, v)));
        }
    for (int j = 0; j < rows; ++j)
        for (int i = 0; i < columns; ++i) {
            const auto a = static_cast<uint32_t>(j * (columns + 1) + i), b = a + 1;
            const uint32_t c = a + static_cast<uint32_t>(columns + 1), d = c + 1;
            for (const uint32_t index : {a, c, b, b, c, d})
                mesh.indices.push_back(index);
        }
    mesh.normalsFromFile = mesh.tangentsFromFile = true;
    return mesh;
}

/// Torus about the y axis, R to the middle of the tube of radius r. 2 * columns * rows triangles: 324 x 100
/// gives 64,800.
inline Mesh torusMesh(double R, double r, int columns, int rows, glm::vec2 uvRepeats = {8.0f, 3.0f}) {
    return gridMesh(
        columns, rows,
        [&](double u, double v) {
            // u runs counter-clockwise seen from above (to the right on the near side), v down the outside.
            const double phi = glm::two_pi<double>() * u, theta = -glm::two_pi<double>() * v;
            const glm::dvec3 out(std::sin(phi), 0.0, std::cos(phi)), up(0.0, 1.0, 0.0);
            const glm::dvec3 normal = std::cos(theta) * out + std::sin(theta) * up;
            return SurfacePoint{R * out + r * normal, normal, {std::cos(phi), 0.0, -std::sin(phi)}};
        },
        uvRepeats);
}

inline Mesh sphereMesh(double radius, int columns, int rows, glm::vec2 uvRepeats = {1.0f, 1.0f}) {
    return gridMesh(
        columns, rows,
        [&](double u, double v) {
            const double phi = glm::two_pi<double>() * u, theta = glm::pi<double>() * v;
            const glm::dvec3 normal(std::sin(theta) * std::sin(phi), std::cos(theta),
                                    std::sin(theta) * std::cos(phi));
            return SurfacePoint{radius * normal, normal, {std::cos(phi), 0.0, -std::sin(phi)}};
        },
        uvRepeats);
}

/// A square of this half side facing +z, u to the right, v downwards.
inline Mesh quadMesh(double half, int cells = 1, glm::vec2 uvRepeats = glm::vec2(1.0f)) {
    return gridMesh(
        cells, cells,
        [&](double u, double v) {
            return SurfacePoint{
                {half * (2.0 * u - 1.0), half * (1.0 - 2.0 * v), 0.0}, {0.0, 0.0, 1.0}, {1.0, 0.0, 0.0}};
        },
        uvRepeats);
}

/// An 8 bit image from values 0..1; `at` gets the middle of a pixel as (u, v) and returns `channels` of RGBA.
inline Image image(std::string name, int width, int height, int channels,
                   const std::function<glm::vec4(double u, double v)>& at) {
    Image result;
    result.name = std::move(name);
    result.decoded = true;
    result.pixels.width = width;
    result.pixels.height = height;
    result.pixels.channels = channels;
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            const glm::vec4 value = at((x + 0.5) / width, (y + 0.5) / height);
            for (int c = 0; c < channels; ++c)
                result.pixels.bytes.push_back(
                    static_cast<std::byte>(std::lround(255.0f * glm::clamp(value[c], 0.0f, 1.0f))));
        }
    return result;
}

inline Image checkerImage(std::string name, int cells, const glm::vec4& a, const glm::vec4& b,
                          int size = 64) {
    return image(std::move(name), size, size, 4, [&](double u, double v) {
        return (static_cast<int>(u * cells) + static_cast<int>(v * cells)) % 2 == 0 ? a : b;
    });
}

/// Tangent-space normals of the height field depth * cos(2 pi u) * cos(2 pi v), in units of the UV square.
inline Image bumpNormalImage(std::string name, double depth, int size = 64) {
    return image(std::move(name), size, size, 3, [&](double u, double v) {
        const double k = glm::two_pi<double>();
        const double du = -depth * k * std::sin(k * u) * std::cos(k * v);
        const double dv = -depth * k * std::cos(k * u) * std::sin(k * v);
        // glTF: green points up, v points down.
        const glm::dvec3 n = glm::normalize(glm::dvec3(-du, dv, 1.0));
        return glm::vec4(glm::vec3(0.5 + 0.5 * n), 1.0f);
    });
}

inline TextureRef texture(int image) {
    TextureRef reference;
    reference.image = image;
    return reference;
}

/// Adds a mesh with its own node and instance.
inline void place(Scene& scene, Mesh mesh, int material, const glm::dmat4& sceneFromMesh = glm::dmat4(1.0)) {
    mesh.material = material;
    for (const glm::vec3& position : mesh.positions)
        scene.bounds.include(glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(position), 1.0)));
    Node node;
    node.hasMatrix = true;
    node.matrix = sceneFromMesh;
    scene.nodes.push_back(node);
    scene.meshes.push_back(std::move(mesh));
    scene.instances.push_back(
        {static_cast<int>(scene.nodes.size()) - 1, static_cast<int>(scene.meshes.size()) - 1, sceneFromMesh});
}

} // namespace touchstone::test
