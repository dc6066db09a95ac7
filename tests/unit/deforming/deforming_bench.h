#pragma once
// A hand on deforming objects, checked in every tick against their interpolated vertices in long double.

#include "engine/load/scene_loader.h"
#include "engine/scene/mesh_deformation.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/tick/stepped_hand.h"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <functional>
#include <numbers>
#include <string>

namespace touchstone::test {

using LVec3 = glm::vec<3, long double>;

/// A mesh of triangles that two morph targets may move: weights over time, in linear keys. Scene metres.
struct MorphCase {
    std::vector<glm::vec3> positions;
    std::vector<uint32_t> indices;
    std::vector<std::vector<glm::vec3>> targets; ///< displacements
    std::vector<float> times, weights;           ///< `targets` weights a key
};

inline Scene sceneOfMorph(const MorphCase& made) {
    Scene scene;
    scene.materials.emplace_back();
    scene.nodes.emplace_back();
    auto deformation = std::make_shared<MeshDeformation>();
    deformation->positions = made.positions;
    for (const auto& target : made.targets)
        deformation->targets.push_back({target, {}});
    deformation->weights.assign(made.targets.size(), 0.0);
    deformation->weightsNode = 0;
    Mesh& mesh = scene.meshes.emplace_back();
    mesh.name = "morph";
    mesh.positions = made.positions;
    mesh.indices = made.indices;
    mesh.normals.assign(made.positions.size(), glm::vec3(0, 1, 0));
    for (uint32_t v = 0; v < made.positions.size(); ++v)
        mesh.sources.push_back(v);
    mesh.deformation = deformation;
    scene.instances.push_back({.node = 0, .mesh = 0});
    Animation& animation = scene.animations.emplace_back();
    animation.duration = static_cast<double>(made.times.back());
    AnimationChannel& channel = animation.channels.emplace_back();
    channel.node = 0;
    channel.path = AnimatedPath::Weights;
    channel.times = made.times;
    channel.targets = made.targets.size();
    channel.weights = made.weights;
    for (const glm::vec3& p : made.positions)
        scene.bounds.include(glm::dvec3(p));
    return scene;
}

/// The triangles of an object as a tick has them, by a blend of their own.
inline std::array<LVec3, 3> triangleNow(const HapticObject& object, size_t t) {
    std::array<LVec3, 3> corners;
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = object.indices[3 * t + k];
        if (object.instant == nullptr) {
            corners[k] = LVec3(object.vertices[v]);
            continue;
        }
        const VertexBlend& blend = object.instant->now;
        const LVec3 from(blend.from[v]), to(blend.to[v]);
        corners[k] = from + static_cast<long double>(blend.fraction) * (to - from);
    }
    return corners;
}

inline long double distanceFrom(const std::array<LVec3, 3>& t, const LVec3& p) {
    const LVec3 n = glm::cross(t[1] - t[0], t[2] - t[0]);
    const long double area2 = glm::dot(n, n);
    bool inside = area2 > 0;
    long double least = INFINITY;
    for (size_t k = 0; k < 3; ++k) {
        const LVec3 &a = t[k], &b = t[(k + 1) % 3], edge = b - a;
        inside = inside && glm::dot(glm::cross(edge, p - a), n) > 0;
        const long double length2 = glm::dot(edge, edge);
        const long double s = length2 > 0 ? std::clamp(glm::dot(p - a, edge) / length2, 0.0L, 1.0L) : 0.0L;
        least = std::min(least, glm::length(p - (a + s * edge)));
    }
    return inside ? std::abs(glm::dot(p - t[0], n)) / std::sqrt(area2) : least;
}

/// How often the surface winds around a point: 1 inside of a closed one, 0 outside (van Oosterom, Strackee).
inline long double windingNumber(const HapticObject& object, const LVec3& p) {
    long double sum = 0;
    for (size_t t = 0; t < object.triangleCount(); ++t) {
        auto [a, b, c] = triangleNow(object, t);
        a -= p;
        b -= p;
        c -= p;
        const long double la = glm::length(a), lb = glm::length(b), lc = glm::length(c);
        sum += 2 * std::atan2(glm::dot(a, glm::cross(b, c)),
                              la * lb * lc + glm::dot(a, b) * lc + glm::dot(b, c) * la + glm::dot(c, a) * lb);
    }
    return sum / (4 * std::numbers::pi_v<long double>);
}

/// Counts and worst cases over the ticks of a hand.
struct DeformingReport {
    size_t ticks = 0, contacts = 0, jams = 0, starts = 0;
    long double deepest = -INFINITY; ///< below the clearance that the proxy should keep, object units
    long double winding = 0;         ///< largest number of windings around a proxy that is placed
    double overCone =
        -INFINITY; ///< N, of the friction over mu N; force shading has another frictionless place
    double largestForce = 0.0, overLimit = 0.0; ///< N
    double work = 0.0;                          ///< J, of the command on the hand's motion
};

/// With a given proxy and coefficient of friction.
inline HapticSettings touchedWith(double radius, double friction) {
    HapticSettings settings;
    settings.proxyRadius = radius;
    settings.staticFriction = settings.dynamicFriction = friction;
    if (friction > 0.0)
        settings.forceShading = ShadingMode::Off; // the cone is about the true normal
    return settings;
}

class DeformingBench {
  public:
    DeformingBench(Scene made, const HapticSettings& wanted)
        : DeformingBench(std::make_shared<const Scene>(std::move(made)), wanted) {}
    DeformingBench(ScenePtr made, const HapticSettings& wanted)
        : settings(wanted), source(std::move(made)),
          haptic(compileHapticScene(*source, workspaceFromScene(*source, Fit::Workspace),
                                    {.rays = false, .progress = {}})),
          hand(*haptic, source) {}

    /// A tick at `time` with the hand at `hip`; checks it.
    const HapticOutput& tick(const glm::dvec3& hip, double time, double dt = 1e-3) {
        const bool wasPlaced = hand.state.placed;
        const HapticOutput& output = hand.tick(settings, sampleAt(hip), time, dt);
        check(output);
        report.starts += !wasPlaced && hand.state.placed ? 1 : 0;
        return output;
    }

    HapticSettings settings;
    ScenePtr source;
    std::shared_ptr<const HapticScene> haptic;
    SteppedHand hand;
    DeformingReport report;
    bool closed = true; ///< of the objects: then no proxy may be inside

  private:
    void check(const HapticOutput& output) {
        ++report.ticks;
        report.jams += has(output.flags, TickFlag::Jammed) ? 1 : 0;
        report.largestForce = std::max(report.largestForce, glm::length(output.force));
        report.overLimit =
            std::max(report.overLimit, glm::length(output.command.force()) - DeviceLimits{}.maxForce);
        if (!hand.state.placed)
            return;
        const HapticScene& scene = hand.world.touched(*haptic);
        const ObjectMotions motions =
            hand.world.poses().empty() ? ObjectMotions(scene.restMotions) : hand.world.poses();
        // The least that it may be: half of a weld tolerance of the reference object, whichever that was.
        double radius = INFINITY;
        for (size_t k = 0; k < scene.objects.size(); ++k)
            radius = std::min(radius, 0.5 * kWeldTolerance * scene.objects[k]->diagonal *
                                          motions[k].workspaceFromObject.scale);
        radius = std::max(radius, feltRadius(settings));
        for (size_t k = 0; k < scene.objects.size(); ++k) {
            const HapticObject& object = *scene.objects[k];
            const Similarity& pose = motions[k].workspaceFromObject;
            const LVec3 proxy(pose.inversePoint(output.proxy));
            const auto reach = static_cast<long double>(radius / pose.scale);
            long double nearest = INFINITY;
            for (size_t t = 0; t < object.triangleCount(); ++t) {
                const Triangle roughly = triangleOf(object, static_cast<uint32_t>(t));
                const glm::dvec3 offset = roughly.a - glm::dvec3(proxy);
                const double size =
                    std::max(glm::length(roughly.b - roughly.a), glm::length(roughly.c - roughly.a));
                if (static_cast<long double>(glm::length(offset) - 1.001 * size - 1e-6) > nearest)
                    continue;
                nearest = std::min(nearest, distanceFrom(triangleNow(object, t), proxy));
            }
            report.deepest = std::max(report.deepest, reach - nearest);
            if (closed && report.ticks % 8 == 0)
                report.winding = std::max(report.winding, std::abs(windingNumber(object, proxy)));
        }
        if (output.contacts == 0)
            return;
        ++report.contacts;
        // The cone stands where the proxy would be without friction [001 4.1.1]; without friction it is a
        // line.
        constexpr double kStiffness = 600.0; // N/m, of a material that states none
        const DeviceState& state = hand.state;
        const bool held = output.friction != FrictionState::Free;
        const glm::dvec3 free =
            held ? motions[static_cast<size_t>(state.reference)].workspaceFromObject.point(state.frictionless)
                 : output.proxy;
        const double friction = glm::length(output.force - kStiffness * (free - output.hip));
        const double load = kStiffness * glm::length(free - output.hip);
        if (!state.shaded && output.planeCount <= 1) // of several planes the loads add up
            report.overCone =
                std::max(report.overCone, friction - std::max(settings.staticFriction, 0.0) * load);
    }
};

inline void expectExact(const DeformingReport& report, const std::string& what) {
    EXPECT_LT(report.deepest, 2e-12L) << what;
    EXPECT_LT(report.winding, 0.1L) << what;
    EXPECT_LT(report.overCone, 1e-6) << what;
    EXPECT_LE(report.overLimit, 1e-9) << what;
    std::printf(
        "%-44s %6zu ticks, %6zu in contact, %2zu jams, clearance %+.1Le, cone %+.1e N, force to %.2f N\n",
        what.c_str(), report.ticks, report.contacts, report.jams, -report.deepest, report.overCone,
        report.largestForce);
}

} // namespace touchstone::test
