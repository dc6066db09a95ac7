// Force shading on round bodies: the force along the analytic normal, without steps.

#include "haptics/shading/force_shading.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

namespace touchstone::test::force_shading_test {
namespace {

constexpr double kPi = 3.141592653589793;
constexpr double kStiffness = 1000.0; // N/m

HapticSettings shadedOnly(ShadingMode mode) {
    HapticSettings s;
    s.forceShading = mode;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    s.stiffness = kStiffness;
    return s;
}

double degrees(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / kPi;
}

/// Angles of the force off the smooth body's normal, and the largest change of the force in a tick.
struct StrokeFigures {
    std::vector<double> angles; ///< degrees, sorted
    double jump = 0.0;          ///< N
    int notConverged = 0;
    double moves = 0.0; ///< of the proxy, a tick

    [[nodiscard]] double mean() const {
        double sum = 0.0;
        for (const double angle : angles)
            sum += angle;
        return sum / static_cast<double>(angles.size());
    }
    [[nodiscard]] double share(double p) const {
        return angles[static_cast<size_t>(p * static_cast<double>(angles.size() - 1))];
    }
};

/// Where the hand is after `metres` of its way, and the smooth body's normal there.
using RoundStroke = std::function<std::pair<glm::dvec3, glm::dvec3>(double metres, double lift)>;

StrokeFigures strokeRound(const assets::Shape& shape, const RoundStroke& stroke, ShadingMode mode,
                          int ticks) {
    TouchBench bench(sceneOf(shape), shadedOnly(mode));
    for (double lift = 0.01; lift > 0.0; lift -= 1e-4)
        bench.step(stroke(0.0, lift).first);
    StrokeFigures figures;
    glm::dvec3 last(0.0);
    for (int i = 0; i < ticks; ++i) {
        const auto [hip, normal] = stroke(1e-4 * i, 0.0);
        const HapticOutput& out = bench.step(hip);
        EXPECT_GT(out.contacts, 0u) << i;
        figures.angles.push_back(degrees(out.force, normal));
        figures.notConverged += has(out.flags, TickFlag::ShadingNotConverged) ? 1 : 0;
        figures.moves += static_cast<double>(out.iterations) / ticks;
        if (i > 0)
            figures.jump = std::max(figures.jump, glm::length(out.force - last));
        last = out.force;
    }
    std::sort(figures.angles.begin(), figures.angles.end());
    return figures;
}

std::pair<glm::dvec3, glm::dvec3> onTorus(double metres, double lift) {
    const double r = 0.024 + lift, a = metres / 0.084, v = 0.37 * a + 0.1;
    const glm::dvec3 normal(std::cos(v) * std::cos(a), std::cos(v) * std::sin(a), std::sin(v));
    return {glm::dvec3(0.06 * std::cos(a), 0.06 * std::sin(a), 0.0) + r * normal, normal};
}

std::pair<glm::dvec3, glm::dvec3> onSphere(double metres, double lift) {
    const double a = metres / 0.049, tilt = 1.2 * std::sin(0.37 * a);
    const glm::dvec3 normal(std::cos(a) * std::cos(tilt), std::sin(tilt), std::sin(a) * std::cos(tilt));
    return {(0.049 + lift) * normal, normal};
}

void report(const char* name, const StrokeFigures& f) {
    std::printf(
        "%s: mean %.4f, p99 %.4f, max %.4f degrees, jump %.4f N, not converged %d of %zu, %.2f moves\n", name,
        f.mean(), f.share(0.99), f.angles.back(), f.jump, f.notConverged, f.angles.size(), f.moves);
}

void expectRound(const char* name, const StrokeFigures& f) {
    report(name, f);
    EXPECT_LE(f.mean(), 0.1) << name;
    EXPECT_LE(f.share(0.99), 0.3) << name;
    EXPECT_LE(f.angles.back(), 1.0) << name;
    EXPECT_LE(f.jump, 0.02) << name;
    EXPECT_EQ(f.notConverged, 0) << name;
}

TEST(ForceShading, OnTheTorusTheForceIsAlongTheNormalOfTheRoundBody) {
    const assets::Shape torus = assets::torus(0.06, 0.025, 180, 180);
    const StrokeFigures flat = strokeRound(torus, onTorus, ShadingMode::Off, 20000);
    report("torus 64,800 flat", flat);
    EXPECT_GT(flat.share(0.99), 0.3);
    const StrokeFigures shaded = strokeRound(torus, onTorus, ShadingMode::TwoPass, 20000);
    expectRound("torus 64,800 shaded", shaded);
    EXPECT_LE(shaded.moves, flat.moves + 0.3) << "on one facet the rounds end without a move of their own";
}

TEST(ForceShading, OnTheSphereTheForceIsAlongTheNormalOfTheRoundBody) {
    const assets::Shape sphere = assets::sphere(0.05, 30, 30);
    const StrokeFigures flat = strokeRound(sphere, onSphere, ShadingMode::Off, 20000);
    report("sphere 1800 flat", flat);
    EXPECT_GT(flat.mean(), 1.0);
    expectRound("sphere 1800 shaded", strokeRound(sphere, onSphere, ShadingMode::TwoPass, 20000));
}

/// Shapes stand upright; turned to lie along x, y up.
glm::dmat4 lying(const glm::dvec3& at) {
    return glm::dmat4(glm::dvec4(0, 1, 0, 0), glm::dvec4(1, 0, 0, 0), glm::dvec4(0, 0, -1, 0),
                      glm::dvec4(at, 1.0));
}

TEST(ForceShading, TwoRoundBodiesSideBySideAreFeltAtOnce) {
    // [000 §4]'s case: two shaded cylinders. Axes along x, at z = +-40 mm, R = 50 mm: the groove is at y = 30
    // mm.
    constexpr double kR = 0.05, kOff = 0.04, kValley = 0.03, kDepth = 1e-3;
    for (const ShadingMode mode : {ShadingMode::Off, ShadingMode::TwoPass}) {
        Scene scene = sceneOf(assets::prism(40, kR, 0.2, true), lying({0, 0, -kOff}));
        addShape(scene, assets::prism(40, kR, 0.2, true), lying({0, 0, kOff}));
        TouchBench bench(scene, shadedOnly(mode));
        // Over the one body, into the groove, out over the other: 1 mm inside of both circles.
        const auto hand = [](double z) {
            const double away = std::abs(std::abs(z) - kOff);
            return glm::dvec3(0.011, std::sqrt((kR - kDepth) * (kR - kDepth) - away * away), z);
        };
        bench.step(hand(-0.02) + glm::dvec3(0, 0.01, 0));
        bench.moveTo(hand(-0.02), 0.1);
        double worstAngle = 0.0, worstJump = 0.0, worstOutside = 0.0;
        int inGroove = 0, onOne = 0;
        glm::dvec3 last = bench.output.force;
        for (double z = -0.02; z <= 0.02; z += 5e-5) {
            const HapticOutput& out = bench.step(hand(z));
            ASSERT_GT(out.contacts, 0u);
            worstJump = std::max(worstJump, glm::length(out.force - last));
            last = out.force;
            const glm::dvec3 left = glm::normalize(glm::dvec3(0, out.hip.y, out.hip.z + kOff));
            const glm::dvec3 right = glm::normalize(glm::dvec3(0, out.hip.y, out.hip.z - kOff));
            if (out.planeCount == 2) {
                // Between the normals of the two round bodies at the groove's bottom.
                const double bottom = std::atan2(kOff, kValley);
                const double lean = std::atan2(out.force.z, out.force.y);
                worstOutside = std::max(worstOutside, (std::abs(lean) - bottom) * 180.0 / kPi);
                ++inGroove;
            } else if (z < -0.002 || z > 0.002) {
                worstAngle = std::max(worstAngle, degrees(out.force, z < 0.0 ? left : right));
                ++onOne;
            }
        }
        std::printf(
            "two cylinders, %s: off the round body's normal %.3f deg, outside the groove's cone %.3f deg, "
            "jump %.4f N, %d ticks on one, %d on both\n",
            mode == ShadingMode::Off ? "flat" : "shaded", worstAngle, worstOutside, worstJump, onOne,
            inGroove);
        EXPECT_GT(inGroove, 20);
        EXPECT_GT(onOne, 300);
        if (mode == ShadingMode::Off) {
            EXPECT_GT(worstAngle, 1.0);
            continue;
        }
        EXPECT_LT(worstAngle, 0.1);
        EXPECT_LT(worstOutside, 1.0);
        EXPECT_LT(worstJump, 2.0 * kStiffness * 1e-4);
    }
}

TEST(ForceShading, ACreaseStaysSharp) {
    // The cap of the smooth prism has flat normals: up to its rim the force is the face's to the last bit of
    // the flat tick, and the round side begins where the cap ends.
    const assets::Shape prism = assets::prism(10, 0.05, 0.2, true);
    TouchBench flat(sceneOf(prism), shadedOnly(ShadingMode::Off));
    TouchBench shaded(sceneOf(prism), shadedOnly(ShadingMode::TwoPass));
    int onCap = 0;
    for (TouchBench* bench : {&flat, &shaded})
        bench->step({0.0, 0.11, 0.003});
    for (double y = 0.11; y > 0.099; y -= 1e-4)
        for (TouchBench* bench : {&flat, &shaded})
            bench->step({0.0, y, 0.003});
    for (double x = 0.0; x < 0.0455; x += 1e-4) {
        for (TouchBench* bench : {&flat, &shaded})
            bench->step({x, 0.099, 0.003});
        ASSERT_EQ(flat.output.force, shaded.output.force) << x;
        EXPECT_GT(shaded.output.force.y, 0.9);
        ++onCap;
    }
    EXPECT_GT(onCap, 400);
}

TEST(ForceShading, OnAnEdgeAndAtAVertexTheNormalIsAsThePaperHasIt) {
    const auto scene = compileHapticScene(sceneOf(assets::prism(10, 0.05, 0.2, true)), Similarity{});
    const HapticObject& object = *scene->objects[0];
    int edges = 0;
    for (uint32_t t = 0; t < object.triangleCount(); ++t) {
        if (object.smooth[t] == 0)
            continue;
        for (size_t k = 0; k < 3; ++k) {
            const size_t i = 3 * size_t{t} + k, j = 3 * size_t{t} + (k + 1) % 3;
            const glm::dvec3 a(object.vertices[object.indices[i]]), b(object.vertices[object.indices[j]]);
            const glm::dvec3 na(object.normals[object.sourceIndices[i]]),
                nb(object.normals[object.sourceIndices[j]]);
            Contact contact;
            contact.object = 0;
            contact.feature = t;
            contact.normal = glm::normalize(na + nb);
            const auto at = [&](const glm::dvec3& p) {
                contact.point = p;
                return interpolatedNormal(*scene, scene->restMotions, 0, contact, 1.0);
            };
            EXPECT_LT(glm::length(at(a) - glm::normalize(na)), 1e-7);
            for (const double share : {0.1, 0.5, 0.8}) {
                const glm::dvec3 p = a + share * (b - a);
                const double toA = glm::length(p - a), toB = glm::length(p - b);
                const glm::dvec3 expected = glm::normalize(na / toA + nb / toB);
                EXPECT_LT(glm::length(at(p) - expected), 1e-6);
                ++edges;
            }
        }
    }
    EXPECT_EQ(edges, 20 * 9);
}

/// A smooth prism whose material says `choice`, touched off the middle of a facet.
glm::dvec3 forceOnPrism(ShadingChoice choice, ShadingMode session) {
    Scene scene = sceneOf(assets::prism(10, 0.05, 0.2, true));
    scene.materials[0].haptic.forceShading = choice;
    TouchBench bench(scene, shadedOnly(session));
    bench.step({0.08, 0.0, 0.003});
    bench.moveTo({0.045, 0.0, 0.003}, 0.05);
    EXPECT_GT(bench.output.contacts, 0u);
    return bench.output.force;
}

TEST(ForceShading, AMaterialChoosesItsKindAndTheSessionMayOverrule) {
    const std::vector<std::pair<ShadingChoice, ShadingMode>> same{
        {ShadingChoice::Auto, ShadingMode::TwoPass},
        {ShadingChoice::TwoPass, ShadingMode::TwoPass},
        {ShadingChoice::Bezier, kBezierShading},
        {ShadingChoice::Projected, ShadingMode::Projected},
        {ShadingChoice::Direction, ShadingMode::Direction},
        {ShadingChoice::Off, ShadingMode::Off}};
    for (const auto& [choice, mode] : same)
        EXPECT_EQ(forceOnPrism(choice, ShadingMode::Material), forceOnPrism(ShadingChoice::Auto, mode))
            << static_cast<int>(choice);
    for (const ShadingMode mode : {ShadingMode::TwoPass, ShadingMode::Projected, ShadingMode::Direction}) {
        EXPECT_EQ(forceOnPrism(ShadingChoice::Projected, mode), forceOnPrism(ShadingChoice::Auto, mode));
        EXPECT_EQ(forceOnPrism(ShadingChoice::Off, mode), forceOnPrism(ShadingChoice::Auto, ShadingMode::Off))
            << "a material that says off stays off";
    }
    EXPECT_NE(forceOnPrism(ShadingChoice::Auto, ShadingMode::TwoPass),
              forceOnPrism(ShadingChoice::Auto, ShadingMode::Projected));
    EXPECT_NE(forceOnPrism(ShadingChoice::Auto, ShadingMode::Direction),
              forceOnPrism(ShadingChoice::Auto, ShadingMode::Projected));
    EXPECT_NE(forceOnPrism(ShadingChoice::Auto, ShadingMode::Off),
              forceOnPrism(ShadingChoice::Auto, ShadingMode::Direction));
}

/// Of a hand that goes round the outer half of a torus obliquely, 0.5 mm deep: how far the force is from the
/// smooth torus's normal under the hand, and how far it turns in a step beyond what that normal turns;
/// degrees.
struct TorusError {
    double mean = 0.0, most = 0.0, jump = 0.0;
};

TorusError onTorus(ShadingMode mode, uint32_t aroundRing, double step) {
    constexpr double kRing = 0.05, kTube = 0.02, kDepth = 0.5e-3;
    TouchBench bench(sceneOf(assets::torus(kRing, kTube, aroundRing, aroundRing / 2)), shadedOnly(mode));
    const auto angle = [](const glm::dvec3& a, const glm::dvec3& b) {
        return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / M_PI;
    };
    const auto normalAt = [](double t) {
        const double u = t, v = 0.4 * std::sin(1.7 * t);
        return glm::dvec3(std::cos(v) * std::cos(u), std::cos(v) * std::sin(u), std::sin(v));
    };
    const auto placeAt = [&](double t, double depth) {
        return kRing * glm::dvec3(std::cos(t), std::sin(t), 0.0) + (kTube - depth) * normalAt(t);
    };
    bench.step(placeAt(0.0, -0.01));
    bench.moveTo(placeAt(0.0, kDepth), 0.05);
    TorusError error;
    glm::dvec3 before(0.0), normalBefore(0.0);
    size_t count = 0;
    for (double t = 0.0; t < 1.5; t += step) {
        bench.step(placeAt(t, kDepth));
        const glm::dvec3 force = bench.output.force, normal = normalAt(t);
        const double off = angle(force, normal);
        error.mean += off;
        error.most = std::max(error.most, off);
        if (count++ > 0)
            error.jump = std::max(error.jump, angle(force, before) - angle(normal, normalBefore));
        before = force;
        normalBefore = normal;
    }
    error.mean /= static_cast<double>(count);
    return error;
}

TEST(BezierShading, OnATorusIsNearerToTheSmoothNormalThanTwoPassAndOfSecondOrder) {
    double before = 0.0, last = 0.0;
    for (const uint32_t sides : {48u, 96u, 192u}) {
        const TorusError plain = onTorus(ShadingMode::TwoPass, sides, 1e-3),
                         patch = onTorus(kBezierShading, sides, 1e-3);
        std::printf("%u x %u: two-pass %.5f (at most %.5f), bezier %.5f (%.5f) degrees\n", sides, sides / 2,
                    plain.mean, plain.most, patch.mean, patch.most);
        EXPECT_LT(patch.mean, plain.mean) << sides;
        EXPECT_LE(patch.most, plain.most * (1.0 + 1e-9)) << sides;
        if (sides == 48)
            before = patch.mean;
        last = patch.mean;
    }
    EXPECT_GT(0.5 * std::log2(before / last), 1.75) << "over two halvings, on one path";
}

TEST(BezierShading, TheDirectionDoesNotJumpAtBorders) {
    // In steps a hundredth as long what is left is the tolerance of the rounds, 1.5 nm over a depth of 0.5
    // mm.
    constexpr double kTolerance = 1.5e-9 / 0.5e-3 * 180.0 / M_PI;
    const double coarse = onTorus(kBezierShading, 48, 1e-3).jump,
                 fine = onTorus(kBezierShading, 48, 1e-5).jump;
    std::printf(
        "largest turn beyond the smooth one: %.3g degrees in steps of 1e-3 rad, %.3g in steps of 1e-5\n",
        coarse, fine);
    EXPECT_LT(coarse, 0.01);
    EXPECT_LT(fine, kTolerance);
}

} // namespace
} // namespace touchstone::test::force_shading_test
