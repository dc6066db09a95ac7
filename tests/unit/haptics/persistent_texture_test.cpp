// Persistent textures [003]: where texels lie, what a brush changes, and the plaque of the paper in the tick.

#include "engine/import/materials/texture_values.h"
#include "engine/program/surface_program.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/texture/texture_copy.h"
#include "tests/support/allocation_counter.h"
#include "tests/support/test_shapes.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <rapidcheck.h>

#include <algorithm>
#include <cmath>
#include <random>
#include <string>

namespace touchstone::test::persistent_texture_test {
namespace {

using nlohmann::json;

constexpr double kRate = 4e-5;   // m^2/(N s)
constexpr double kBrush = 0.004; // m
constexpr double kDepth = 1e-3;  // m
const std::string kPlaque = "after.staticFriction = mix(0.1, 0.6, before.persistent);\n"
                            "after.dynamicFriction = mix(0.05, 0.5, before.persistent);\n"
                            "after.persistentChange = -4e-5 * length(before.force);\n"
                            "after.brush = 0.004;\n";

void giveProgram(Material& material, const std::string& body, const json& texture) {
    json shader{{"source", "test.glsl"}};
    if (!texture.is_null())
        shader["persistentTexture"] = texture;
    const auto compiled = compileSurfaceProgram(
        "test.glsl", "void touch(const in Touch before, inout Surface after) {\n" + body + "\n}\n", {},
        [] { return false; });
    material.says.ours.shader = KeptJson(shader);
    material.says.ours.program = compiled;
    material.haptic.program = materialProgram(compiled, shader);
}

json sized(int width, int height) {
    return {{"width", width}, {"height", height}};
}

/// A square of 0.1 m in the plane z = 0 that faces +z, with texture coordinates.
Scene planeOf(const std::string& body, const json& texture) {
    Scene scene;
    scene.materials.emplace_back();
    place(scene, quadMesh(0.05, 4), 0);
    giveProgram(scene.materials[0], body, texture);
    return scene;
}

Scene torusOf(const json& texture) {
    Scene scene = sceneOf(assets::torus(0.030, 0.014, 48, 24, {1, 1}));
    giveProgram(scene.materials[0], kPlaque, texture);
    return scene;
}

/// Sum of A_t (v_t - initial), object units^2.
double changeOf(const PersistentTexture& texture) {
    double sum = 0.0;
    for (size_t i = 0; i < texture.values().size(); ++i)
        sum += static_cast<double>(texture.map()->areas()[i]) *
               (static_cast<double>(texture.values()[i]) - static_cast<double>(texture.size().initial));
    return sum;
}

PersistentTexture textureOf(const HapticScene& scene) {
    return {scene.texels.at(0), scene.materials[0].program->texture};
}

double areaOf(const HapticObject& object) {
    double area = 0.0;
    for (uint32_t t = 0; t < object.triangleCount(); ++t) {
        const Triangle triangle = triangleOf(object, t);
        area += 0.5 * glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
    }
    return area;
}

/// Uniform over the surface: place, normal and texture coordinates.
struct Spot {
    glm::dvec3 point{0.0}, normal{0.0};
    glm::dvec2 uv{0.0};
};
Spot spotOn(const HapticObject& object, uint32_t t, double a, double b) {
    if (a + b > 1.0) {
        a = 1.0 - a;
        b = 1.0 - b;
    }
    const Triangle triangle = triangleOf(object, t);
    const auto uv = [&](size_t k) {
        return glm::dvec2(object.uv[0][object.sourceIndices[3 * size_t{t} + k]]);
    };
    return {triangle.a + a * (triangle.b - triangle.a) + b * (triangle.c - triangle.a), triangle.normal,
            uv(0) + a * (uv(1) - uv(0)) + b * (uv(2) - uv(0))};
}

TEST(TexelMap, ThePartsOfAllTexelsMakeTheSurface) {
    for (const auto& [width, height] : {std::pair{64, 64}, std::pair{37, 101}, std::pair{512, 3}}) {
        for (const Scene& source : {planeOf(kPlaque, sized(width, height)), torusOf(sized(width, height))}) {
            const TouchBench bench(source);
            ASSERT_EQ(bench.scene->texels.size(), 1u);
            const double area = areaOf(*bench.scene->objects[0]);
            EXPECT_NEAR(bench.scene->texels[0]->area(), area, 1e-6 * area) << width;
        }
    }
}

/// The integral of the interpolated texture is the sum over its texels, by their areas.
TEST(TexelMap, AreasIntegrateTheInterpolatedTexture) {
    const TouchBench bench(torusOf(sized(24, 16)));
    const HapticObject& object = *bench.scene->objects[0];
    PersistentTexture texture = textureOf(*bench.scene);
    std::mt19937 random(5);
    std::vector<float> values(24 * 16);
    for (float& value : values)
        value = static_cast<float>(random() % 1000) / 1000.0f;
    ASSERT_TRUE(texture.setTile(0, values)) << "one tile holds it";
    texture.settle();
    double sum = 0.0, area = 0.0;
    constexpr int kSteps = 24; // along each side of a triangle
    for (uint32_t t = 0; t < object.triangleCount(); ++t) {
        const Triangle triangle = triangleOf(object, t);
        const double part = 0.5 * glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
        for (int i = 0; i < kSteps; ++i)
            for (int j = 0; i + j < kSteps; ++j) {
                const Spot spot = spotOn(object, t, (i + 1.0 / 3.0) / kSteps, (j + 1.0 / 3.0) / kSteps);
                sum += part * texture.at(spot.uv);
                area += part;
            }
    }
    EXPECT_NEAR(texture.mean(), sum / area, 1e-3);
}

TEST(TexelMap, WithoutCoordinatesOrWhereTheyRepeatWithoutEndThereIsNone) {
    Scene bare = planeOf(kPlaque, sized(16, 16));
    bare.meshes[0].uv0.clear();
    const TouchBench bench(bare);
    ASSERT_EQ(bench.scene->texels.size(), 1u);
    EXPECT_EQ(bench.scene->texels[0], nullptr);
    ASSERT_FALSE(bench.scene->warnings.empty());
    EXPECT_NE(bench.scene->warnings.back().message.find("TEXCOORD_0"), std::string::npos);
    Scene repeated = planeOf(kPlaque, sized(256, 256));
    for (glm::vec2& uv : repeated.meshes[0].uv0)
        uv *= 1e6f;
    EXPECT_EQ(TouchBench(repeated).scene->texels.at(0), nullptr);
}

/// A hundred repeats each way of four by four texels: ten thousand places in each, among which looking for
/// the right one took minutes.
TEST(TexelMap, WhereThousandsOfPartsMeetInATexelThereIsNone) {
    Scene source = planeOf(kPlaque, sized(4, 4));
    source.meshes[0] = quadMesh(0.05, 100, glm::vec2(100.0f));
    EXPECT_EQ(TouchBench(source).scene->texels.at(0), nullptr);
    source.meshes[0] = quadMesh(0.05, 100, glm::vec2(3.0f)); // few are followed
    const TouchBench bench(source);
    ASSERT_NE(bench.scene->texels.at(0), nullptr);
    EXPECT_GE(bench.scene->texels[0]->samples(), size_t{9 * 16});
}

/// The square of its area, 2e-22 of the object's size, is no float: a direction that was summed up by such
/// was infinite.
TEST(TexelMap, ASliverLooksToItsOwnSide) {
    Scene source = planeOf(kPlaque, sized(8, 8));
    Mesh& mesh = source.meshes[0];
    const auto first = static_cast<uint32_t>(mesh.positions.size());
    for (const glm::vec2 at : {glm::vec2(-0.02f, 0.0f), glm::vec2(0.02f, 0.0f), glm::vec2(0.0f, 1e-22f)}) {
        mesh.positions.emplace_back(at, 0.02f);
        mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
        mesh.uv0.push_back({25.0f * at.x, at.y > 0.0f ? 1.0f : 0.0f});
        if (!mesh.tangents.empty())
            mesh.tangents.emplace_back(1.0f, 0.0f, 0.0f, 1.0f);
    }
    mesh.indices.insert(mesh.indices.end(), {first, first + 1, first + 2});
    const TouchBench bench(source);
    const HapticObject& object = *bench.scene->objects[0];
    std::optional<Triangle> sliver;
    for (uint32_t t = 0; t < object.triangleCount(); ++t)
        if (const Triangle triangle = triangleOf(object, t); triangle.a.z > 0.01)
            sliver = triangle;
    ASSERT_TRUE(sliver);
    const double area =
        0.5 * glm::length(glm::cross(sliver->b - sliver->a, sliver->c - sliver->a)); // object units^2
    ASSERT_GT(area, 0.0);
    ASSERT_LT(area, 1e-20);
    ASSERT_NE(bench.scene->texels.at(0), nullptr);
    const auto reached = std::make_unique<TexelMap::Reached>();
    const auto reach = [&](const glm::dvec3& normal) {
        bench.scene->texels[0]->reach((sliver->a + sliver->b) * 0.5, normal, 0.1, TexelMap::kMaxReached,
                                      *reached);
        return reached->count;
    };
    EXPECT_GT(reach({0.0, 0.0, 1.0}), 0u);
    EXPECT_EQ(reach({0.0, 0.0, -1.0}), 0u);
}

TEST(TexelMap, AProgramThatNamesNoTextureHasNone) {
    const TouchBench bench(planeOf("after.staticFriction = 0.3;", sized(16, 16)));
    EXPECT_TRUE(bench.scene->texels.empty());
    EXPECT_EQ(bench.world.textures(), nullptr);
}

/// Anywhere on a torus, across its seams and at any size of brush: the integral changes by what is said.
TEST(PersistentTexture, AStrokeChangesTheIntegralByWhatItSays) {
    const TouchBench coarse(torusOf(sized(64, 32))), fine(torusOf(sized(300, 200)));
    EXPECT_TRUE(rc::check("the integral changes by what the stroke says", [&] {
        const HapticScene& scene = *rc::gen::arbitrary<bool>() ? *coarse.scene : *fine.scene;
        PersistentTexture texture = textureOf(scene);
        const HapticObject& object = *scene.objects[0];
        const auto part = [] { return static_cast<double>(*rc::gen::inRange(0, 10001)) / 10000.0; };
        const auto t = *rc::gen::inRange<uint32_t>(0, static_cast<uint32_t>(object.triangleCount()));
        const Spot spot = spotOn(object, t, part(), part());
        const double radius = 1e-4 * std::pow(10.0, 4.0 * part()); // 0.0001 to 1 of the object
        const double disc = 3.14 * std::min(radius, 0.02) * std::min(radius, 0.02);
        const double change = -disc * part() / 6.0; // nothing under the brush comes to 0
        texture.apply({.point = spot.point, .normal = spot.normal, .radius = radius, .change = change});
        const double allowed = 1e-3 * std::abs(change) + 1e-8;
        RC_ASSERT(std::abs(changeOf(texture) - change) <= allowed);
        RC_ASSERT(std::abs((texture.mean() - 1.0) * texture.map()->area() - change) <= allowed);
        const auto changed = std::ranges::count_if(texture.values(), [](float v) { return v != 1.0f; });
        RC_ASSERT(static_cast<size_t>(changed) <= TexelMap::kMaxReached);
    }));
}

TEST(PersistentTexture, ABrushReachesAcrossASeamAndNotThroughASheet) {
    const TouchBench bench(torusOf(sized(256, 128)));
    const HapticObject& object = *bench.scene->objects[0];
    PersistentTexture texture = textureOf(*bench.scene);
    // u runs along the ring from 0 to 1: the seam is where both ends meet.
    uint32_t seam = 0;
    while (seam < object.triangleCount() && spotOn(object, seam, 0.1, 0.1).uv.x > 0.02)
        ++seam;
    const Spot spot = spotOn(object, seam, 0.0, 0.0);
    texture.apply({.point = spot.point, .normal = spot.normal, .radius = 0.06, .change = -1e-3});
    bool left = false, right = false;
    for (uint32_t i = 0; i < texture.values().size(); ++i)
        if (texture.values()[i] < 0.99f) {
            const uint32_t x = i % 256;
            left |= x > 240;
            right |= x < 16;
            EXPECT_TRUE(x > 200 || x < 56) << x;
        }
    EXPECT_TRUE(left && right) << "one side of the seam was left out";
    // The same place from both ends.
    const double before = texture.at({spot.uv.x + 1e-6, spot.uv.y}),
                 beyond = texture.at({spot.uv.x - 1e-6, spot.uv.y});
    EXPECT_LT(before, 0.99);
    EXPECT_NEAR(before, beyond, 1e-3);
}

TEST(PersistentTexture, TwoChartsThatMeetInSpaceAreOneSurface) {
    // Two squares side by side in space, whose charts lie in opposite corners of the texture.
    Scene scene;
    scene.materials.emplace_back();
    Mesh mesh;
    for (int square = 0; square < 2; ++square)
        for (int corner = 0; corner < 4; ++corner) {
            const float x = static_cast<float>(corner % 2), y = static_cast<float>(corner / 2);
            mesh.positions.emplace_back(0.05f * (x + static_cast<float>(square) - 1.0f), 0.05f * (y - 0.5f),
                                        0.0f);
            mesh.normals.emplace_back(0.0f, 0.0f, 1.0f);
            const glm::vec2 inChart{0.05f + 0.35f * x, 0.05f + 0.35f * y};
            mesh.uv0.push_back(square == 0 ? inChart : 0.95f - inChart);
        }
    for (const uint32_t square : {0u, 4u})
        for (const uint32_t corner : {0u, 1u, 3u, 0u, 3u, 2u})
            mesh.indices.push_back(square + corner);
    place(scene, std::move(mesh), 0);
    giveProgram(scene.materials[0], kPlaque, sized(128, 128));
    const TouchBench bench(scene);
    PersistentTexture texture = textureOf(*bench.scene);
    texture.apply({.point = {0.0, 0.1, 0.0}, .normal = {0.0, 0.0, 1.0}, .radius = 0.15, .change = -5e-3});
    const HapticObject& object = *bench.scene->objects[0];
    double worst = 0.0, deepest = 1.0;
    for (int i = 1; i < 20; ++i) { // along the common edge, from both squares
        const double along = i / 20.0;
        const auto uvAt = [&](uint32_t square, double x) {
            const auto uv = [&](uint32_t corner) {
                return glm::dvec2(scene.meshes[0].uv0[4 * square + corner]);
            };
            return uv(0) + x * (uv(1) - uv(0)) + along * (uv(2) - uv(0));
        };
        const double a = texture.at(uvAt(0, 1.0)), b = texture.at(uvAt(1, 0.0));
        worst = std::max(worst, std::abs(a - b));
        deepest = std::min(deepest, a);
    }
    EXPECT_LT(deepest, 0.8);
    EXPECT_LT(worst, 0.02);
    EXPECT_NEAR(changeOf(texture), -5e-3, 1e-5);
    EXPECT_GT(object.triangleCount(), 3u);
}

TEST(PersistentTexture, ValuesStayInTheirRangeAndNothingOddChangesThem) {
    const TouchBench bench(planeOf(kPlaque, sized(64, 64)));
    PersistentTexture texture = textureOf(*bench.scene);
    const BrushStroke stroke{.point = {0.0, 0.0, 0.0}, .radius = 0.2, .change = -1.0};
    texture.apply(stroke);
    EXPECT_EQ(*std::ranges::min_element(texture.values()), 0.0f);
    BrushStroke back = stroke;
    back.change = 5.0;
    texture.apply(back);
    EXPECT_EQ(*std::ranges::max_element(texture.values()), 1.0f);
    const std::vector<float> before(texture.values().begin(), texture.values().end());
    for (const double odd : {0.0, double{NAN}, double{INFINITY}}) {
        BrushStroke wrong = stroke;
        wrong.change = odd;
        texture.apply(wrong);
        wrong = stroke;
        wrong.radius = odd == 0.0 ? -1.0 : odd;
        if (!std::isfinite(odd) || wrong.radius < 0.0)
            wrong.change = std::isinf(odd) ? 0.0 : wrong.change;
        texture.apply(wrong);
    }
    EXPECT_TRUE(std::ranges::equal(before, texture.values()));
}

/// A square stroke over the plane, pressed by kDepth.
struct Brushed {
    double removed = 0.0, impulse = 0.0; ///< m^2 and N s
    float least = 1.0f;
    std::vector<float> values;
};
Brushed brushed(double rateHz, int side, int laps = 1) {
    TouchBench bench(planeOf(kPlaque, sized(side, side)));
    bench.dt = 1.0 / rateHz;
    Brushed result;
    const auto feel = [&](const HapticOutput& output) { result.impulse += output.force.z / rateHz; };
    bench.step({-0.02, -0.02, 0.002});
    bench.moveTo({-0.02, -0.02, -kDepth}, 0.05, feel);
    for (int lap = 0; lap < laps; ++lap)
        for (const glm::dvec2& corner :
             {glm::dvec2(0.02, -0.02), {0.02, 0.02}, {-0.02, 0.02}, {-0.02, -0.02}})
            bench.moveTo({corner.x, corner.y, -kDepth}, 0.1, feel);
    const PersistentTexture& texture = *bench.world.textures()->at(0);
    const double scale = bench.scene->programFromObject[0].scale;
    result.removed = -changeOf(texture) * scale * scale;
    result.least = *std::ranges::min_element(texture.values());
    result.values.assign(texture.values().begin(), texture.values().end());
    return result;
}

TEST(Plaque, TheAreaThatIsRemovedIsTheRateTimesTheIntegralOfTheForce) {
    for (const double rate : {1000.0, 4000.0})
        for (const int side : {256, 1024}) {
            const Brushed stroke = brushed(rate, side);
            ASSERT_GT(stroke.least, 0.0f) << "some plaque was gone";
            ASSERT_GT(stroke.impulse, 0.3);
            EXPECT_NEAR(stroke.removed / (kRate * stroke.impulse), 1.0, 0.01) << rate << " Hz, " << side;
            std::printf("[ plaque   ] %4.0f Hz, %4d^2: %.6f of rate x impulse, least value %.3f\n", rate,
                        side, stroke.removed / (kRate * stroke.impulse), static_cast<double>(stroke.least));
        }
}

TEST(Plaque, TheSameStrokesGiveTheSameBits) {
    EXPECT_EQ(brushed(1000.0, 256).values, brushed(1000.0, 256).values);
}

TEST(Plaque, FrictionFollows) {
    TouchBench bench(planeOf(kPlaque, sized(256, 256)));
    const auto rub = [&] {
        double most = 0.0;
        bench.moveTo({0.01, 0.0, -kDepth}, 0.1);
        bench.moveTo({-0.01, 0.0, -kDepth}, 0.1, [&](const HapticOutput& output) {
            if (output.friction == FrictionState::Sliding)
                most = std::max(most, std::abs(output.force.x / output.force.z));
        });
        return most;
    };
    bench.step({-0.01, 0.0, 0.002});
    bench.moveTo({-0.01, 0.0, -kDepth}, 0.05);
    const double covered = rub();
    for (int i = 0; i < 150; ++i)
        rub();
    EXPECT_GT(covered, 0.4);
    EXPECT_NEAR(rub(), 0.05, 0.02) << "clean enamel";
}

TEST(Plaque, ATickAllocatesNothingAndAHugeBrushIsBounded) {
    TouchBench bench(
        planeOf("after.persistentChange = -length(before.force); after.brush = 1e30;\n", sized(1024, 1024)));
    bench.step({0.0, 0.0, 0.002});
    bench.moveTo({0.0, 0.0, -kDepth}, 0.05);
    const uint64_t before = allocationsOnThisThread();
    bench.step({0.001, 0.0, -kDepth});
    EXPECT_EQ(allocationsOnThisThread(), before);
    ASSERT_EQ(bench.world.textures()->strokes().size(), 1u);
    PersistentTexture texture = textureOf(*bench.scene);
    texture.apply(bench.world.textures()->strokes()[0]);
    const auto changed = std::ranges::count_if(texture.values(), [](float v) { return v != 1.0f; });
    EXPECT_GT(changed, 1000);
    EXPECT_LE(static_cast<size_t>(changed), TexelMap::kMaxReached);
}

TEST(Plaque, ATextureThatIsDisplacedHasItsSlopeInTheForce) {
    // A ramp of the texture, felt as a height: h = 0.2 mm v(x).
    TouchBench bench(planeOf("after.position.z += 2e-4 * before.persistent;", sized(64, 64)));
    PersistentTexture* const texture = bench.world.textures()->at(0);
    for (uint32_t tile = 0; tile < texture->tiles(); ++tile) {
        const PersistentTexture::Place at = texture->placeOf(tile);
        std::vector<float> values;
        for (uint32_t y = 0; y < at.height; ++y)
            for (uint32_t x = 0; x < at.width; ++x)
                values.push_back((static_cast<float>(at.x + x) + 0.5f) / 64.0f);
        ASSERT_TRUE(texture->setTile(tile, values));
    }
    for (const char* mode : {"dual", "central"}) {
        ASSERT_EQ(setSetting(bench.settings, "programs", mode), "");
        bench.step({0.0101, 0.0, 0.002});
        bench.moveTo({0.0101, 0.0, -kDepth}, 0.05);
        for (int i = 0; i < 300; ++i)
            bench.step({0.0101, 0.0, -kDepth});
        const double value = 0.5 + 0.0101 / 0.1;
        const double push = bench.limits.recommendedStiffness * (kDepth + 2e-4 * value);
        EXPECT_NEAR(bench.output.force.z, push, 2e-4) << mode;
        EXPECT_NEAR(bench.output.force.x, -push * 2e-4 / 0.1, 2e-5) << mode;
    }
}

TEST(Plaque, StrokesOfTheServoMakeTheSameCopy) {
    TouchBench bench(planeOf(kPlaque, sized(128, 128)));
    const std::shared_ptr<PersistentTextures> copy = bench.world.textures()->fresh();
    bench.step({-0.02, 0.0, 0.002});
    bench.moveTo({-0.02, 0.0, -kDepth}, 0.05,
                 [&](const HapticOutput&) { copy->apply(bench.world.textures()->strokes()); });
    bench.moveTo({0.02, 0.01, -kDepth}, 0.1,
                 [&](const HapticOutput&) { copy->apply(bench.world.textures()->strokes()); });
    EXPECT_TRUE(std::ranges::equal(copy->at(0)->values(), bench.world.textures()->at(0)->values()));
    EXPECT_LT(copy->at(0)->mean(), 1.0);
}

TEST(TextureCopy, ReadersThatAreTooLateGetTheTextureAnewTileByTile) {
    TouchBench bench(planeOf(kPlaque, sized(100, 70))); // 4 x 3 tiles, the outer ones smaller
    const std::shared_ptr<PersistentTextures> servo = bench.world.textures();
    servo->keepStrokes();
    TextureCopy copy;
    copy.follow(servo);
    uint64_t tick = 0;
    const auto touch = [&] {
        const double turn = 1e-3 * static_cast<double>(tick);
        servo->queue({.point = {0.03 * std::sin(turn), 0.03 * std::sin(1.7 * turn), 0.0},
                      .radius = kBrush,
                      .change = -1e-9 * (1.0 + static_cast<double>(tick % 7))});
        const uint64_t allocations = allocationsOnThisThread();
        servo->applyQueued();
        servo->publishStrokes(++tick);
        EXPECT_EQ(allocationsOnThisThread(), allocations);
    };
    for (int i = 0; i < 100; ++i)
        touch();
    (void)copy.next(tick + 1);
    ASSERT_NE(copy.state(), nullptr);
    // Nobody asks for longer than strokes are kept.
    while (servo->droppedStrokes() == 0)
        touch();
    EXPECT_EQ(tick, 100u + (1u << 14) + 1u);
    (void)copy.next(tick);
    EXPECT_EQ(copy.state(), nullptr) << "what is lost is known to be lost";
    const uint64_t asked = tick;
    while (copy.state() == nullptr && tick < asked + 1000) {
        touch();
        (void)copy.next(tick);
    }
    ASSERT_NE(copy.state(), nullptr);
    EXPECT_LE(tick - asked, 2u * 12u + 2u) << "one tile a tick";
    for (int i = 0; i < 500; ++i) {
        touch();
        (void)copy.next(tick);
    }
    (void)copy.next(tick + 1);
    EXPECT_TRUE(std::ranges::equal(copy.state()->at(0)->values(), servo->at(0)->values()));
    EXPECT_NEAR(copy.state()->at(0)->mean(), servo->at(0)->mean(), 1e-9);
    // A second time, and again while it is being made up for.
    const uint64_t second = servo->droppedStrokes();
    while (servo->droppedStrokes() == second)
        touch();
    for (int i = 0; i < 5; ++i)
        touch();
    (void)copy.next(tick);
    EXPECT_EQ(copy.state(), nullptr);
    for (int i = 0; i < 100; ++i) {
        touch();
        (void)copy.next(tick);
    }
    (void)copy.next(tick + 1);
    ASSERT_NE(copy.state(), nullptr);
    EXPECT_TRUE(std::ranges::equal(copy.state()->at(0)->values(), servo->at(0)->values()));
}

TEST(SavedTexture, TouchBeginsWithTheValuesOfTheFileAndASavedSessionGoesOn) {
    const json texture = sized(64, 64);
    TouchBench first(planeOf(kPlaque, texture));
    first.step({-0.02, 0.0, 0.002});
    first.moveTo({-0.02, 0.0, -kDepth}, 0.05);
    first.moveTo({0.02, 0.01, -kDepth}, 0.05);
    const PersistentTexture& left = *first.world.textures()->at(0);
    ASSERT_LT(left.mean(), 1.0);
    const TextureValues values[] = {{0, 0, {left.values().begin(), left.values().end()}}};

    Scene scene = planeOf(kPlaque, texture);
    scene.instances[0].node = 0;
    json shader = static_cast<const json&>(scene.materials[0].says.ours.shader);
    shader["persistentTexture"]["values"] = jsonOf(values);
    scene.materials[0].says.ours.shader = KeptJson(shader);
    TouchBench second(scene);
    EXPECT_TRUE(second.scene->warnings.empty());
    const PersistentTexture& begun = *second.world.textures()->at(0);
    EXPECT_TRUE(std::ranges::equal(begun.values(), left.values())) << "bit for bit";
    EXPECT_NEAR(begun.mean(), left.mean(), 1e-9);
    const auto copy = second.world.textures()->fresh();
    EXPECT_TRUE(std::ranges::equal(copy->at(0)->values(), left.values())) << "copies begin alike";
    second.world.textures()->reset();
    EXPECT_EQ(second.world.textures()->at(0)->mean(), 1.0) << "a replay knows how the recording began";
    // Another size, or damaged: told, and even.
    for (const char* wrong : {"size", "data", "uri", "shape"}) {
        json bad = shader;
        if (wrong == std::string("size"))
            bad["persistentTexture"]["width"] = 32;
        if (wrong == std::string("data"))
            bad["persistentTexture"]["values"][0]["data"] = "data:application/zlib;base64,AAAA";
        if (wrong == std::string("uri"))
            bad["persistentTexture"]["values"][0]["data"] = "values.bin";
        if (wrong == std::string("shape"))
            bad["persistentTexture"]["values"] = 3;
        scene.materials[0].says.ours.shader = KeptJson(bad);
        scene.materials[0].haptic.program = materialProgram(scene.materials[0].says.ours.program, bad);
        TouchBench bench(scene);
        ASSERT_FALSE(bench.scene->warnings.empty()) << wrong;
        EXPECT_NE(bench.scene->warnings[0].place.find("persistentTexture.values"), std::string::npos)
            << bench.scene->warnings[0].place;
        EXPECT_EQ(bench.world.textures()->at(0)->mean(), 1.0);
    }
}

} // namespace
} // namespace touchstone::test::persistent_texture_test
