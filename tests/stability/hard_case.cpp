#include "tests/stability/hard_case.h"

#include "haptics/proxy/proxy_solver.h"
#include "study/truth/oracle.h"
#include "tests/stability/case_table.h"
#include "tests/support/corner.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

namespace touchstone::test {

namespace {

constexpr double kStiffness = 1000.0; // N/m, Variant::settings

/// Of the reference object: a rest is known to a few contact gaps, and whatever is nearer than this touches.
constexpr double kTouchReach = 8.0 * kContactGap;
/// Of the reference object and of the depth: rounding of a rest. The gradient of a distance of 5e-7 is good
/// to 2e-10.
constexpr double kRestRounding = 1e-9;
/// Of the reference object, while shaded: the shading ends when its goal moves by less than 1e-8; the goals'
/// steps shrink by at most a half, so what is left is as much again.
constexpr double kShadedRounding = 2e-8;
/// Of the reference object, times the stiffness: what forces are good to.
constexpr double kForceRounding = 10.0 * kRestRounding;
/// Of the reference object, times the stiffness, squared.
constexpr double kEnergyRounding = 1e-13;
/// A solve may end at the budget of moves, safe but short of its rest: round a rounded tip, and on facets
/// 1e-8 to 1e-4 rad apart, the solver takes more than 64 moves now and then. It must catch up within so many
/// ticks.
constexpr int kLateTicks = 20;
constexpr double kBehind = 1e-5; // of the reference object: 1 µm
/// Ticks until a held force is judged.
constexpr int kSettleTicks = 20;

double jumpOf(double depth, double angle) {
    return kStiffness * 2.0 * depth * std::sin(0.5 * std::min(angle, 3.141592653589793));
}

/// Every direction of one has its like in the other.
bool sameDirections(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    const auto within = [](const std::vector<glm::dvec3>& x, const std::vector<glm::dvec3>& y) {
        return std::all_of(x.begin(), x.end(), [&](const glm::dvec3& n) {
            return std::any_of(y.begin(), y.end(),
                               [&](const glm::dvec3& m) { return glm::distance(n, m) < 1e-9; });
        });
    };
    return within(a, b) && within(b, a);
}

/// Keeps the worse of two figures: the larger share of what is allowed.
void worsen(Figure& figure, const Figure& other) {
    if (other.share() > figure.share())
        figure = other;
}

} // namespace

double Figure::share() const {
    return measured <= 0.0 ? 0.0 : allowed > 0.0 ? measured / allowed : INFINITY;
}

HardCase::HardCase(std::string name, const Scene& scene, const Variant& variant)
    : HardCase(std::move(name), scene, variant, variant.settings()) {}

HardCase::HardCase(std::string name, const Scene& scene, const Variant& variant,
                   const HapticSettings& settings)
    : bench(scene, settings), name_(std::move(name)), variant_(variant),
      surface_(*bench.scene, variant.shaded ? settings.shadingTiltLimit : 0.0) {
    figures_.runs = 1;
    figures_.sticks.allowed = kRestRounding * unit();
    figures_.jitter.allowed = figures_.jump.allowed = kStiffness * unit() * kForceRounding;
    figures_.energy.allowed = kStiffness * unit() * unit() * kEnergyRounding;
}

void HardCase::side(std::function<double(const glm::dvec3&)> outside, double allowed) {
    outside_ = std::move(outside);
    figures_.passes.allowed = allowed;
}

double HardCase::effectiveRadius() const {
    const int reference = std::max(bench.state[0].reference, 0);
    const HapticObject& object = *bench.scene->objects[static_cast<size_t>(reference)];
    const Similarity& pose = bench.motions.empty()
                                 ? object.workspaceFromObject
                                 : bench.motions[static_cast<size_t>(reference)].workspaceFromObject;
    return std::max(variant_.radius, 0.5 * kWeldTolerance * object.diagonal * pose.scale);
}

ObjectMotions HardCase::motions() const {
    return bench.motions.empty() ? ObjectMotions(bench.scene->restMotions) : ObjectMotions(bench.motions);
}

double HardCase::unit() const {
    return bench.scene->objects[0]->workspaceFromObject.scale;
}

void HardCase::startAt(const glm::dvec3& hip) {
    way_ = {hip};
    first_ = true;
    bench.state[0].forgetTouch();
    lastTouching_ = Touching{};
    bench.step(hip);
    take();
}

void HardCase::moveTo(const glm::dvec3& hip, double speed) {
    way_.push_back(hip);
    bench.moveTo(hip, speed, [&](const HapticOutput&) { take(); });
}

void HardCase::teleportTo(const glm::dvec3& hip) {
    way_.push_back(hip);
    bench.step(hip);
    take();
}

void HardCase::hold(int ticks) {
    for (int i = 0; i < kSettleTicks + ticks; ++i) {
        holding_ = i >= kSettleTicks;
        bench.step(bench.output.hip);
        take();
    }
    holding_ = false;
}

void HardCase::leave(double speed) {
    std::vector<glm::dvec3> back(way_.rbegin() + 1, way_.rend());
    for (const glm::dvec3& hip : back)
        bench.moveTo(hip, speed, [&](const HapticOutput&) { take(); });
    EXPECT_EQ(bench.output.contacts, 0u) << "free again at the start";
    EXPECT_LE(figures_.energy.measured, figures_.energy.allowed) << "energy over the closed path, J";
    judge();
}

void HardCase::judge() {
    if (bench.output.contacts > 0 || glm::distance(bench.output.hip, way_.front()) > 0.0)
        figures_.energy = Figure{}; // not a closed path
    figures_.energy.measured = std::max(figures_.energy.measured, 0.0);
    EXPECT_LE(figures_.passes.measured, figures_.passes.allowed) << "passes through, m";
    EXPECT_EQ(figures_.notFinite.measured, 0.0);
    EXPECT_LE(figures_.sticks.measured, figures_.sticks.allowed) << "sticks, m";
    EXPECT_LE(figures_.jitter.measured, figures_.jitter.allowed) << "jitters while held, N";
    EXPECT_LE(figures_.jump.measured, figures_.jump.allowed) << "force jump in a tick, N";
    EXPECT_LE(figures_.lateInARow, kLateTicks) << "ticks in a row that left more than 1 um to go";
    addToCaseTable(name_, variant_.name(), figures_);
}

void HardCase::take() {
    const HapticOutput& now = bench.output;
    ++figures_.ticks;
    for (const glm::dvec3& v : {now.proxy, now.force, now.normal, now.commandInWorkspace})
        for (int i = 0; i < 3; ++i)
            figures_.notFinite.measured += std::isfinite(v[i]) ? 0.0 : 1.0;
    figures_.late += has(now.flags, TickFlag::BudgetReached) ? 1 : 0;
    figures_.notConverged += has(now.flags, TickFlag::ShadingNotConverged) ? 1 : 0;
    takeCommand();
    if (has(now.flags, TickFlag::StartedInside)) {
        EXPECT_EQ(glm::length(now.force), 0.0) << "a hand inside feels nothing";
        last_ = now;
        lastTouching_ = Touching{};
        first_ = false;
        return;
    }

    const double radius = effectiveRadius();
    const Touching touching = surface_.touching(motions(), now.proxy, radius + kTouchReach * unit());
    // Passes through: nearer to a triangle than its radius, or on the wrong side. The gap that a rest keeps
    // is there for rounding, and as much again.
    const double lack = radius - kContactGap * unit() - touching.nearest;
    figures_.passes.measured = std::max(figures_.passes.measured, lack);
    if (outside_)
        figures_.passes.measured = std::max(figures_.passes.measured, -outside_(now.proxy));
    const double wasBehind = behind_;
    takeRest(touching);
    takeForce(touching, behind_ + wasBehind);
    last_ = now;
    lastTouching_ = touching;
    first_ = false;
}

/// No spike: what goes to the device stays within its limits, whatever the world does.
void HardCase::takeCommand() {
    const DeviceLimits& limits = bench.limits;
    EXPECT_LE(glm::length(bench.output.commandInWorkspace), limits.maxForce * (1.0 + 1e-9));
    if (!first_) {
        EXPECT_LE(glm::distance(bench.output.commandInWorkspace, last_.commandInWorkspace),
                  limits.maxForceRate * bench.dt * (1.0 + 1e-9));
    }
}

/// Where the oracle, which knows no budget, no shading and no friction, comes to rest from this tick's place.
glm::dvec3 HardCase::oracleFrom(const HapticOutput& now) {
    if (!soup_)
        soup_ = std::make_unique<const Soup>(*bench.scene, 0);
    const Similarity& pose = bench.scene->objects[0]->workspaceFromObject;
    const Similarity back = pose.inverse();
    const OracleRest rest = oracleRest(*soup_, LVec3(back.point(now.proxy)), LVec3(back.point(now.hip)),
                                       static_cast<long double>(effectiveRadius() / pose.scale));
    return pose.point(glm::dvec3(rest.proxy));
}

/// Sticks: what is left of the wish to go to the HIP, held by all that touches there and, where shaded, by
/// what it feels like. With friction: how far the oracle, which knows none, goes on from there; the
/// coefficient times the sum of the planes' loads is allowed.
void HardCase::takeRest(const Touching& touching) {
    const HapticOutput& now = bench.output;
    if (bench.settings.friction != FrictionMode::Off) {
        const glm::dvec3 rest = oracleFrom(now);
        friction_ = loadOf(now, rest - now.hip);
        worsen(figures_.sticks, {glm::distance(rest, now.proxy),
                                 bench.settings.staticFriction * friction_ + kRestRounding * unit()});
        return;
    }
    std::vector<LVec3> holding(touching.normals.begin(), touching.normals.end());
    if (touching.tilt() > 0.0)
        holding.insert(holding.end(), touching.felt.begin(), touching.felt.end());
    const auto left =
        static_cast<double>(restResidual(holding, LVec3(now.proxy / unit()), LVec3(now.hip / unit())) *
                            static_cast<long double>(unit()));
    const double depth = glm::distance(now.proxy, now.hip);
    const double allowed = kRestRounding * (unit() + depth) + restLength(now.iterations) * unit() +
                           (touching.tilt() > 0.0 ? kShadedRounding * unit() : 0.0);
    behind_ = has(now.flags, TickFlag::BudgetReached)
                  ? std::max(left, glm::distance(oracleFrom(now), now.proxy))
                  : 0.0;
    lateInARow_ = behind_ > kBehind * unit() ? lateInARow_ + 1 : 0;
    figures_.lateInARow = std::max(figures_.lateInARow, lateInARow_);
    if (behind_ > 0.0)
        figures_.behind = std::max(figures_.behind, behind_);
    else
        worsen(figures_.sticks, {left, allowed});
}

/// `behind`: m, what a solve that ended at the budget leaves to the next tick, which catches up.
void HardCase::takeForce(const Touching& touching, double behind) {
    const HapticOutput& now = bench.output;
    if (first_)
        return;
    // What the world did to the HIP counts as the HIP's motion.
    double travel = glm::distance(now.hip, last_.hip), grown = 0.0;
    if (!bench.motions.empty()) {
        const ObjectMotion& reference = bench.motions[static_cast<size_t>(bench.state[0].reference)];
        travel = glm::distance(
            now.hip, reference.workspaceFromObject.point(reference.before.inverse().point(last_.hip)));
        grown = std::abs(reference.workspaceFromObject.scale / reference.before.scale - 1.0);
    }
    const double change = glm::length(now.force - last_.force);
    const double depth = std::max(glm::distance(now.proxy, now.hip), glm::distance(last_.proxy, last_.hip));
    const double tilt = std::max(touching.tilt(), lastTouching_.tilt());
    // Along an interpolated normal that leans by tau, the way to the face is 1 / cos(tau) as long.
    const double steady =
        kStiffness * travel / std::cos(std::min(tilt, 1.5)) + grown * glm::length(last_.force);
    const bool other = !sameDirections(touching.normals, lastTouching_.normals);
    double turn = 0.0;
    if (other || change > steady + 1e-9) {
        // It may have gone round a corner: by Thales no farther from the chord than half of it.
        const double radius = effectiveRadius();
        turn = surface_.turnAlong(motions(), last_.proxy, now.proxy,
                                  1.01 * radius + 0.51 * glm::distance(last_.proxy, now.proxy), 2.0 * radius);
        turn = std::min(turn, largestAngle(touching.normals, lastTouching_.normals));
    }
    const bool shaded = tilt > 0.0 && !touching.felt.empty() && !lastTouching_.felt.empty();
    // On an edge, and where the rounds came to nothing in one of the two ticks, the force may lie anywhere
    // between what the faces feel like and what they are.
    const bool onEdge = std::max(touching.normals.size(), lastTouching_.normals.size()) > 1;
    const bool gaveUp = has(now.flags | last_.flags, TickFlag::ShadingNotConverged);
    const double felt =
        shaded ? largestAngle(touching.felt, lastTouching_.felt) + (onEdge || gaveUp ? tilt : 0.0) : 0.0;
    const double demanded = jumpOf(depth, turn) + jumpOf(depth, felt) + kStiffness * behind +
                            (tilt > 0.0 ? kStiffness * 2.0 * kShadedRounding * unit() : 0.0);
    // A stretch that is mu d long grows with the depth and slips from mu_s d to mu_d d. Where several planes
    // hold, or the proxy stood on another plane than now, that may stand in the way of what is kept, and all
    // of it goes.
    const HapticSettings& set = bench.settings;
    double slip = 0.0;
    if (set.friction != FrictionMode::Off) {
        const bool cornered = other || std::max(now.planeCount, last_.planeCount) > 1;
        const double kept = cornered ? 0.0 : set.dynamicFriction;
        slip = kStiffness *
               ((set.staticFriction - kept) * std::max(friction_, depth) + set.staticFriction * travel);
    }
    worsen(figures_.jump, {change - steady, demanded + slip + kStiffness * unit() * kForceRounding});
    if (holding_)
        figures_.jitter.measured = std::max(figures_.jitter.measured, change);

    const glm::dvec3 moved = now.hip - last_.hip;
    figures_.energy.measured += glm::dot(0.5 * (now.force + last_.force), moved);
    figures_.energy.allowed += (other ? kStiffness * travel * travel / 8.0 : 0.0) +
                               0.5 * (jumpOf(depth, turn) + slip + kStiffness * behind) * travel +
                               kStiffness * depth * std::sin(std::min(tilt, 1.5)) * travel;
}

assets::Shape smoothed(const assets::Shape& shape, double crease) {
    const auto corner = [&](size_t t, size_t k) {
        const glm::vec3& p = shape.positions[shape.indices[3 * t + k]];
        return std::tuple{p.x, p.y, p.z};
    };
    std::vector<glm::dvec3> areas;
    std::map<std::tuple<float, float, float>, std::vector<size_t>> at;
    for (size_t t = 0; t < shape.triangleCount(); ++t) {
        const uint32_t* i = &shape.indices[3 * t];
        const glm::dvec3 a(shape.positions[i[0]]), b(shape.positions[i[1]]), c(shape.positions[i[2]]);
        areas.push_back(glm::cross(b - a, c - a));
        for (size_t k = 0; k < 3; ++k)
            at[corner(t, k)].push_back(t);
    }
    assets::Shape result;
    for (size_t t = 0; t < shape.triangleCount(); ++t)
        for (size_t k = 0; k < 3; ++k) {
            glm::dvec3 sum(0.0);
            for (const size_t other : at[corner(t, k)])
                if (angleBetween(areas[t], areas[other]) < crease)
                    sum += areas[other];
            const double length = glm::length(sum);
            result.indices.push_back(static_cast<uint32_t>(result.positions.size()));
            result.positions.push_back(shape.positions[shape.indices[3 * t + k]]);
            result.normals.emplace_back(length > 0.0 ? sum / length : glm::dvec3(0, 1, 0));
        }
    return result;
}

Scene sceneFor(const assets::Shape& shape, const Variant& variant) {
    return sceneOf(variant.shaded ? smoothed(shape) : shape);
}

} // namespace touchstone::test
