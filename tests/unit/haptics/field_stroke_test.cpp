// Strokes over fields that curve towards the hand and away from it: the proxy keeps up with the nearest place
// of the surface.

#include "tests/support/allocation_counter.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <numbers>
#include <random>

namespace touchstone::test::field_stroke_test {
namespace {

constexpr double kScale = 0.15; // m per object unit
constexpr int kCells = 96;
constexpr double kVoxel = kScale * 1.2 / kCells; // m

/// A surface whose places have, as deep as the strokes go, nothing nearer than the place straight above.
struct Body {
    const char* name;
    Distance distance; ///< zero on the surface; object units
    glm::dvec3 start;  ///< near it
    /// Where the strokes stay: positive.
    std::function<double(const glm::dvec3&)> room;
};

const glm::dvec3 kBowl(0.0, 0.32, 0.0), kSmallBowl(0.0, 0.1, 0.0);

double bowl(const glm::dvec3& p, const glm::dvec3& middle, double radius) {
    return std::max(radius - glm::length(p - middle), box(p, glm::dvec3(0.45)));
}
/// 3 mm high, 38 mm long; slopes up to 0.5.
double waves(const glm::dvec3& p) {
    const double height = 0.02 * std::sin(25.0 * p.x + 0.3) * std::sin(25.0 * p.z);
    return std::max((p.y - height) / std::sqrt(1.25), box(p, glm::dvec3(0.45)));
}

double ringOf(const glm::dvec3& p) {
    return std::hypot(p.x, p.y);
}

const std::vector<Body>& bodies() {
    static const std::vector<Body> all{
        {"torus, saddle", torus, {0.18, 0.0, 0.0}, [](const glm::dvec3& p) { return 0.25 - ringOf(p); }},
        {"torus, all round", torus, {0.42, 0.0, 0.0}, [](const glm::dvec3&) { return 1.0; }},
        {"torus, outside", torus, {0.42, 0.0, 0.0}, [](const glm::dvec3& p) { return ringOf(p) - 0.33; }},
        {"bowl of 45 mm",
         [](const glm::dvec3& p) { return bowl(p, kBowl, 0.3); },
         {0.0, 0.02, 0.0},
         [](const glm::dvec3& p) { return 0.25 - p.y; }},
        {"bowl of 9 mm",
         [](const glm::dvec3& p) { return bowl(p, kSmallBowl, 0.06); },
         {0.0, 0.04, 0.0},
         [](const glm::dvec3& p) { return 0.1 - p.y; }},
        {"waves", waves, {0.0, 0.0, 0.0}, [](const glm::dvec3& p) {
             return 0.35 - std::max(std::abs(p.x), std::abs(p.z));
         }}};
    return all;
}

glm::dvec3 normalOf(const Distance& distance, const glm::dvec3& p) {
    glm::dvec3 g;
    for (int axis = 0; axis < 3; ++axis) {
        glm::dvec3 h(0.0);
        h[axis] = 1e-6;
        g[axis] = distance(p + h) - distance(p - h);
    }
    return glm::normalize(g);
}

/// A hand that wanders over a surface, `depth` below it.
class Wanderer {
  public:
    Wanderer(const Body& body, double speed, uint32_t seed)
        : body_(body), step_(1e-3 * speed / kScale), random_(seed) {
        place_ = onSurface(body.start);
        way_ = glm::normalize(glm::dvec3(normal_(random_), normal_(random_), normal_(random_)));
        phase_ = 10.0 * std::abs(normal_(random_));
    }
    /// Object units: the place above the hand, and m below it.
    void next() {
        const glm::dvec3 n = normalOf(body_.distance, place_);
        way_ += 0.03 * glm::dvec3(normal_(random_), normal_(random_), normal_(random_));
        way_ -= glm::dot(way_, n) * n;
        way_ = glm::normalize(way_);
        const glm::dvec3 to = onSurface(place_ + step_ * way_);
        if (body_.room(to) < 0.0)
            way_ = -way_ + 0.3 * glm::cross(n, way_);
        else
            place_ = to;
        ++tick_;
    }
    [[nodiscard]] double depth() const { return 0.003 + 0.002 * std::sin(0.01 * tick_ + phase_); }
    [[nodiscard]] glm::dvec3 place() const { return FieldBench::kMiddle + kScale * place_; }
    [[nodiscard]] glm::dvec3 normal() const { return normalOf(body_.distance, place_); }
    [[nodiscard]] glm::dvec3 hip(double depth) const { return place() - depth * normal(); }

  private:
    [[nodiscard]] glm::dvec3 onSurface(glm::dvec3 p) const {
        for (int i = 0; i < 6; ++i)
            p -= body_.distance(p) * normalOf(body_.distance, p);
        return p;
    }
    const Body& body_;
    double step_; ///< object units a tick
    std::mt19937 random_;
    std::normal_distribution<double> normal_;
    glm::dvec3 place_{0.0}, way_{0.0};
    double phase_ = 0.0;
    int tick_ = 0;
};

/// The steepest way towards the HIP that is free near the proxy, as the sine of its angle to the surface:
/// zero at a local nearest place.
double unheld(const FieldShape& field, const glm::dvec3& proxy, const glm::dvec3& hip) {
    constexpr double kNear = 2e-6; // object units
    const glm::dvec3 p = (proxy - FieldBench::kMiddle) / kScale, up = glm::normalize(proxy - hip);
    const glm::dvec3 other = std::abs(up.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    const glm::dvec3 x = glm::normalize(glm::cross(up, other)), y = glm::cross(up, x);
    const double level = field.value(p) - 1e-12;
    for (const double sine : {0.3, 0.1, 0.03, 0.01})
        for (int i = 0; i < 64; ++i) {
            const double a = std::numbers::pi / 32 * i;
            const glm::dvec3 flat = std::cos(a) * x + std::sin(a) * y;
            if (field.value(p + kNear * (std::sqrt(1.0 - sine * sine) * flat - sine * up)) >= level)
                return sine;
        }
    return 0.0;
}

struct Stroke {
    int ticks = 0, atBudget = 0;
    double moves = 0.0;
    double lag = 0.0, meanLag = 0.0; ///< m, of the proxy from the smooth surface's place nearest to the HIP
    double unheld = 0.0;
};

/// The hand is 1 to 5 mm below the surface.
Stroke strokeOver(const Body& body, double speed, uint32_t seed, int ticks, double radius = 0.0,
                  ShadingMode shading = ShadingMode::Off) {
    const auto field = fieldOf(body.distance, kCells);
    FieldBench bench(field);
    bench.settings.proxyRadius = radius;
    bench.settings.forceShading = shading;
    Wanderer hand(body, speed, seed);
    Stroke stroke{.ticks = ticks};
    bench.step(hand.hip(-0.004));
    bench.moveTo(hand.hip(hand.depth()), 0.1);
    for (int i = 0; i < ticks; ++i) {
        hand.next();
        const glm::dvec3 hip = hand.hip(hand.depth());
        const uint64_t before = allocationsOnThisThread();
        const HapticOutput& out = bench.step(hip);
        EXPECT_EQ(allocationsOnThisThread(), before);
        EXPECT_GT(out.contacts, 0u) << body.name << " tick " << i;
        stroke.moves += static_cast<double>(out.iterations) / ticks;
        const double lag = glm::distance(out.proxy, hand.place() + radius * hand.normal());
        stroke.lag = std::max(stroke.lag, lag);
        stroke.meanLag += lag / ticks;
        if (has(out.flags, TickFlag::BudgetReached))
            ++stroke.atBudget;
        else
            stroke.unheld = std::max(stroke.unheld, unheld(*field, out.proxy, hip));
    }
    return stroke;
}

/// What is left of the lag is the field's: its normals are off by O(voxel), times the depth.
TEST(FieldStroke, TheProxyKeepsUpWhereTheSurfaceCurvesTowardsTheHand) {
    for (const Body& body : bodies())
        for (const double speed : {0.1, 0.3}) {
            const Stroke s = strokeOver(body, speed, 7, 2000);
            std::printf(
                "%-16s %.1f m/s: %4d of %d at budget, %4.1f moves, lag %.4f mm (mean %.4f), unheld %.2g\n",
                body.name, speed, s.atBudget, s.ticks, s.moves, 1e3 * s.lag, 1e3 * s.meanLag, s.unheld);
            EXPECT_LT(s.atBudget, s.ticks / 100) << body.name;
            EXPECT_LT(s.lag, 0.5 * kVoxel) << body.name;
            EXPECT_LT(s.meanLag, 0.1 * kVoxel) << body.name;
            EXPECT_LT(s.unheld, 0.1) << body.name;
            EXPECT_LT(s.moves, 1.5) << body.name; // with tangent planes alone 5 to 9
        }
}

/// Shape::restNear against its definition: on the isosurface, no place around it nearer to the goal.
TEST(FieldStroke, TheFieldKnowsWhereABallRests) {
    std::mt19937 random(5);
    std::uniform_real_distribution<double> any(-1.0, 1.0);
    int known = 0, asked = 0, onFaces = 0;
    for (const Body& body : bodies()) {
        const auto field = fieldOf(body.distance, kCells);
        Wanderer hand(body, 1.0, 11);
        for (int i = 0; i < 1000; ++i) {
            hand.next();
            const double level = 0.01 * std::abs(any(random)) + 1e-12, deep = 0.02 + 0.01 * any(random);
            const glm::dvec3 up = hand.normal(), at = (hand.place() - FieldBench::kMiddle) / kScale;
            const glm::dvec3 from =
                at + level * up + 0.003 * glm::dvec3(any(random), any(random), any(random));
            const glm::dvec3 goal = at - deep * up;
            glm::dvec3 place;
            ++asked;
            if (!field->restNear(from, goal, level, place))
                continue;
            ++known;
            ASSERT_NEAR(field->value(place), level, 2e-13) << body.name << " " << i;
            const glm::dvec3 grid = field->grid().gridFromObject(place);
            for (int axis = 0; axis < 3; ++axis)
                onFaces += std::abs(grid[axis] - std::round(grid[axis])) < 1e-9;
            const double sine =
                unheld(*field, FieldBench::kMiddle + kScale * place, FieldBench::kMiddle + kScale * goal);
            ASSERT_EQ(sine, 0.0) << body.name << " " << i;
        }
    }
    std::printf("%d of %d known, %d in kinks between cells\n", known, asked, onFaces);
    EXPECT_GT(known, asked * 9 / 10);
    EXPECT_GT(onFaces, 0);
    glm::dvec3 place;
    const auto field = fieldOf(torus, kCells);
    const glm::dvec3 above(0.5, 0.0, 0.0);
    EXPECT_FALSE(field->restNear({0.42, 0.0, 0.0}, above, 0.0, place)) << "a goal in the air";
    EXPECT_FALSE(field->restNear({5.0, 0.0, 0.0}, {0.4, 0.0, 0.0}, 0.0, place)) << "from beyond the grid";
    EXPECT_FALSE(field->restNear({NAN, 0.0, 0.0}, {0.4, 0.0, 0.0}, 0.0, place));
    EXPECT_FALSE(field->restNear({0.42, 0.0, 0.0}, {NAN, 0.0, 0.0}, 0.0, place));
}

/// Interpolated normals are smooth: what they hold is nearer to the smooth surface's place.
TEST(FieldStroke, WithTwoPassShadingTheProxyIsWithinATenthOfAMillimetre) {
    double lag = 0.0;
    for (const Body& body : bodies())
        for (const double speed : {0.1, 0.3}) {
            const Stroke s = strokeOver(body, speed, 7, 2000, 0.0, ShadingMode::TwoPass);
            EXPECT_EQ(s.atBudget, 0) << body.name;
            EXPECT_LT(s.lag, 1e-4) << body.name;
            lag = std::max(lag, s.lag);
        }
    std::printf("%.4f mm at most\n", 1e3 * lag);
}

TEST(FieldStroke, AnyStrokeKeepsUp) {
    int ticks = 0, atBudget = 0;
    double lag = 0.0;
    uint32_t seed = 100;
    for (const Body& body : bodies())
        for (const double radius : {0.0, 0.5e-3})
            for (const double speed : {0.02, 0.15, 0.5, 1.0}) {
                const Stroke s = strokeOver(body, speed, ++seed, 400, radius);
                ticks += s.ticks;
                atBudget += s.atBudget;
                lag = std::max(lag, s.lag);
                EXPECT_LT(s.lag, 0.6 * kVoxel) << body.name << " " << speed << " " << radius << " " << seed;
                EXPECT_LT(s.unheld, 0.1) << body.name << " " << speed << " " << radius << " " << seed;
            }
    std::printf("%d of %d ticks at budget, lag %.3f mm\n", atBudget, ticks, 1e3 * lag);
    EXPECT_LT(atBudget, ticks / 100);
}

/// Finer voxels: to 0.1 mm of the smooth surface's nearest place.
TEST(FieldStroke, OnAFineFieldTheProxyIsAtTheNearestPlaceOfTheTorus) {
    const auto field = fieldOf(torus, 384);
    double off = 0.0;
    for (const double around : {0.0, 1.1, 2.2, 3.14159}) // from the outside to the saddle
        for (const double depth : {0.001, 0.005}) {
            const auto hip = [&](double ring, double deep) {
                const double reach = 0.12 - deep / kScale, out = 0.3 + reach * std::cos(around);
                return FieldBench::kMiddle + kScale * glm::dvec3(out * std::cos(ring), out * std::sin(ring),
                                                                 reach * std::sin(around));
            };
            FieldBench bench(field);
            bench.step(hip(0.3, -0.005));
            bench.moveTo(hip(0.3, depth), 0.1);
            for (int i = 0; i < 500; ++i) {
                bench.step(hip(0.3 + 1e-3 * i, depth));
                off = std::max(off, glm::distance(bench.output.proxy, hip(0.3 + 1e-3 * i, 0.0)));
            }
        }
    std::printf("voxels of %.2f mm: %.4f mm off\n", 1e3 * kScale * 1.2 / 384, 1e3 * off);
    EXPECT_LT(off, 1e-4);
}

/// The walls of a groove are planes of the field, to the last bit: two contacts hold the proxy in its edge.
TEST(FieldStroke, AGrooveHoldsTheProxyWithBothWalls) {
    const auto field = fieldOf(
        [](const glm::dvec3& p) {
            return std::max((p.y - std::abs(p.x)) * std::numbers::sqrt2 / 2.0, box(p, glm::dvec3(0.45)));
        },
        kCells);
    FieldBench bench(field);
    bench.step(FieldBench::kMiddle + glm::dvec3(0.001, 0.003, -0.04));
    int both = 0, atBudget = 0;
    double off = 0.0;
    for (int i = 0; i < 2000; ++i) {
        // Beyond the walls' normals the proxy leaves the edge.
        const glm::dvec3 hip(0.004 * std::sin(0.02 * i), -0.003, -0.04 + 4e-5 * i);
        const HapticOutput& out = bench.step(FieldBench::kMiddle + hip);
        const double along = 0.5 * (std::abs(hip.x) + hip.y);
        const glm::dvec3 nearest(along > 0.0 ? std::copysign(along, hip.x) : 0.0, std::max(along, 0.0),
                                 hip.z);
        off = std::max(off, glm::distance(out.proxy, FieldBench::kMiddle + nearest));
        both += out.planeCount == 2 ? 1 : 0;
        atBudget += has(out.flags, TickFlag::BudgetReached) ? 1 : 0;
    }
    std::printf("%d ticks in the edge, %d at budget, %.3g um off\n", both, atBudget, 1e6 * off);
    EXPECT_GT(both, 800);
    EXPECT_EQ(atBudget, 0);
    EXPECT_LT(off, 1e-6);
}

/// An edge across the grid is a staircase of kinks: the proxy rests in its steps.
TEST(FieldStroke, AGrooveAcrossTheGridIsFollowed) {
    const glm::dvec3 along = glm::normalize(glm::dvec3(0.3, 0.15, 1.0));
    const glm::dvec3 left = glm::normalize(glm::cross(along, glm::dvec3(1.0, -0.6, 0.0))),
                     right = glm::normalize(glm::cross(glm::dvec3(-0.4, -1.0, 0.0), along));
    const auto field = fieldOf(
        [&](const glm::dvec3& p) {
            return std::max(std::min(glm::dot(left, p), glm::dot(right, p)), box(p, glm::dvec3(0.45)));
        },
        kCells);
    const glm::dvec3 out = glm::normalize(left + right);
    for (const double speed : {0.1, 0.3}) {
        FieldBench bench(field);
        const auto hip = [&](double s, double deep) { return FieldBench::kMiddle + s * along - deep * out; };
        bench.step(hip(-0.04, -0.004));
        bench.moveTo(hip(-0.04, 0.003), 0.1);
        int ticks = 0, atBudget = 0;
        double lag = 0.0, slope = 0.0;
        bench.moveTo(hip(0.04, 0.003), speed, [&](const HapticOutput& o) {
            ++ticks;
            atBudget += has(o.flags, TickFlag::BudgetReached) ? 1 : 0;
            lag = std::max(lag, glm::distance(o.proxy, o.hip + 0.003 * out));
            if (!has(o.flags, TickFlag::BudgetReached))
                slope = std::max(slope, unheld(*field, o.proxy, o.hip));
        });
        std::printf("%.1f m/s: %d of %d at budget, %.3f mm from the edge, unheld %.2g\n", speed, atBudget,
                    ticks, 1e3 * lag, slope);
        EXPECT_LT(atBudget, ticks / 50);
        EXPECT_LT(lag, 1.2 * kVoxel);
        EXPECT_LT(slope, 0.1);
    }
}

/// A shell of two voxels, stroked from inside with the hand far outside of it.
TEST(FieldStroke, AThinShellIsNotPassedFromItsHollowSide) {
    constexpr double kRadius = 0.3, kHalf = 1.2 / kCells;
    const auto field =
        fieldOf([](const glm::dvec3& p) { return std::abs(glm::length(p) - kRadius) - kHalf; }, kCells);
    for (const double speed : {0.1, 1.0, 10.0}) {
        FieldBench bench(field);
        bench.step(FieldBench::kMiddle);
        std::mt19937 random(3);
        std::normal_distribution<double> normal;
        double farthest = 0.0;
        int atBudget = 0, ticks = 0;
        for (int leg = 0; leg < 40; ++leg) {
            const glm::dvec3 way = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            const double most = 0.5 * speed;
            const glm::dvec3 to = FieldBench::kMiddle + kScale * (kRadius + 0.1) * way;
            const glm::dvec3 end = glm::distance(to, bench.output.hip) > most
                                       ? bench.output.hip + most * glm::normalize(to - bench.output.hip)
                                       : to;
            bench.moveTo(end, speed, [&](const HapticOutput& out) {
                farthest = std::max(farthest, glm::distance(out.proxy, FieldBench::kMiddle));
                atBudget += has(out.flags, TickFlag::BudgetReached) ? 1 : 0;
                ++ticks;
            });
        }
        std::printf("%.1f m/s: %d of %d at budget, the proxy gets to %.3f mm of the shell's %.3f\n", speed,
                    atBudget, ticks, 1e3 * farthest, 1e3 * kScale * (kRadius - kHalf));
        EXPECT_LT(farthest, kScale * (kRadius - 0.5 * kHalf));
        EXPECT_LE(atBudget, ticks / 100);
    }
}

/// Coulomb's cone on a curved field: the friction's part of the force is what the law gives on a plane.
TEST(FieldStroke, FrictionKeepsToItsConeWhereTheSurfaceCurves) {
    constexpr float kStatic = 0.5f, kDynamic = 0.3f, kStiffness = 600.0f;
    for (const Body& body : bodies())
        for (const double speed : {0.05, 0.3}) {
            const auto field = fieldOf(body.distance, kCells);
            FieldBench bench(field, kScale,
                             {.normal = {0, 1, 0},
                              .stiffness = kStiffness,
                              .staticFriction = kStatic,
                              .dynamicFriction = kDynamic});
            bench.settings.friction = FrictionMode::Zilles;
            Wanderer hand(body, speed, 11);
            bench.step(hand.hip(-0.004));
            bench.moveTo(hand.hip(0.003), 0.1);
            int atBudget = 0, sliding = 0;
            double most = 0.0, slip = 0.0, off = 0.0;
            constexpr int kTicks = 1500;
            for (int i = 0; i < kTicks; ++i) {
                hand.next();
                const HapticOutput& out = bench.step(hand.hip(0.003));
                const DeviceState& state = bench.state[0];
                const glm::dvec3 frictionless =
                    bench.scene->objects[static_cast<size_t>(state.reference)]->workspaceFromObject.point(
                        state.frictionless);
                const glm::dvec3 normal = frictionless - out.hip;
                const glm::dvec3 kept = out.force / double{kStiffness} - normal;
                const double ratio = glm::length(kept) / glm::length(normal);
                if (out.planeCount == 1) // several bear more together than their sum's length
                    most = std::max(most, ratio);
                atBudget += has(out.flags, TickFlag::BudgetReached) ? 1 : 0;
                off = std::max(off,
                               kScale * std::abs(field->value((out.proxy - FieldBench::kMiddle) / kScale)));
                if (out.friction == FrictionState::Sliding) {
                    ++sliding;
                    slip += ratio;
                }
            }
            std::printf("%-16s %.2f m/s: %d at budget, %d slide, friction %.4f of the depth at most, %.4f "
                        "sliding, %.3g um off the surface\n",
                        body.name, speed, atBudget, sliding, most, slip / std::max(sliding, 1), 1e6 * off);
            EXPECT_LT(most, kStatic * (1.0 + 1e-6));
            EXPECT_LT(atBudget, kTicks / 100);
            EXPECT_GT(sliding, kTicks / 20);
            EXPECT_NEAR(slip / sliding, kDynamic, 0.02);
            EXPECT_LT(off, 1e-6);
            // A hand that comes to rest sticks, to the last bit.
            const glm::dvec3 rest = bench.output.hip;
            bench.step(rest);
            const glm::dvec3 stuck = bench.output.proxy;
            for (int i = 0; i < 100; ++i)
                EXPECT_EQ(bench.step(rest).proxy, stuck) << body.name;
        }
}

} // namespace
} // namespace touchstone::test::field_stroke_test
