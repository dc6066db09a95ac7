// contact=virtualPoint and contact=potential [002 §4] against an independent evaluation of the equations in
// long double, and friction=kim at several rates.

#include "haptics/comparison/comparison_solver.h"
#include "haptics/friction/friction_law.h"
#include "haptics/scene/shape_object.h"
#include "haptics/settings/tick_flags.h"
#include "haptics/shape/field/field_shape.h"
#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>
#include <functional>
#include <numbers>
#include <random>
#include <vector>

namespace touchstone::test::virtual_point_test {
namespace {

using Distance = std::function<double(const glm::dvec3&)>;
using Vec = glm::vec<3, long double>;

constexpr double kScale = 0.15, kStiffness = 600.0;

double ball(const glm::dvec3& p) {
    return glm::length(p) - 0.4;
}
double torus(const glm::dvec3& p) {
    return std::hypot(std::hypot(p.x, p.y) - 0.3, p.z) - 0.12;
}
double box(const glm::dvec3& p) {
    const glm::dvec3 q = glm::abs(p) - glm::dvec3(0.4, 0.3, 0.35);
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

/// `inside`: field units, deeper than that it is flat.
std::shared_ptr<const FieldShape> fieldOf(const Distance& distance, int cells, double inside = 0.5) {
    const FieldLayout layout{.origin = glm::dvec3(-0.6), .voxel = 1.2 / cells, .cells = glm::ivec3(cells)};
    return std::make_shared<FieldShape>(
        std::make_shared<FieldGrid>(gridOfDistance(layout, inside, 0.1, distance)));
}

/// A field alone in a scene, turned and moved.
struct FieldAlone : TouchBench {
    std::shared_ptr<const FieldShape> field;
    Similarity pose{kScale, glm::normalize(glm::dquat(0.9, 0.2, -0.3, 0.1)), {0.02, 0.5, -0.01}};

    FieldAlone(std::shared_ptr<const FieldShape> shape, ContactMethod method)
        : TouchBench(cornerScene({{.normal = {0, 1, 0}, .stiffness = kStiffness}}), cornerSettings()),
          field(std::move(shape)) {
        settings.contact = method;
        settings.proxyRadius = 0.0;
        const std::shared_ptr<HapticScene> alone = copyOf(*scene);
        alone->objects.clear();
        alone->restMotions.clear();
        alone->restSpheres.clear();
        alone->boundingRadii.clear();
        addShape(*alone, "field", field, 0, pose);
        scene = alone;
    }
    [[nodiscard]] glm::dvec3 inField(const glm::dvec3& workspace) const {
        return pose.inversePoint(workspace);
    }
};

/// [002] eqs. 1 and 2 from the nodes alone, in long double: potential and interpolated nodal gradients.
struct Evaluated {
    const FieldGrid& grid;

    struct Corner {
        std::array<glm::ivec3, 8> node;
        std::array<long double, 8> weight;
    };
    [[nodiscard]] Corner at(const Vec& p) const {
        const FieldLayout& layout = grid.layout();
        Corner corner;
        const Vec g = (p - Vec(layout.origin)) / static_cast<long double>(layout.voxel);
        glm::ivec3 cell;
        for (int axis = 0; axis < 3; ++axis)
            cell[axis] = std::clamp(static_cast<int>(std::floor(g[axis])), 0, layout.cells[axis] - 1);
        for (int k = 0; k < 8; ++k) {
            const glm::ivec3 bit(k & 1, k >> 1 & 1, k >> 2);
            corner.node[static_cast<size_t>(k)] = cell + bit;
            long double weight = 1.0L;
            for (int axis = 0; axis < 3; ++axis) {
                const long double u = g[axis] - static_cast<long double>(cell[axis]);
                weight *= bit[axis] == 1 ? u : 1.0L - u;
            }
            corner.weight[static_cast<size_t>(k)] = weight;
        }
        return corner;
    }
    [[nodiscard]] long double value(const Vec& p) const {
        const Corner corner = at(p);
        long double sum = 0.0L;
        for (size_t k = 0; k < 8; ++k)
            sum += corner.weight[k] * static_cast<long double>(grid.node(corner.node[k]));
        return sum;
    }
    [[nodiscard]] Vec gradient(const Vec& p) const {
        const Corner corner = at(p);
        const auto voxel = static_cast<long double>(grid.layout().voxel);
        Vec sum(0.0L);
        for (size_t k = 0; k < 8; ++k)
            for (int axis = 0; axis < 3; ++axis) {
                glm::ivec3 step(0);
                step[axis] = 1;
                sum[axis] += corner.weight[k] *
                             (static_cast<long double>(grid.node(corner.node[k] + step)) -
                              static_cast<long double>(grid.node(corner.node[k] - step))) /
                             (2.0L * voxel);
            }
        return sum;
    }
    /// The first root of f along n from a tip where f < 0: a bracket of a sixteenth of a voxel.
    [[nodiscard]] Vec leaves(const Vec& tip, const Vec& n) const {
        const long double step = static_cast<long double>(grid.layout().voxel) / 16.0L;
        long double inside = 0.0L, outside = 0.0L;
        while (value(tip + outside * n) < 0.0L) {
            inside = outside;
            outside += step;
        }
        for (int i = 0; i < 80; ++i) {
            const long double middle = 0.5L * (inside + outside);
            (value(tip + middle * n) < 0.0L ? inside : outside) = middle;
        }
        return tip + outside * n;
    }
};

struct Case {
    const char* name;
    Distance distance;
    ContactMethod method;
};

class VirtualPointTest : public testing::TestWithParam<Case> {};

/// A walk through the body: in contact the proxy is p_c, and the force is (p_c - p_t) k - V b.
TEST_P(VirtualPointTest, IsWhatTheEquationsSay) {
    FieldAlone bench(fieldOf(GetParam().distance, 64), GetParam().method);
    bench.settings.damping = 3.0;
    const Evaluated evaluated{bench.field->grid()};
    std::mt19937 random(7);
    std::normal_distribution<double> step(0.0, 0.004);
    glm::dvec3 place(0.0, 0.0, 0.58);
    int touched = 0;
    double worst = 0.0, worstForce = 0.0;
    bench.step(bench.pose.point(place));
    for (int i = 0; i < 6000; ++i) {
        place = glm::clamp(place + glm::dvec3(step(random), step(random), step(random) - 0.02 * place.z),
                           -0.5, 0.5);
        const glm::dvec3 hip = bench.pose.point(place);
        const HapticOutput& out = bench.step(hip);
        ASSERT_FALSE(has(out.flags, TickFlag::NeighbourhoodMissing));
        const Vec tip(bench.inField(hip));
        const long double f = evaluated.value(tip);
        ASSERT_EQ(out.contacts > 0, f < 0.0L) << i;
        if (f >= 0.0L) {
            EXPECT_EQ(out.force, glm::dvec3(0.0));
            continue;
        }
        ++touched;
        const Vec n = glm::normalize(evaluated.gradient(tip));
        const Vec point =
            GetParam().method == ContactMethod::Potential ? tip - f * n : evaluated.leaves(tip, n);
        const glm::dvec3 expected = bench.pose.point(glm::dvec3(point));
        worst = std::max(worst, glm::length(out.proxy - expected));
        const glm::dvec3 force = kStiffness * (expected - hip) - 3.0 * out.hipVelocity;
        worstForce = std::max(worstForce, glm::length(out.force - force));
    }
    EXPECT_GT(touched, 1500);
    EXPECT_LT(worst, 1e-9);      // m
    EXPECT_LT(worstForce, 1e-6); // N
    RecordProperty("worst_m", std::to_string(worst));
}

INSTANTIATE_TEST_SUITE_P(Shapes, VirtualPointTest,
                         testing::Values(Case{"BallPoint", ball, ContactMethod::VirtualPoint},
                                         Case{"BallPotential", ball, ContactMethod::Potential},
                                         Case{"TorusPoint", torus, ContactMethod::VirtualPoint},
                                         Case{"TorusPotential", torus, ContactMethod::Potential},
                                         Case{"BoxPoint", box, ContactMethod::VirtualPoint},
                                         Case{"BoxPotential", box, ContactMethod::Potential}),
                         [](const auto& shape) { return std::string(shape.param.name); });

constexpr int kEdgeCells = 96;
constexpr double kEdgeVoxel = 1.2 / kEdgeCells, kEdgeDepth = 0.5e-3 / kScale, kEdgeStep = kEdgeVoxel / 50.0;

/// Forces in the box's frame while the tip moves along `path` (field frame) by kEdgeStep a tick.
std::vector<glm::dvec3> forcesAlong(ContactMethod method, const glm::dvec3& from, const glm::dvec3& corner,
                                    const glm::dvec3& to) {
    FieldAlone bench(fieldOf(box, kEdgeCells), method);
    bench.moveTo(bench.pose.point(from + glm::dvec3(0, 0.05, 0)), 0.1);
    std::vector<glm::dvec3> forces;
    const auto follow = [&](const glm::dvec3& begin, const glm::dvec3& end) {
        const double length = glm::length(end - begin);
        for (double s = 0.0; s < length; s += kEdgeStep)
            forces.push_back(glm::conjugate(bench.pose.rotation) *
                             bench.step(bench.pose.point(begin + s / length * (end - begin))).force);
    };
    follow(from, corner);
    follow(corner, to);
    return forces;
}

/// 0.5 mm under the faces and round the edge between them: the force turns within three voxels of travel (5
/// to 95 % of 90 degrees), by at most 90 degrees times step / voxel in a tick. The sweep's proxy stays on
/// the face that it came to.
TEST(VirtualPoint, TurnsWithinThreeVoxelsAcrossTheMedialAxis) {
    const glm::dvec3 corner(0.4 - kEdgeDepth, 0.3 - kEdgeDepth, 0.0);
    const glm::dvec3 from = corner - glm::dvec3(4.0 * kEdgeVoxel, 0, 0),
                     to = corner - glm::dvec3(0, 4.0 * kEdgeVoxel, 0);
    const auto turned = [](const glm::dvec3& force) { return std::atan2(force.x, force.y); };
    const std::vector<glm::dvec3> point = forcesAlong(ContactMethod::VirtualPoint, from, corner, to);
    double largest = 0.0;
    int between = 0;
    for (size_t i = 0; i < point.size(); ++i) {
        ASSERT_GT(glm::length(point[i]), 0.0);
        const double angle = turned(point[i]) / (0.5 * std::numbers::pi);
        between += angle > 0.05 && angle < 0.95 ? 1 : 0;
        if (i > 0)
            largest = std::max(largest, std::abs(turned(point[i]) - turned(point[i - 1])));
    }
    std::printf("turns within %.2f voxels, by at most %.2f degrees times step / voxel a tick\n",
                between * kEdgeStep / kEdgeVoxel,
                largest * 180.0 / std::numbers::pi * kEdgeVoxel / kEdgeStep);
    EXPECT_LT(between * kEdgeStep, 3.0 * kEdgeVoxel);
    EXPECT_LT(largest, 0.5 * std::numbers::pi * kEdgeStep / kEdgeVoxel);
    EXPECT_NEAR(turned(point.front()), 0.0, 1e-3);
    EXPECT_NEAR(turned(point.back()), 0.5 * std::numbers::pi, 1e-3);
    for (const glm::dvec3& force : forcesAlong(ContactMethod::Sweep, from, corner, to))
        EXPECT_NEAR(turned(force), 0.0, 1e-6);
}

/// Figure 1: out of the box 0.5 mm below its edge. The proxy's force falls from k d to nothing in one tick;
/// the virtual point's turns and fades.
TEST(VirtualPoint, FadesWhereTheProxyLeavesAnEdgeInOneTick) {
    const glm::dvec3 corner(0.4 - kEdgeDepth, 0.3 - kEdgeDepth, 0.0);
    const glm::dvec3 from = corner - glm::dvec3(4.0 * kEdgeVoxel, 0, 0),
                     to = corner + glm::dvec3(2.0 * kEdgeVoxel, 0, 0);
    const double deepest = kStiffness * kEdgeDepth * kScale;
    const auto largestStep = [&](ContactMethod method) {
        const std::vector<glm::dvec3> forces = forcesAlong(method, from, corner, to);
        double largest = 0.0;
        for (size_t i = 1; i < forces.size(); ++i)
            largest = std::max(largest, glm::length(forces[i] - forces[i - 1]));
        return largest;
    };
    EXPECT_NEAR(largestStep(ContactMethod::Sweep), deepest, 0.1 * deepest);
    EXPECT_LT(largestStep(ContactMethod::VirtualPoint), 0.15 * deepest);
}

/// [002] §4.2: the magnitude is thresholded, the direction stays.
TEST(VirtualPoint, ForceIsNoLargerThanItsThreshold) {
    FieldAlone bench(fieldOf(ball, 48), ContactMethod::VirtualPoint);
    bench.step(bench.pose.point({0.0, 0.0, 0.5}));
    const glm::dvec3 deep = bench.pose.point({0.0, 0.0, 0.3});
    const glm::dvec3 free = bench.step(deep).force;
    EXPECT_NEAR(glm::length(free), kStiffness * 0.1 * kScale, 0.05);
    bench.settings.forceThreshold = 2.0;
    const glm::dvec3 limited = bench.step(deep).force;
    EXPECT_NEAR(glm::length(limited), 2.0, 1e-12);
    EXPECT_LT(glm::length(glm::normalize(limited) - glm::normalize(free)), 1e-12);
}

/// A hand that begins inside feels nothing before it has left; so does one in contact when the sweep takes
/// over, which has no valid start there.
TEST(VirtualPoint, BeginsOutside) {
    FieldAlone bench(fieldOf(ball, 48), ContactMethod::VirtualPoint);
    const glm::dvec3 inside = bench.pose.point({0.0, 0.0, 0.38}), out = bench.pose.point({0.0, 0.0, 0.5});
    EXPECT_EQ(bench.step(inside).force, glm::dvec3(0.0));
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.step(out);
    EXPECT_GT(glm::length(bench.step(inside).force), 0.1);
    bench.settings.contact = ContactMethod::Sweep;
    EXPECT_EQ(bench.step(inside).force, glm::dvec3(0.0));
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.step(out);
    EXPECT_GT(glm::length(bench.step(inside).force), 0.1);
    bench.settings.contact = ContactMethod::Potential; // from the sweep's contact straight away
    EXPECT_NEAR(glm::length(bench.step(inside).force), kStiffness * 0.02 * kScale, 0.02);
}

/// Where the field is flat there is no direction; the sweep, which may not start there either, lets the hand
/// out first.
TEST(VirtualPoint, HasNoForceWhereTheFieldIsFlat) {
    FieldAlone bench(fieldOf(ball, 48, 0.1), ContactMethod::VirtualPoint);
    const glm::dvec3 out = bench.pose.point({0.0, 0.0, 0.5});
    bench.step(out);
    EXPECT_NEAR(glm::length(bench.step(bench.pose.point({0.0, 0.0, 0.34})).force), kStiffness * 0.06 * kScale,
                0.05);
    const glm::dvec3 core = bench.pose.point({0.0, 0.0, 0.1});
    EXPECT_EQ(bench.step(core).force, glm::dvec3(0.0));
    EXPECT_EQ(bench.output.contacts, 0u);
    bench.settings.contact = ContactMethod::Sweep;
    for (int i = 0; i < 10; ++i)
        EXPECT_EQ(bench.step(core).force, glm::dvec3(0.0));
    EXPECT_TRUE(has(bench.output.flags, TickFlag::StartedInside));
    bench.step(out);
    EXPECT_GT(glm::length(bench.step(bench.pose.point({0.0, 0.0, 0.38})).force), 0.1);
}

/// What the sweep left sticking, at the centre of a ball above the surface, is no stiction point of a point.
TEST(VirtualPoint, BeginsWithoutTheFrictionOfTheSweep) {
    FieldAlone bench(fieldOf(ball, 48), ContactMethod::Sweep);
    bench.settings.friction = FrictionMode::Zilles;
    bench.settings.proxyRadius = 0.002;
    bench.settings.staticFriction = bench.settings.dynamicFriction = 2.0;
    bench.step(bench.pose.point({0.0, 0.0, 0.5}));
    const glm::dvec3 inside = bench.pose.point({0.0, 0.0, 0.36});
    for (int i = 0; i < 3; ++i)
        bench.step(inside);
    ASSERT_EQ(bench.output.friction, FrictionState::Sticking);
    bench.settings.contact = ContactMethod::VirtualPoint;
    EXPECT_NEAR(glm::length(bench.step(inside).force), kStiffness * 0.04 * kScale, 0.05);
}

/// A hidden object is empty: nobody need handle it.
TEST(VirtualPoint, PassesOverWhatIsHidden) {
    FieldAlone bench(fieldOf(ball, 32), ContactMethod::VirtualPoint);
    const std::shared_ptr<HapticScene> both = copyOf(*bench.scene);
    both->objects.push_back(std::make_shared<HapticObject>());
    both->restMotions.emplace_back();
    both->restSpheres.emplace_back(0.0);
    both->boundingRadii.push_back(0.0);
    bench.scene = both;
    EXPECT_EQ(refusalOf(*both, bench.settings), "");
    bench.step(bench.pose.point({0.0, 0.0, 0.5}));
    EXPECT_GT(glm::length(bench.step(bench.pose.point({0.0, 0.0, 0.38})).force), 0.1);
    EXPECT_FALSE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
}

/// A mesh beside the field: the sweep touches both, the reason is named.
TEST(VirtualPoint, LeavesScenesWithMeshesToTheSweep) {
    TouchBench bench(cornerScene({{.normal = {0, 1, 0}, .stiffness = kStiffness}}), cornerSettings());
    bench.settings.contact = ContactMethod::VirtualPoint;
    EXPECT_FALSE(comparisonIsReady(*bench.scene, bench.settings));
    EXPECT_NE(refusalOf(*bench.scene, bench.settings).find("distance fields"), std::string::npos);
    bench.step({0.0, 0.3, 0.0});
    EXPECT_TRUE(has(bench.output.flags, TickFlag::NeighbourhoodMissing));
    FieldAlone field(fieldOf(ball, 32), ContactMethod::Rays);
    EXPECT_NE(refusalOf(*field.scene, field.settings).find("meshes"), std::string::npos);
    field.settings.contact = ContactMethod::Potential;
    EXPECT_EQ(refusalOf(*field.scene, field.settings), "");
}

/// s: of [002 eq. 4] at the depth, as kimLaw reads it.
double tauOf(double friction, double growth, double depth) {
    const double term = std::min(friction * (1.0 + growth * depth), 0.999);
    return 1e-3 * term / (1.0 - term);
}

/// A hand that slides on a flat face, 2 mm deep, and then stops.
void slideAndRest(TouchBench& bench, double rate, double depth, const glm::dvec3& start,
                  const glm::dvec3& along, const glm::dvec3& out) {
    constexpr double kSpeed = 0.04, kFriction = 0.9, kGrowth = 20.0;
    bench.dt = 1.0 / rate;
    bench.settings.friction = FrictionMode::Kim;
    bench.settings.staticFriction = bench.settings.dynamicFriction = kFriction;
    bench.settings.frictionDepth = kGrowth;
    bench.settings.stiffness = kStiffness;
    const double tau = tauOf(kFriction, kGrowth, depth);
    glm::dvec3 hip = start + 0.01 * out;
    bench.step(hip);
    bench.moveTo(start - depth * out, 0.1);
    hip = start - depth * out;
    for (double t = 0.0; t < 12.0 * tau; t += bench.dt) {
        hip += kSpeed * bench.dt * along;
        bench.step(hip);
    }
    const double lag = -glm::dot(bench.output.proxy - hip, along);
    EXPECT_NEAR(lag, tau * kSpeed, 0.01 * tau * kSpeed) << rate;
    EXPECT_NEAR(-glm::dot(bench.output.force, along), kStiffness * lag, 1e-6) << rate;
    EXPECT_NEAR(glm::dot(bench.output.force, out), kStiffness * depth, 1e-3 * kStiffness * depth) << rate;
    // At rest it creeps: the lag decays with tau (at 1 kHz by f_v a tick).
    const auto ticks = static_cast<int>(std::lround(2.0 * tau * rate));
    for (int i = 0; i < ticks; ++i)
        bench.step(hip);
    const double f = tau / (tau + bench.dt);
    EXPECT_NEAR(-glm::dot(bench.output.proxy - hip, along) / lag, std::pow(f, ticks), 1e-3) << rate;
}

/// [002 eqs. 4 to 7]: the lag is tau v at every rate, on a mesh and as published on a field.
TEST(KimFriction, LagsByTauTimesTheSpeedAtEveryRateAndCreepsAtRest) {
    for (const double rate : {1000.0, 4000.0}) {
        HapticSettings settings;
        settings.forceShading = ShadingMode::Off;
        TouchBench mesh(sceneOf(assets::plane(0.2, 0.2, 2, 2)), settings);
        slideAndRest(mesh, rate, 2e-3, {-0.06, 0.0, 0.003}, {1, 0, 0}, {0, 1, 0});
        for (const ContactMethod method : {ContactMethod::Sweep, ContactMethod::VirtualPoint}) {
            FieldAlone field(fieldOf(box, 64), method);
            slideAndRest(field, rate, 2e-3, field.pose.point({-0.2, 0.05, 0.35}),
                         field.pose.direction({1, 0, 0}), field.pose.direction({0, 0, 1}));
        }
    }
}

TEST(KimFriction, IsThePrintedFractionAtOneKilohertzAndNeverHoldsForEver) {
    FrictionInput in{.stretch = {1.0, 2.0, 0.0}, .dynamicFriction = 0.6, .dt = 1e-3, .growth = 0.25};
    const FrictionAnswer answer = kimLaw(in);
    EXPECT_NEAR(glm::length(answer.stretch - 0.75 * in.stretch), 0.0, 1e-15); // f_c (1 + 0.25)
    EXPECT_FALSE(answer.stays);
    in.growth = 100.0; // eq. 4 leaves 0..1
    EXPECT_NEAR(kimLaw(in).stretch.x, 0.999, 1e-12);
    in.dynamicFriction = 0.0;
    EXPECT_EQ(kimLaw(in).stretch, glm::dvec3(0.0));
}

} // namespace
} // namespace touchstone::test::virtual_point_test
