// Two-part mapping: coordinates by their closed forms, seams, poles and faces, and what a file may say.

#include "engine/import/geometry/texture_mapping.h"
#include "tests/unit/engine/load_support.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <random>

namespace touchstone::texture_mapping_test {
namespace {

using nlohmann::json;
using test::GltfMaker;
using test::load;
using test::warns;
using Surface = TextureMapping::Surface;
using Ray = TextureMapping::Ray;

constexpr double kPi = std::numbers::pi;

/// A closed ellipsoid with poles on z, without coordinates.
Mesh ellipsoid(const glm::dvec3& half, uint32_t rings = 11, uint32_t around = 16) {
    Mesh mesh;
    const auto add = [&](double polar, double turn) {
        const glm::dvec3 d{std::sin(polar) * std::cos(turn), std::sin(polar) * std::sin(turn),
                           std::cos(polar)};
        mesh.positions.emplace_back(half * d);
        mesh.normals.emplace_back(glm::normalize(d / half));
    };
    add(0.0, 0.0);
    for (uint32_t ring = 0; ring < rings; ++ring)
        for (uint32_t i = 0; i < around; ++i)
            add(kPi * (ring + 1) / (rings + 1), 2.0 * kPi * (i + 0.5) / around);
    add(kPi, 0.0);
    const auto at = [&](uint32_t ring, uint32_t i) { return 1 + ring * around + i % around; };
    const auto last = static_cast<uint32_t>(mesh.positions.size() - 1);
    for (uint32_t i = 0; i < around; ++i) {
        for (const uint32_t index :
             {0u, at(0, i), at(0, i + 1), last, at(rings - 1, i + 1), at(rings - 1, i)})
            mesh.indices.push_back(index);
        for (uint32_t ring = 0; ring + 1 < rings; ++ring)
            for (const uint32_t index : {at(ring, i), at(ring + 1, i), at(ring + 1, i + 1), at(ring, i),
                                         at(ring + 1, i + 1), at(ring, i + 1)})
                mesh.indices.push_back(index);
    }
    return mesh;
}

/// Distance to the nearest whole number.
double beyondWhole(double x) {
    return std::abs(x - std::round(x));
}

TEST(TextureMapping, EachSurfaceHasItsClosedForm) {
    const glm::dvec3 half{0.03, 0.02, 0.05};
    for (const Ray ray : {Ray::Position, Ray::Normal}) {
        const auto mapped = [&](Surface surface) {
            Mesh mesh = ellipsoid(half);
            (void)mapTexture({.surface = surface, .ray = ray}, mesh);
            return mesh;
        };
        const Mesh plane = mapped(Surface::Plane), cylinder = mapped(Surface::Cylinder),
                   sphere = mapped(Surface::Sphere);
        for (const Mesh* mesh : {&plane, &cylinder, &sphere})
            for (size_t v = 0; v < mesh->positions.size(); ++v) {
                const glm::dvec3 p(mesh->positions[v]),
                    d = ray == Ray::Normal ? glm::dvec3(mesh->normals[v]) : p;
                const glm::dvec2 uv(mesh->uv0[v]);
                const bool pole = std::hypot(d.x, d.y) < 1e-6 * glm::length(d);
                const double turn = std::atan2(d.y, d.x) / (2.0 * kPi) + 0.5;
                if (mesh == &plane) {
                    EXPECT_NEAR(uv.x, 0.5 + 0.5 * p.x / half.x, 0.02); // the mesh's own width
                    EXPECT_NEAR(uv.y, 0.5 - 0.5 * p.y / half.y, 0.02);
                    continue;
                }
                if (!pole) {
                    EXPECT_LT(beyondWhole(uv.x - turn), 1e-5);
                }
                EXPECT_NEAR(uv.y,
                            mesh == &cylinder ? 0.5 - 0.5 * p.z / half.z
                                              : std::acos(d.z / glm::length(d)) / kPi,
                            1e-5);
            }
    }
}

/// Whatever the surface, its turn and the mesh: no triangle runs back through the image, and only coordinates
/// are new.
TEST(TextureMapping, SplitsVerticesAndChangesNothingElse) {
    std::mt19937 random(11);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    for (int turn = 0; turn < 200; ++turn) {
        TextureMapping mapping;
        mapping.surface = static_cast<Surface>(turn % 4);
        mapping.ray = static_cast<Ray>(turn / 4 % 2);
        mapping.rotation = glm::normalize(glm::dquat(any(random), any(random), any(random), any(random)));
        const glm::dvec3 half = 0.02 + 0.015 * glm::dvec3(any(random), any(random), any(random));
        const Mesh before = ellipsoid(half, 5 + static_cast<uint32_t>(random() % 20),
                                      12 + static_cast<uint32_t>(random() % 20));
        Mesh mesh = before;
        mesh.tangents.assign(mesh.positions.size(), glm::vec4(1.0f));
        mesh.friction.resize(mesh.positions.size());
        for (size_t v = 0; v < mesh.friction.size(); ++v)
            mesh.friction[v] = static_cast<float>(v);
        const size_t split = mapTexture(mapping, mesh);
        ASSERT_EQ(mesh.positions.size(), before.positions.size() + split);
        ASSERT_EQ(mesh.uv0.size(), mesh.positions.size());
        ASSERT_EQ(mesh.friction.size(), mesh.positions.size());
        EXPECT_TRUE(mesh.tangents.empty());
        ASSERT_EQ(mesh.indices.size(), before.indices.size());
        for (size_t i = 0; i < mesh.indices.size(); ++i) {
            ASSERT_EQ(mesh.positions[mesh.indices[i]], before.positions[before.indices[i]]);
            ASSERT_EQ(mesh.friction[mesh.indices[i]], static_cast<float>(before.indices[i]));
        }
        size_t back = 0;
        for (size_t t = 0; t < mesh.triangleCount(); ++t)
            for (size_t k = 0; k < 3; ++k) {
                const glm::vec2 a = mesh.uv0[mesh.indices[3 * t + k]],
                                b = mesh.uv0[mesh.indices[3 * t + (k + 1) % 3]];
                ASSERT_TRUE(std::isfinite(a.x + a.y));
                back += std::abs(a.x - b.x) > 0.5f + 1e-5f ? 1 : 0;
            }
        if (mapping.surface != Surface::Plane) {
            EXPECT_LE(back, 4u) << turn << ": but around the two poles";
        }
        EXPECT_EQ(split > 0, mapping.surface != Surface::Plane);
    }
}

TEST(TextureMapping, ABoxShowsTheImageUprightOnEachFace) {
    Mesh cube; // of flat faces, 2 m wide
    for (int axis = 0; axis < 3; ++axis)
        for (const float sign : {-1.0f, 1.0f}) {
            const auto first = static_cast<uint32_t>(cube.positions.size());
            for (int corner = 0; corner < 4; ++corner) {
                glm::vec3 p(0.0f);
                p[axis] = sign;
                p[(axis + 1) % 3] = corner % 2 == 0 ? -1.0f : 1.0f;
                p[(axis + 2) % 3] = corner < 2 ? -1.0f : 1.0f;
                glm::vec3 n(0.0f);
                n[axis] = sign;
                cube.positions.push_back(p);
                cube.normals.push_back(n);
            }
            for (const uint32_t corner : {0u, 1u, 3u, 0u, 3u, 2u})
                cube.indices.push_back(first + corner);
        }
    (void)mapTexture({.surface = Surface::Box, .ray = Ray::Normal, .repeat = {2.0, 3.0}}, cube);
    for (size_t v = 0; v < cube.positions.size(); ++v) {
        const glm::vec3 p = cube.positions[v], n = cube.normals[v];
        const float up = std::abs(n.z) > 0.5f ? p.y : p.z;
        EXPECT_EQ(cube.uv0[v].y, up > 0.0f ? 0.0f : 3.0f) << "v goes down";
        // To the right, seen from outside with that up.
        const glm::vec3 right = glm::cross(std::abs(n.z) > 0.5f ? glm::vec3(0, 1, 0) : glm::vec3(0, 0, 1), n);
        EXPECT_EQ(cube.uv0[v].x, glm::dot(right, p) > 0.0f ? 2.0f : 0.0f);
    }
}

GltfMaker withMapping(const json& mapping) {
    GltfMaker maker = GltfMaker::square();
    maker.json["extensionsUsed"] = {"TOUCHSTONE_materials_haptic"};
    json material = json::object();
    material["extensions"]["TOUCHSTONE_materials_haptic"]["textureMapping"] = mapping;
    maker.json["materials"] = {material};
    maker.primitive()["material"] = 0;
    return maker;
}

TEST(TextureMapping, IsReadFromAFileAndWhatIsWrongIsNamed) {
    const ScenePtr scene = load(withMapping({{"surface", "plane"}, {"repeat", {2, 1}}}));
    EXPECT_TRUE(scene->warnings.empty());
    const Mesh& mesh = scene->meshes.at(0);
    ASSERT_EQ(mesh.uv0.size(), mesh.positions.size());
    float widest = 0.0f;
    for (const glm::vec2& uv : mesh.uv0)
        widest = std::max(widest, uv.x);
    EXPECT_EQ(widest, 2.0f);
    const std::array wrong{std::pair{json(3), "should be an object"},
                           std::pair{json{{"surface", "cone"}}, "is not a choice"},
                           std::pair{json{{"by", "magic"}}, "is not a choice"},
                           std::pair{json{{"surface", 4}}, "should be"},
                           std::pair{json{{"repeat", {0, 1}}}, "cannot be"},
                           std::pair{json{{"repeat", {1, 1e9}}}, "cannot be"},
                           std::pair{json{{"repeat", "twice"}}, "should be"},
                           std::pair{json{{"surface", "sphere"}, {"repeat", {1.5, 1}}}, "whole number"},
                           std::pair{json{{"rotation", {0, 0, 0, 2}}}, "unit quaternion"},
                           std::pair{json{{"rotation", {0, 0, 1}}}, "unit quaternion"},
                           std::pair{json{{"surfaec", "box"}}, "not a known field"}};
    for (const auto& [mapping, message] : wrong) {
        const ScenePtr plain = load(withMapping(mapping));
        EXPECT_FALSE(plain->meshes.empty()) << mapping;
        EXPECT_TRUE(warns(*plain, "textureMapping", message)) << mapping << message;
    }
}

TEST(TextureMapping, AMapWithoutCoordinatesInTheFileIsFelt) {
    GltfMaker maker = withMapping({{"surface", "box"}});
    json& ours = maker.json["materials"][0]["extensions"]["TOUCHSTONE_materials_haptic"];
    maker.json["images"] = {
        {{"uri", "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAIAAACQd1PeAAAADElEQVR42mMw"
                 "NjYGAAE2AJpHI3MJAAAAAElFTkSuQmCC"}}};
    maker.json["textures"] = {{{"source", 0}}};
    ours["heightTexture"] = {{"index", 0}, {"scale", 0.001}};
    const ScenePtr scene = load(maker);
    EXPECT_TRUE(scene->warnings.empty());
    EXPECT_FALSE(scene->meshes.at(0).uv0.empty());
    EXPECT_FALSE(scene->meshes.at(0).tangents.empty()) << "of the height map";
}

} // namespace
} // namespace touchstone::texture_mapping_test
