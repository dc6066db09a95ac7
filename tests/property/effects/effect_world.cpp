#include "tests/property/effects/effect_world.h"

#include "assets/shapes.h"
#include "engine/load/scene_loader.h"
#include "tests/support/shared_files.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <cmath>
#include <map>

namespace touchstone::test {

namespace {

using assets::Shape;

constexpr double kTurn = 2.0 * glm::pi<double>();

/// A box whose vertex normals lean outwards by up to 45 degrees at its edges: more than the tilt limit.
Shape softBox() {
    Shape shape = assets::box({0.08, 0.09, 0.1}, 4);
    for (size_t i = 0; i < shape.positions.size(); ++i) {
        const glm::dvec3 p = glm::dvec3(shape.positions[i]) / glm::dvec3(0.04, 0.045, 0.05);
        shape.normals[i] = glm::vec3(glm::normalize(p * p * p));
    }
    return shape;
}

/// A body of revolution about the y axis from its profile (radius, height), bottom to top.
Shape lathe(const std::vector<glm::dvec2>& profile, uint32_t around) {
    Shape shape;
    for (size_t k = 0; k < profile.size(); ++k) {
        const glm::dvec2 along = profile[std::min(k + 1, profile.size() - 1)] - profile[k > 0 ? k - 1 : 0];
        for (uint32_t i = 0; i <= around; ++i) {
            const double a = kTurn * (i % around) / around;
            const glm::dvec3 out(std::cos(a), 0.0, -std::sin(a));
            shape.positions.emplace_back(profile[k].x * out + glm::dvec3(0.0, profile[k].y, 0.0));
            shape.normals.emplace_back(
                glm::normalize(along.y * out - glm::dvec3(0.0, along.x, 0.0) + 1e-9 * out));
        }
    }
    const uint32_t row = around + 1;
    for (uint32_t k = 0; k + 1 < profile.size(); ++k)
        for (uint32_t i = 0; i < around; ++i) {
            const uint32_t a = k * row + i;
            for (const uint32_t index : {a, a + 1, a + row + 1, a, a + row + 1, a + row})
                shape.indices.push_back(index);
        }
    return shape;
}

glm::dmat4 at(const glm::dvec3& place) {
    glm::dmat4 m(1.0);
    m[3] = glm::dvec4(place, 1.0);
    return m;
}

/// A pot with a handle and a spout that go into its belly, two spheres beside it, all on a floor.
Scene room() {
    std::vector<glm::dvec2> belly, spout;
    for (int k = 0; k <= 20; ++k) {
        const double v = k / 20.0, bulge = std::sin(0.15 + 2.6 * v);
        belly.push_back({k == 20 ? 0.0 : 0.012 + 0.03 * bulge, 0.055 * v});
    }
    for (int k = 0; k <= 8; ++k)
        spout.push_back({0.012 - 0.007 * k / 8.0, 0.05 * k / 8.0});
    Scene scene = sceneOf(assets::plane(0.3, 0.3, 6, 6));
    addShape(scene, lathe(belly, 32), at({0.0, 0.0005, 0.0}));
    glm::dmat4 leaning = at({0.02, 0.02, 0.0});
    const double lean = 0.9;
    leaning[0] = {std::cos(lean), -std::sin(lean), 0, 0};
    leaning[1] = {std::sin(lean), std::cos(lean), 0, 0};
    addShape(scene, lathe(spout, 20), leaning);
    addShape(scene, assets::torus(0.018, 0.004, 36, 16), at({-0.045, 0.03, 0.0}));
    addShape(scene, assets::sphere(0.03, 40, 40), at({0.01, 0.03, 0.075}));
    addShape(scene, assets::sphere(0.012, 12, 12), at({0.04, 0.012, 0.055}));
    return scene;
}

/// Waves of a tenth of the body, 0.3 mm high, laid on along z; where the file has coordinates, along those.
void addBump(Scene& scene, double workspacePerScene) {
    scene.images.push_back(image("waves", 64, 64, 1, [](double u, double v) {
        return glm::vec4(
            static_cast<float>(0.5 + 0.25 * std::sin(3.0 * kTurn * u) + 0.25 * std::cos(2.0 * kTurn * v)));
    }));
    HeightMap map;
    map.texture = texture(static_cast<int>(scene.images.size()) - 1);
    map.scale = static_cast<float>(3e-4 / workspacePerScene);
    for (Material& material : scene.materials)
        material.haptic.height = {map, HapticSource::Touchstone};
    const glm::dvec3 size = scene.bounds.high - scene.bounds.low;
    const double extent = std::max({size.x, size.y, size.z});
    for (Mesh& mesh : scene.meshes)
        if (mesh.uv0.size() != mesh.positions.size()) {
            mesh.uv0.clear();
            for (const glm::vec3& p : mesh.positions)
                mesh.uv0.push_back(glm::vec2(3.0 * glm::dvec2(p.x, p.y) / extent));
        }
}

std::unique_ptr<EffectWorld> build(Scene scene, Fit fit, double bodyRadius) {
    auto world = std::make_unique<EffectWorld>();
    const Similarity workspaceFromScene = touchstone::workspaceFromScene(scene, fit);
    addBump(scene, workspaceFromScene.scale);
    world->bodyRadius = bodyRadius;
    for (const SideChoice sides : {SideChoice::Both, SideChoice::Front}) {
        for (Material& material : scene.materials)
            material.haptic.sides = sides;
        auto compiled = compileHapticScene(scene, workspaceFromScene);
        compiled->buildNeighbourhoods();
        compiled->buildSlopes();
        (sides == SideChoice::Both ? world->bothSides : world->frontOnly) = std::move(compiled);
    }
    world->whole = std::make_unique<Soup>(*world->bothSides, 0);
    for (size_t k = 0; k < world->bothSides->objects.size(); ++k) {
        const std::shared_ptr<HapticScene> alone = copyOf(*world->bothSides);
        alone->objects = {world->bothSides->objects[k]};
        world->soups.push_back(std::make_unique<Soup>(*alone, 0));
    }
    return world;
}

std::unique_ptr<EffectWorld> model(const char* file) {
    const auto folder = modelsFolder();
    if (!folder || !std::filesystem::exists(*folder / file))
        return nullptr;
    LoadOptions options;
    options.images = {.visual = false, .haptic = false};
    const ScenePtr scene = loadScene(*folder / file, options);
    const glm::dvec3 size =
        workspaceFromScene(*scene, Fit::Workspace).scale * (scene->bounds.high - scene->bounds.low);
    return build(*scene, Fit::Workspace, 0.25 * std::min({size.x, size.y, size.z}));
}

std::unique_ptr<EffectWorld> make(EffectBody body) {
    switch (body) {
    case EffectBody::Sphere:
        return build(sceneOf(assets::sphere(0.05, 30, 30)), Fit::None, 0.05);
    case EffectBody::FineSphere:
        return build(sceneOf(assets::sphere(0.05, 96, 96)), Fit::None, 0.05);
    case EffectBody::Torus:
        return build(sceneOf(assets::torus(0.06, 0.025, 72, 45)), Fit::None, 0.025);
    case EffectBody::Box:
        return build(sceneOf(softBox()), Fit::None, 0.04);
    case EffectBody::Room:
        return build(room(), Fit::None, 0.03);
    case EffectBody::Suzanne:
        return model("Suzanne.glb");
    case EffectBody::ToyCar:
        return model("ToyCar.glb");
    }
    return nullptr;
}

} // namespace

EffectWorld::Place EffectWorld::measure(const glm::dvec3& proxy, ObjectMotions poses, double radius,
                                        bool oneSided) const {
    Place place;
    for (size_t k = 0; k < soups.size(); ++k) {
        const LSimilarity pose(poses[k].workspaceFromObject);
        const LVec3 p = pose.inversePoint(LVec3(proxy));
        const double scale = poses[k].workspaceFromObject.scale;
        for (const size_t t : soups[k]->near(p, static_cast<long double>((radius + kFarthestOff) / scale))) {
            const Corners c = soups[k]->corners(t);
            const double distance = scale * static_cast<double>(distanceFrom(c, p).distance);
            place.nearest = std::min(place.nearest, distance);
            if (oneSided && glm::dot(glm::cross(c.b - c.a, c.c - c.a), p - c.a) >= 0.0L)
                place.off = std::min(place.off, std::abs(distance - radius));
        }
    }
    if (!oneSided)
        place.off = std::min(kFarthestOff, std::abs(place.nearest - radius));
    return place;
}

const EffectWorld* effectWorld(EffectBody body) {
    static std::map<EffectBody, std::unique_ptr<EffectWorld>> worlds;
    const auto [found, fresh] = worlds.try_emplace(body);
    if (fresh)
        found->second = make(body);
    return found->second.get();
}

} // namespace touchstone::test
