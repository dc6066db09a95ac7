// Where touch begins and what the workspace does to it: a hand that starts inside, objects that overlap and
// touch, a workspace that zooms in contact.

#include "tests/stability/hard_case.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

namespace touchstone::test::places_test {
namespace {

constexpr double kRing = 0.06, kTube = 0.025; // m

/// How far `p` is outside of the torus inscribed in the facets of 72 * 45.
double outsideTorus(const glm::dvec3& p) {
    const double sagitta = kTube * (1.0 - std::cos(3.141592653589793 / 45)) +
                           (kRing + kTube) * (1.0 - std::cos(3.141592653589793 / 72));
    return std::hypot(std::hypot(p.x, p.y) - kRing, p.z) - (kTube - sagitta);
}

TEST(Places, AHandThatStartsInsideFeelsNothingUntilItIsOut) {
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            assets::Shape shape = assets::torus(kRing, kTube, 72, 45);
            if (!v.shaded)
                shape.normals.clear();
            HardCase run("start inside", sceneOf(shape), v);
            bool out = false; // inside it is where it is; once out it stays out
            run.side([&](const glm::dvec3& p) {
                out = out || !has(run.bench.output.flags, TickFlag::StartedInside);
                return out ? outsideTorus(p) : 0.0;
            });
            run.startAt({0.06, 0.0, 0.001});
            EXPECT_TRUE(has(run.bench.output.flags, TickFlag::StartedInside));
            run.moveTo({0.07, 0.0, 0.01}, speed); // about, inside
            run.moveTo({0.06, 0.0, 0.05}, speed);
            EXPECT_FALSE(has(run.bench.output.flags, TickFlag::StartedInside));
            run.moveTo({0.06, 0.0, 0.024}, speed);
            EXPECT_GT(run.bench.output.force.z, 0.5);
            run.hold();
            run.moveTo({0.06, 0.003, 0.05}, speed);
            EXPECT_EQ(run.bench.output.contacts, 0u);
            run.judge();
        }
}

TEST(Places, OverlappingAndTouchingObjectsHoldTheirUnion) {
    struct Box {
        glm::dvec3 centre;
    };
    // The second overlaps the first and stands 20 mm higher; the third touches it face to face.
    const std::vector<Box> boxes{{{0.0, 0.0, 0.0}}, {{0.08, 0.02, 0.0}}, {{-0.1, 0.0, 0.0}}};
    for (const Variant& v : allVariants())
        for (const double speed : allSpeeds()) {
            SCOPED_TRACE(v.name() + " at " + std::to_string(speed) + " m/s");
            Scene scene = sceneFor(assets::box({0.1, 0.1, 0.1}, 2), v);
            for (size_t k = 1; k < boxes.size(); ++k) {
                glm::dmat4 at(1.0);
                at[3] = glm::dvec4(boxes[k].centre, 1.0);
                const assets::Shape box = assets::box({0.1, 0.1, 0.1}, 2);
                addShape(scene, v.shaded ? smoothed(box) : box, at);
            }
            HardCase run("overlapping and touching objects", scene, v);
            run.side([&](const glm::dvec3& p) {
                double outside = INFINITY;
                for (const Box& box : boxes) {
                    const glm::dvec3 out = glm::abs(p - box.centre) - glm::dvec3(0.05);
                    outside = std::min(outside, std::max({out.x, out.y, out.z}));
                }
                return outside;
            });
            run.startAt({-0.12, 0.1, 0.01});
            run.moveTo({-0.12, 0.049, 0.01}, speed);
            run.moveTo({0.02, 0.049, 0.01}, speed);
            EXPECT_NEAR(run.bench.output.proxy.x, 0.02, 1e-9) << "over the seam of two touching objects";
            run.moveTo({0.06, 0.049, 0.01}, speed); // into the step
            EXPECT_LE(run.bench.output.proxy.x, 0.03);
            run.hold();
            run.leave(speed);
        }
}

/// A sphere of radius 50 mm about the origin, pressed 1 mm from above.
HardCase pressedSphere(const std::string& name, const Variant& v) {
    assets::Shape sphere = assets::sphere(0.05, 30, 30);
    if (!v.shaded)
        sphere.normals.clear();
    HardCase run(name, sceneOf(sphere), v);
    run.startAt({0.0, 0.08, 0.001});
    run.moveTo({0.0, 0.049, 0.001}, 0.1);
    return run;
}
/// Radius of the sphere inscribed in its facets, of 1.
constexpr double kInscribed = 0.993;

TEST(Places, AWorkspaceZoomedInContactNeitherKicksNorLetsThrough) {
    // The device stands still while its workspace grows and shrinks about a point beside the contact: the HIP
    // moves through the model, slowly and then in one tick by factors up to ten.
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        HardCase run = pressedSphere("workspace zoomed in contact", v);
        run.side([](const glm::dvec3& p) { return glm::length(p) - kInscribed * 0.05; });
        const glm::dvec3 device = run.bench.output.hip;
        const auto zoomTo = [&](double scale) {
            run.bench.mapping.workspaceFromDevice.scale = scale;
            run.bench.mapping.workspaceFromDevice.translation = (1.0 - scale) * glm::dvec3(0.01, 0.06, 0.0);
            run.bench.step(device);
            run.take();
        };
        for (int i = 0; i <= 2000; ++i)
            zoomTo(1.0 + 0.5 * std::sin(2.0 * 3.141592653589793 * i / 2000.0));
        for (const double scale : {2.0, 1.0, 0.1, 1.0, 10.0, 0.5, 1.0})
            for (int i = 0; i < 20; ++i)
                zoomTo(scale);
        run.bench.mapping = DeviceMapping{};
        run.hold();
        run.leave(0.1);
    }
}

TEST(Places, AModelScaledInContactNeitherKicksNorLetsThrough) {
    // The other way round: the hand stands still in the workspace, the object grows against it, and shrinks.
    for (const Variant& v : allVariants()) {
        SCOPED_TRACE(v.name());
        HardCase run = pressedSphere("model scaled in contact", v);
        TouchBench& bench = run.bench;
        const Similarity rest = bench.scene->restMotions[0].workspaceFromObject;
        bench.motions.assign(bench.scene->restMotions.begin(), bench.scene->restMotions.end());
        double scale = rest.scale;
        run.side([&](const glm::dvec3& p) { return glm::length(p) - kInscribed * 0.5 * scale; });
        const glm::dvec3 hip = bench.output.hip;
        const auto scaleTo = [&](double factor) {
            scale = factor * rest.scale;
            bench.motions[0].before = bench.motions[0].workspaceFromObject;
            bench.motions[0].workspaceFromObject.scale = scale;
            bench.step(hip);
            run.take();
        };
        for (int i = 0; i <= 2000; ++i)
            scaleTo(1.0 + 0.2 * std::sin(2.0 * 3.141592653589793 * i / 2000.0));
        for (const double factor : {1.5, 1.0, 3.0, 1.0})
            for (int i = 0; i < 20; ++i)
                scaleTo(factor);
        bench.motions.clear();
        run.hold();
        run.leave(0.1);
    }
}

} // namespace
} // namespace touchstone::test::places_test
