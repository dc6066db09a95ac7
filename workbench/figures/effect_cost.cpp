#include "workbench/figures/effect_cost.h"

#include "engine/core/float_mode.h"
#include "engine/time/samples.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/tick/stepped_hand.h"

#include <algorithm>
#include <array>

namespace touchstone {

namespace {

constexpr double kServoTick = 1e-3;            // s
constexpr double kStep = 1e-4;                 // m, 0.1 m/s
constexpr double kAbove = 2e-3, kBelow = 1e-3; // m
constexpr size_t kSpots = 16;                  // number of stroked triangles
constexpr int kTicksAtSpot = 150;

/// A triangle to stroke.
struct StrokeSpot {
    size_t object = 0;
    uint32_t triangle = 0;
    double area = 0.0; ///< m², workspace
};

std::vector<StrokeSpot> largestTriangles(const HapticScene& scene, int material) {
    std::vector<StrokeSpot> spots;
    const auto larger = [](const StrokeSpot& a, const StrokeSpot& b) { return a.area > b.area; };
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const HapticObject& object = *scene.objects[k];
        if (object.material != material)
            continue;
        const double scale = object.workspaceFromObject.scale;
        for (uint32_t t = 0; t < object.triangleCount(); ++t) {
            const Triangle triangle = triangleOf(object, t);
            const double area = 0.5 * scale * scale *
                                glm::length(glm::cross(triangle.b - triangle.a, triangle.c - triangle.a));
            if (spots.size() == kSpots && area <= spots.back().area)
                continue;
            const StrokeSpot spot{k, t, area};
            spots.insert(std::upper_bound(spots.begin(), spots.end(), spot, larger), spot);
            if (spots.size() > kSpots)
                spots.pop_back();
        }
    }
    return spots;
}

/// Down onto the triangle's centroid and from there towards its corners in turn.
glm::dvec3 handAt(const HapticScene& scene, const StrokeSpot& spot, int tick) {
    const HapticObject& object = *scene.objects[spot.object];
    const Triangle triangle = triangleOf(object, spot.triangle);
    const Similarity& place = object.workspaceFromObject;
    const glm::dvec3 middle = place.point((triangle.a + triangle.b + triangle.c) / 3.0);
    const glm::dvec3 normal = place.direction(triangle.normal);
    const double height = std::max(kAbove - kStep * tick, -kBelow);
    const double along = std::max(0.0, kStep * tick - (kAbove + kBelow));
    const std::array corners{place.point(triangle.a), place.point(triangle.b), place.point(triangle.c)};
    glm::dvec3 from = middle;
    double left = along;
    for (size_t i = 0; i < 64; ++i) {
        const glm::dvec3 leg = corners[i % 3] - from;
        const double length = glm::length(leg);
        if (left <= length)
            return from + (length > 0.0 ? left / length : 0.0) * leg + height * normal;
        left -= length;
        from = corners[i % 3];
    }
    return from + height * normal;
}

/// One configuration of the scene, timed tick by tick.
struct Touch {
    SteppedHand hand;
    int64_t nanoseconds = 0;

    void step(const glm::dvec3& position) {
        const DeviceSample sample = sampleAt(position);
        NoStopwatch none;
        const long long begin = monotonicNs();
        (void)hand.step(HapticSettings{}, sample, kServoTick, none);
        nanoseconds = monotonicNs() - begin;
    }
};

EffectCost costOf(const HapticScene& scene, const HapticScene& without, int material,
                  const std::vector<StrokeSpot>& spots, int64_t longestNs) {
    Touch with{SteppedHand(scene)}, plain{SteppedHand(without)};
    Samples withTimes, plainTimes;
    uint64_t tick = 0;
    int64_t spent = 0;
    for (const StrokeSpot& spot : spots) {
        with.hand.state.forgetTouch();
        plain.hand.state.forgetTouch();
        for (int i = 0; i < kTicksAtSpot && spent < longestNs; ++i, ++tick) {
            const glm::dvec3 hand = handAt(scene, spot, i);
            // The first one finds colder caches.
            Touch& first = tick % 2 == 0 ? with : plain;
            Touch& second = tick % 2 == 0 ? plain : with;
            first.step(hand);
            second.step(hand);
            spent += with.nanoseconds + plain.nanoseconds;
            const int object = with.hand.output.object;
            if (with.hand.output.contacts == 0 || plain.hand.output.contacts == 0 || object < 0 ||
                scene.objects[static_cast<size_t>(object)]->material != material)
                continue;
            withTimes.add(with.nanoseconds);
            plainTimes.add(plain.nanoseconds);
        }
    }
    constexpr size_t kFewest = 50;
    EffectCost cost;
    cost.ticks = withTimes.count();
    if (cost.ticks >= kFewest)
        cost.nanoseconds = withTimes.percentile(0.5) - plainTimes.percentile(0.5);
    return cost;
}

} // namespace

std::vector<EffectCost> effectCosts(const HapticScene& scene, int64_t longestNs) {
    enterFloatMode();
    std::vector<EffectCost> costs(scene.plan.effects.size());
    std::shared_ptr<HapticScene> without;
    std::vector<StrokeSpot> spots;
    int strokedMaterial = -1;
    const auto toMeasure =
        std::ranges::count_if(scene.plan.effects, [](const PlannedEffect& effect) { return effect.on; });
    for (size_t i = 0; i < costs.size(); ++i) {
        const PlannedEffect& effect = scene.plan.effects[i];
        if (!effect.on) {
            costs[i].nanoseconds = 0;
            continue;
        }
        if (without == nullptr)
            without = copyOf(scene);
        if (effect.material != strokedMaterial) {
            strokedMaterial = effect.material;
            spots = largestTriangles(scene, effect.material);
        }
        HapticMaterialData& material = without->materials[static_cast<size_t>(effect.material)];
        const HapticMaterialData kept = material;
        removeEffect(*without, effect.material, effect.effect);
        costs[i] = costOf(scene, *without, effect.material, spots, longestNs / toMeasure);
        material = kept;
        without->objects = scene.objects;
    }
    return costs;
}

} // namespace touchstone
