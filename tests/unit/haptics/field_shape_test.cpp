// Distance fields as shapes: against closed forms, against brute force on the same field, and at every speed.

#include "engine/core/error.h"
#include "haptics/shape/field/field_error.h"
#include "tests/support/field_nodes.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test::field_shape_test {
namespace {

struct StrokeError {
    double off = 0.0;   ///< m, mean distance of the proxy from the smooth surface
    double place = 0.0; ///< m, mean distance of the proxy from the smooth surface's place nearest to the HIP
    double moves = 0.0; ///< of the proxy, a tick
    int atBudget = 0;   ///< ticks
};

/// A stroke round the body, 4 mm deep. A field of voxel h is off the surface by O(h^2), and its normals,
/// which turn at the faces of cells, are off by O(h): they move the place by O(h) times the depth.
StrokeError strokeError(const Distance& distance, int cells) {
    constexpr double kScale = 0.15, kDepth = 0.004;
    constexpr int kTicks = 3000;
    FieldBench bench(fieldOf(distance, cells));
    const auto gradient = [&](const glm::dvec3& p) {
        glm::dvec3 g;
        for (int axis = 0; axis < 3; ++axis) {
            glm::dvec3 h(0.0);
            h[axis] = 1e-6;
            g[axis] = distance(p + h) - distance(p - h);
        }
        return glm::normalize(g);
    };
    const auto surface = [&](double a) {
        glm::dvec3 p(0.42 * std::cos(a), 0.42 * std::sin(a), 0.05 * std::sin(3.0 * a));
        for (int i = 0; i < 4; ++i)
            p -= distance(p) * gradient(p);
        return p;
    };
    const auto hipAt = [&](double a, double depth) {
        const glm::dvec3 p = surface(a);
        return FieldBench::kMiddle + kScale * p - depth * gradient(p);
    };
    bench.step(hipAt(0.0, -0.01));
    bench.moveTo(hipAt(0.0, kDepth), 0.2);
    StrokeError error;
    for (int i = 0; i < kTicks; ++i) {
        const HapticOutput& out = bench.step(hipAt(2e-3 * i, kDepth));
        EXPECT_GT(out.contacts, 0u) << i;
        const glm::dvec3 proxy = (out.proxy - FieldBench::kMiddle) / kScale;
        error.off += kScale * std::abs(distance(proxy)) / kTicks;
        error.place += kScale * glm::distance(proxy, surface(2e-3 * i)) / kTicks;
        error.moves += static_cast<double>(out.iterations) / kTicks;
        error.atBudget += has(out.flags, TickFlag::BudgetReached) ? 1 : 0;
    }
    return error;
}

TEST(FieldShape, TheProxysDistanceFromTheSurfaceFallsWithTheSquareOfTheVoxel) {
    for (const auto& [name, distance] : {std::pair<const char*, Distance>{"ball", ball}, {"torus", torus}}) {
        StrokeError coarsest, finest;
        for (const int cells : {32, 48, 64, 96, 128}) {
            const StrokeError error = strokeError(distance, cells);
            std::printf(
                "%s, voxel %.2f mm: %.3g um off the surface, %.3g um from the place; %.1f moves a tick\n",
                name, 1e3 * 0.15 * 1.2 / cells, 1e6 * error.off, 1e6 * error.place, error.moves);
            EXPECT_EQ(error.atBudget, 0);
            (cells == 32 ? coarsest : finest) = error;
        }
        const auto order = [&](double StrokeError::*of) {
            return std::log(coarsest.*of / finest.*of) / std::log(4.0);
        };
        EXPECT_GT(order(&StrokeError::off), 1.8) << name;
        EXPECT_LT(order(&StrokeError::off), 2.2) << name;
        EXPECT_GT(order(&StrokeError::place), 0.9) << name;
    }
}

/// The time of impact against small steps along random lines through a bumpy field.
TEST(FieldShape, TheTimeOfImpactAgreesWithSmallSteps) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-0.7, 0.7), share(0.0, 0.03);
    const auto bumpy = fieldOf(
        [](const glm::dvec3& p) {
            return 0.5 * (ball(p) + 0.02 * std::sin(40.0 * p.x) * std::sin(33.0 * p.y));
        },
        40);
    int hits = 0;
    for (int trial = 0; trial < 2000; ++trial) {
        const glm::dvec3 from(place(random), place(random), place(random));
        const glm::dvec3 motion(place(random), place(random), place(random));
        const double radius = share(random), begin = bumpy->value(from);
        if (begin < radius)
            continue;
        const double impact = bumpy->sweep(from, radius, motion, 1.0);
        constexpr int kSteps = 4000;
        double first = 1.0;
        for (int i = 1; i <= kSteps && first == 1.0; ++i)
            if (bumpy->value(from + motion * (static_cast<double>(i) / kSteps)) < radius - 1e-12)
                first = static_cast<double>(i) / kSteps;
        EXPECT_LE(impact, first + 1e-12) << trial;
        if (impact < 1.0) {
            EXPECT_NEAR(bumpy->value(from + impact * motion), radius, 2e-13) << trial;
            ++hits;
        }
    }
    EXPECT_GT(hits, 200);
}

/// A plate of two voxels, from both sides, at every speed: never passed.
TEST(FieldShape, AThinPlateIsNeverPassed) {
    constexpr int kCells = 48;
    const double half = 1.2 / kCells;
    const auto plate = fieldOf([&](const glm::dvec3& p) { return box(p, {0.45, half, 0.45}); }, kCells);
    for (const double radius : {0.0, 0.5e-3})
        for (const double speed : {0.05, 1.0, 5.0, 50.0})
            for (const double side : {1.0, -1.0}) {
                FieldBench bench(plate);
                bench.settings.proxyRadius = radius;
                bench.step(FieldBench::kMiddle + glm::dvec3(0.01, side * 0.05, 0.007));
                bench.moveTo(FieldBench::kMiddle + glm::dvec3(0.013, -side * 0.04, 0.01), speed,
                             [&](const HapticOutput& out) {
                                 EXPECT_GT(side * (out.proxy.y - FieldBench::kMiddle.y), 0.15 * half * 0.9)
                                     << speed << " m/s";
                             });
                EXPECT_GT(bench.output.contacts, 0u);
                EXPECT_GT(side * bench.output.force.y, 1.0);
            }
}

/// In a concave edge both walls hold the proxy, wherever the edge lies in the grid.
TEST(FieldShape, AConcaveEdgeHoldsTheProxyInItsCorner) {
    for (const double shift : {0.0, 0.3}) {
        constexpr int kCells = 40;
        const double edge = shift * 1.2 / kCells; // on a face of the cells, and inside of them
        // Two walls: solid where x < edge or y < edge, within a box.
        const auto corner = fieldOf(
            [&](const glm::dvec3& p) {
                const double walls = std::min(p.x - edge, p.y - edge);
                return std::max(walls, box(p, glm::dvec3(0.45)));
            },
            kCells);
        FieldBench bench(corner);
        bench.step(FieldBench::kMiddle + glm::dvec3(0.02, 0.02, 0.001));
        bench.moveTo(FieldBench::kMiddle + glm::dvec3(-0.004, -0.003, 0.001), 0.2);
        for (int i = 0; i < 50; ++i)
            bench.step(FieldBench::kMiddle + glm::dvec3(-0.004, -0.003, 0.001));
        const glm::dvec3 proxy = (bench.output.proxy - FieldBench::kMiddle) / 0.15;
        const double rounding = 1.2 / kCells; // a corner is rounded by less than a voxel
        EXPECT_NEAR(proxy.x, edge, rounding);
        EXPECT_NEAR(proxy.y, edge, rounding);
        EXPECT_GT(bench.output.force.x, 0.0);
        EXPECT_GT(bench.output.force.y, 0.0);
    }
}

/// A mesh of the ball and its field: nearer than a voxel; the places where it is felt differ by the field's
/// error.
TEST(FieldOfMesh, IsTheDistanceFromItsTriangles) {
    for (const bool insideOut : {false, true}) {
        assets::Shape shape = assets::sphere(0.075, 120, 120);
        if (insideOut)
            for (size_t t = 0; t + 2 < shape.indices.size(); t += 3)
                std::swap(shape.indices[t + 1], shape.indices[t + 2]);
        const TouchBench mesh(sceneOf(shape));
        const HapticObject& object = *mesh.scene->objects[0];
        const auto grid = fieldOfMesh(object, {.voxel = 1.0 / 64.0, .inside = 0.2, .outside = 0.05});
        double most = 0.0;
        const FieldShape field(grid);
        for (double r = 0.31; r < 0.54; r += 0.013) // the ball has a radius of 0.5
            for (double a = 0.0; a < 6.0; a += 0.37) {
                const glm::dvec3 p =
                    r * glm::normalize(glm::dvec3(std::cos(a), std::sin(a), std::sin(1.7 * a)));
                most = std::max(most, std::abs(field.value(p) - (r - 0.5)));
            }
        EXPECT_LT(most, 1e-3) << "of facets and of the interpolation";
        EXPECT_TRUE(field.contains(glm::dvec3(0.0)));
        EXPECT_FALSE(field.contains({0.55, 0.0, 0.0}));
        EXPECT_GT(field.boundingRadius(), 0.5);
        EXPECT_LT(field.boundingRadius(), 0.92) << "the corner of a box about it";
    }
}

TEST(FieldOfMesh, AnOpenSheetBecomesAShell) {
    const TouchBench mesh(sceneOf(assets::plane(0.1, 0.1, 4, 4)));
    const HapticObject& object = *mesh.scene->objects[0];
    const double voxel = 1.0 / 64.0;
    const FieldShape field(fieldOfMesh(object, {.voxel = voxel, .inside = 0.2, .outside = 0.05}));
    for (const double side : {1.0, -1.0})
        EXPECT_NEAR(field.value({0.1, side * 0.04, 0.1}), 0.04 - voxel, 0.1 * voxel);
    EXPECT_TRUE(field.contains({0.1, 0.0, 0.1}));
    FieldBench bench(std::make_shared<FieldShape>(field));
    bench.step(FieldBench::kMiddle + glm::dvec3(0.003, 0.02, 0.001));
    bench.moveTo(FieldBench::kMiddle + glm::dvec3(0.003, -0.02, 0.001), 1.0);
    EXPECT_GT(bench.output.contacts, 0u);
    EXPECT_NEAR(bench.output.proxy.y - FieldBench::kMiddle.y, 0.15 * voxel, 0.15 * 0.1 * voxel);
}

TEST(FieldOfMesh, RefusesWhatDoesNotFitAndCanBeCancelled) {
    const TouchBench mesh(sceneOf(assets::sphere(0.075, 20, 20)));
    const HapticObject& object = *mesh.scene->objects[0];
    EXPECT_THROW((void)fieldOfMesh(object, {.voxel = 1e-5}), Error);
    EXPECT_THROW((void)fieldOfMesh(object, {.voxel = 0.0}), Error);
    EXPECT_THROW((void)fieldOfMesh(object, {.voxel = NAN}), Error);
    const std::atomic<bool> cancel{true};
    EXPECT_THROW((void)fieldOfMesh(object, {}, Progress(nullptr, &cancel)), Cancelled);
    std::vector<double> fractions;
    const Progress::Report report = [&](double fraction, const char*) { fractions.push_back(fraction); };
    (void)fieldOfMesh(object, {}, Progress(&report, nullptr));
    EXPECT_TRUE(std::is_sorted(fractions.begin(), fractions.end()));
    EXPECT_GT(fractions.size(), 5u);
}

/// In a file: the hand feels the field, the object stays that of its node.
TEST(FieldOfMesh, AMaterialThatIsImplicitIsFeltAsAField) {
    Scene scene = sceneOf(assets::sphere(0.075, 90, 90));
    scene.materials[0].haptic.implicit = true;
    scene.materials[0].haptic.voxelSize = 0.002f;
    TouchBench field(scene, cornerSettings()), mesh(sceneOf(assets::sphere(0.075, 90, 90)), cornerSettings());
    const HapticObject& object = *field.scene->objects[0];
    ASSERT_NE(object.shape, nullptr);
    EXPECT_EQ(object.instance, 0);
    const auto& shape = dynamic_cast<const FieldShape&>(*object.shape);
    EXPECT_NEAR(shape.grid().layout().voxel * object.workspaceFromObject.scale, 0.002, 1e-9);
    for (TouchBench* bench : {&field, &mesh}) {
        bench->settings.proxyRadius = 0.0;
        bench->moveTo({0.01, 0.09, 0.002}, 0.2);
        bench->moveTo({0.01, 0.07, 0.002}, 0.2);
    }
    EXPECT_LT(glm::distance(field.output.proxy, mesh.output.proxy), 1e-4);
    EXPECT_EQ(field.output.object, 0);
    // Edited while it is touched: a mesh again, and a field again.
    std::vector<Material> before = scene.materials, after = before;
    after[0].haptic.implicit = false;
    const auto triangles = withMaterials(*field.scene, scene, before, after);
    EXPECT_EQ(triangles->objects[0]->shape, nullptr);
    EXPECT_GT(triangles->objects[0]->triangleCount(), 0u);
    EXPECT_NE(withMaterials(*triangles, scene, after, before)->objects[0]->shape, nullptr);
    // Neighbourhoods of the field, which has none, are not those of the mesh.
    field.scene->buildNeighbourhoods();
    EXPECT_EQ(withMaterials(*field.scene, scene, before, after)->neighbourhoods(), nullptr);
    for (const float size : {0.5f, 3e38f, 1e-7f}) {
        scene.materials[0].haptic.voxelSize = size;
        const TouchBench usual(scene);
        EXPECT_NE(usual.scene->objects[0]->shape, nullptr);
        ASSERT_EQ(usual.scene->warnings.size(), 1u) << size;
        EXPECT_EQ(usual.scene->warnings[0].place, "materials[0].voxelSize");
    }
}

/// The field of `mesh`'s one material, with `error` as fieldError.
std::unique_ptr<TouchBench> withinError(const assets::Shape& mesh, float error) {
    Scene scene = sceneOf(mesh);
    scene.materials[0].haptic.implicit = true;
    scene.materials[0].haptic.fieldError = error;
    return std::make_unique<TouchBench>(scene, cornerSettings());
}

/// How far the touched surface is from where rays from afar meet the mesh, at most, workspace metres.
double farthestOff(const HapticScene& field, const HapticScene& mesh) {
    const HapticObject& object = *field.objects[0];
    const auto& shape = dynamic_cast<const FieldShape&>(*object.shape);
    double worst = 0.0;
    for (size_t t = 0; t < mesh.objects[0]->triangleCount(); ++t)
        for (const double u : {0.0, 0.2, 0.5})
            for (const double v : {0.0, 0.3, 0.5}) {
                const auto corner = [&](size_t k) {
                    return glm::dvec3(mesh.objects[0]->vertices[mesh.objects[0]->indices[3 * t + k]]);
                };
                const glm::dvec3 place =
                    corner(0) + u * (corner(1) - corner(0)) + v * (corner(2) - corner(0));
                // Along the gradient to the surface, by bisection.
                const glm::dvec3 along = glm::normalize(shape.gradient(place));
                double low = -4.0 * shape.voxel(), high = 4.0 * shape.voxel();
                for (int i = 0; i < 60; ++i)
                    (shape.value(place + 0.5 * (low + high) * along) < 0.0 ? low : high) = 0.5 * (low + high);
                worst = std::max(worst, std::abs(low));
            }
    return worst * object.workspaceFromObject.scale;
}

/// The voxel follows the error asked for: no finer than needed, and near enough where it is measured another
/// way.
TEST(FieldOfMesh, IsAsNearToTheTrianglesAsTheMaterialAsks) {
    for (const bool edges : {false, true})
        for (const float error : {1e-3f, edges ? 5e-4f : 3e-5f}) {
            const auto mesh = edges ? assets::box({0.1, 0.1, 0.1}) : assets::sphere(0.075, 90, 90);
            const auto field = withinError(mesh, error);
            TouchBench triangles(sceneOf(mesh), cornerSettings());
            EXPECT_TRUE(field->scene->warnings.empty());
            EXPECT_LE(farthestOff(*field->scene, *triangles.scene), 1.02 * error) << edges << " " << error;
            const auto& object = *field->scene->objects[0];
            const double voxel = dynamic_cast<const FieldShape&>(*object.shape).voxel();
            std::printf("%s, %g mm: voxel %.2f mm\n", edges ? "box" : "ball",
                        1e3 * static_cast<double>(error), 1e3 * voxel * object.workspaceFromObject.scale);
            if (!edges && voxel < 1.0 / 65.0) { // a coarser one is not near enough; at edges it depends on
                                                // where the nodes lie
                const auto coarser = fieldOfMesh(*triangles.scene->objects[0],
                                                 {.voxel = voxel * std::sqrt(2.0), .inside = 0.2});
                EXPECT_GT(fieldErrorOf(*triangles.scene->objects[0], FieldShape(coarser)) *
                              object.workspaceFromObject.scale,
                          static_cast<double>(error));
            }
        }
}

TEST(FieldOfMesh, AnErrorThatNoFieldReachesIsToldAndFeltWithTheUsualVoxel) {
    const auto field = withinError(assets::box({0.1, 0.1, 0.1}), 1e-9f);
    ASSERT_EQ(field->scene->warnings.size(), 1u);
    EXPECT_EQ(field->scene->warnings[0].place, "materials[0].fieldError");
    EXPECT_EQ(dynamic_cast<const FieldShape&>(*field->scene->objects[0]->shape).voxel(), 1.0 / 128.0);
}

TEST(FieldGrid, KeepsWhatItIsGivenAndRefusesWhatIsNone) {
    const FieldGrid grid = gridOfDistance(cubeOf(20), 0.2, 0.1, ball);
    for (const glm::ivec3& node :
         {glm::ivec3(1, 9, 10), glm::ivec3(8, 8, 8), glm::ivec3(20, 20, 20), glm::ivec3(7, 16, 9)}) {
        const double expected = std::clamp(ball(glm::dvec3(-0.6) + 0.06 * glm::dvec3(node)), -0.2, 0.1);
        EXPECT_NEAR(grid.node(node), expected, 1e-7);
    }
    EXPECT_GE(grid.lipschitz(), 0.95);
    EXPECT_LT(grid.lipschitz(), 1.8);
    for (const glm::ivec3& cell : {glm::ivec3(0), glm::ivec3(19, 0, 3), glm::ivec3(19)})
        EXPECT_EQ(grid.cellOf(grid.numberOf(cell)), cell);
    const auto build = [](FieldLayout layout, const Distance& distance) {
        return gridOfDistance(layout, 0.2, 0.1, distance);
    };
    EXPECT_THROW(build({.origin = glm::dvec3(0.0), .voxel = 0.1, .cells = {0, 4, 4}}, ball), Error);
    EXPECT_THROW(build({.origin = glm::dvec3(0.0), .voxel = 0.0, .cells = glm::ivec3(4)}, ball), Error);
    EXPECT_THROW(build({.origin = glm::dvec3(0.0), .voxel = 0.1, .cells = glm::ivec3(1 << 20)}, ball), Error);
    EXPECT_THROW(build({.origin = glm::dvec3(NAN), .voxel = 0.1, .cells = glm::ivec3(4)}, ball), Error);
    EXPECT_THROW(build(cubeOf(20), [](const glm::dvec3&) { return NAN; }), Error);
    EXPECT_THROW(build(cubeOf(20), [](const glm::dvec3& p) { return p.x; }), Error) << "reaches the border";
    EXPECT_THROW(fieldOf([](const glm::dvec3&) { return 0.05; }, 20), Error) << "nowhere negative";
}

/// Noise between nodes, with flat bricks in it; positive at the border.
float noiseAt(const glm::ivec3& node, const glm::ivec3& cells) {
    if (node.x <= 8 && node.y <= 8)
        return 0.1f;
    if (glm::any(glm::equal(node, glm::ivec3(0))) || glm::any(glm::equal(node, cells)))
        return 0.03f;
    const auto seed = static_cast<uint32_t>(node.x + 57 * node.y + 3301 * node.z) * 2654435761u;
    return -0.2f + 0.3f * static_cast<float>(seed >> 8) / static_cast<float>(1 << 24);
}

/// Every way to a node of a grid against `expected`.
void expectNodes(const FieldGrid& grid, const std::function<float(const glm::ivec3&)>& expected) {
    const glm::ivec3& cells = grid.layout().cells;
    const auto within = [&](const glm::ivec3& node) { return glm::all(glm::lessThanEqual(node, cells)); };
    std::array<float, FieldGrid::kBrickNodes> nodes{};
    for (int z = 0; z < grid.bricks().z; ++z)
        for (int y = 0; y < grid.bricks().y; ++y)
            for (int x = 0; x < grid.bricks().x; ++x) {
                grid.copyBrick({x, y, z}, nodes);
                eachBrickNode([&](const glm::ivec3& at) {
                    const glm::ivec3 node = FieldGrid::kBrick * glm::ivec3(x, y, z) + at;
                    ASSERT_EQ(nodes[brickNode(at)], within(node) ? expected(node) : 0.1f)
                        << node.x << ' ' << node.y << ' ' << node.z;
                });
            }
    const std::vector<float> all = allNodes(grid);
    size_t i = 0;
    for (int z = 0; z <= cells.z; ++z)
        for (int y = 0; y <= cells.y; ++y)
            for (int x = 0; x <= cells.x; ++x) {
                const glm::ivec3 node(x, y, z);
                ASSERT_EQ(all[i++], expected(node)) << x << ' ' << y << ' ' << z;
                ASSERT_NEAR(grid.node(node), static_cast<double>(expected(node)), 1e-7);
                if (grid.contains(node))
                    for (int k = 0; k < 8; ++k) {
                        const glm::ivec3 corner(k & 1, k >> 1 & 1, k >> 2);
                        ASSERT_NEAR(grid.cell(node).value(glm::dvec3(corner)),
                                    static_cast<double>(expected(node + corner)), 1e-7);
                    }
            }
}

TEST(FieldGrid, TheNodesThatBricksShareAreReadFromAnyOfThem) {
    for (const glm::ivec3& cells : {glm::ivec3(20, 24, 16), glm::ivec3(17, 16, 23), glm::ivec3(8, 9, 15)}) {
        const auto grid = std::make_shared<const FieldGrid>(
            FieldLayout{.origin = glm::dvec3(0.0), .voxel = 0.1, .cells = cells}, 0.2, 0.1,
            [&](const glm::ivec3& first, std::span<float> nodes) {
                eachBrickNode(
                    [&](const glm::ivec3& at) { nodes[brickNode(at)] = noiseAt(first + at, cells); });
            });
        const auto noise = [&](const glm::ivec3& node) { return noiseAt(node, cells); };
        expectNodes(*grid, noise);
        // Edited: the nodes of one brick inside of it, and all of a brick that becomes flat but for its
        // border.
        const glm::ivec3 edited = glm::min(glm::ivec3(1, 1, 0), grid->bricks() - 1);
        const auto changed = [&](const glm::ivec3& node) {
            const glm::ivec3 at = node - FieldGrid::kBrick * edited;
            const bool inside = glm::all(glm::greaterThan(at, glm::ivec3(0))) &&
                                glm::all(glm::lessThan(at, glm::ivec3(FieldGrid::kBrick))) &&
                                glm::all(glm::lessThan(node, cells));
            return inside ? 0.05f : noise(node);
        };
        std::array<float, FieldGrid::kBrickNodes> nodes{};
        const glm::ivec3 first = FieldGrid::kBrick * edited;
        eachBrickNode([&](const glm::ivec3& at) {
            const bool within = glm::all(glm::lessThanEqual(first + at, cells));
            nodes[brickNode(at)] = within ? changed(first + at) : 0.1f;
        });
        const FieldGrid again(grid,
                              {{grid->brickNumber(edited),
                                editedBrick(first, glm::min(glm::ivec3(FieldGrid::kBrick), cells - first),
                                            std::span<const float, FieldGrid::kBrickNodes>(nodes))}});
        expectNodes(again, changed);
        expectNodes(*grid, noise);
    }
}

/// The last nodes of bricks are kept once; the hash is over all nodes of each brick, as recordings have it.
TEST(FieldGrid, KeepsABrickInItsNumberOfCells) {
    const FieldGrid grid = gridOfDistance(cubeOf(100), 0.2, 0.1, torus);
    size_t bricks = 0;
    for (int z = 0; z < grid.bricks().z; ++z)
        for (int y = 0; y < grid.bricks().y; ++y)
            for (int x = 0; x < grid.bricks().x; ++x) {
                const float flat = grid.flatBrick(FieldGrid::kBrick * glm::ivec3(x, y, z));
                bricks += flat == flat ? 0 : 1;
            }
    EXPECT_GT(bricks, 500u);
    const size_t least = bricks * 512 * sizeof(float);
    EXPECT_GE(grid.memoryBytes(), least);
    EXPECT_LE(grid.memoryBytes(), least + least / 8);
}

} // namespace
} // namespace touchstone::test::field_shape_test
