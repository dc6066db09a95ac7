#include "devices/stroke/scene_motion.h"

#include "devices/stroke/stroke_place.h"
#include "devices/surface/surface_probe.h"
#include "engine/math/nearest_similarity.h"
#include "engine/scene/animation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kMaxParts = 8;
constexpr double kSampleTime = 1e-3; ///< s; at 10 m/s² the error of a chord is 1 µm
constexpr double kMaxSamples = 20000.0;
constexpr int kSide = 24; ///< rays per side of the view that measure visibility
/// Poses of the other parts that are boxed; where one deforms at least as many as it may have boxes for.
constexpr size_t kFewestBoxes = 16, kBoxes = 256;

/// By node: the lowest one at or above it that the animation moves itself; -1: none.
std::vector<int> moversOf(const Scene& scene, const Animation& animation) {
    std::vector<int> movers(scene.nodes.size(), -1);
    for (const AnimationChannel& channel : animation.channels)
        movers[static_cast<size_t>(channel.node)] = channel.node;
    // Parents come first.
    for (size_t n = 0; n < movers.size(); ++n)
        if (const int parent = scene.nodes[n].parent; movers[n] < 0 && parent >= 0)
            movers[n] = movers[static_cast<size_t>(parent)];
    return movers;
}

/// Motion of an instance relative to its static pose, device frame; the identity for a singular or mirrored
/// transform.
Similarity motionOf(const glm::dmat4& deviceFromScene, const glm::dmat4& now, const glm::dmat4& rest) {
    Similarity motion;
    const double volume = glm::determinant(glm::dmat3(rest));
    if (volume != 0.0 && std::isfinite(volume))
        nearestSimilarity(deviceFromScene * now * glm::inverse(rest) * glm::inverse(deviceFromScene), motion);
    return motion;
}

class Movement {
  public:
    Movement(const Scene& scene, const Animation& animation, const Similarity& deviceFromScene)
        : scene_(scene), animation_(animation), deviceFromScene_(matrixOf(deviceFromScene)), pose_(scene),
          rest_(pose_.sceneFromMesh().begin(), pose_.sceneFromMesh().end()) {}

    void evaluate(double time) { pose_.evaluate(scene_, &animation_, time); }
    [[nodiscard]] Similarity of(size_t instance) const {
        return motionOf(deviceFromScene_, pose_.sceneFromMesh()[instance], rest_[instance]);
    }
    std::shared_ptr<const PathMotion> over(size_t instance) {
        const double steps = std::clamp(std::ceil(animation_.duration / kSampleTime), 1.0, kMaxSamples);
        std::vector<Similarity> samples;
        for (double i = 0.0; i <= steps; i += 1.0) {
            evaluate(animation_.duration * i / steps);
            samples.push_back(of(instance));
        }
        return std::make_shared<const PathMotion>(
            std::vector{PartMotion(std::move(samples), animation_.duration)});
    }

  private:
    const Scene& scene_;
    const Animation& animation_;
    glm::dmat4 deviceFromScene_;
    ScenePose pose_;
    std::vector<glm::dmat4> rest_;
};

/// The box of the moved `rest`, with half of the displacement of its corners since the previous pose.
void sweep(Bounds& swept, const Bounds& rest, const Similarity& before, const Similarity& now) {
    for (int corner = 0; corner < 8; ++corner) {
        const glm::dvec3 p(corner & 1 ? rest.low.x : rest.high.x, corner & 2 ? rest.low.y : rest.high.y,
                           corner & 4 ? rest.low.z : rest.high.z);
        const glm::dvec3 at = now.point(p);
        const double moved = 0.5 * glm::distance(at, before.point(p));
        swept.include(at - moved);
        swept.include(at + moved);
    }
}

std::vector<Bounds> boxesOf(const TriangleSource& triangles, size_t instances) {
    std::vector<Bounds> boxes(instances);
    triangles([&](const SurfaceTriangle& t) {
        for (const glm::dvec3& p : {t.a, t.b, t.c})
            boxes[t.object].include(p);
    });
    return boxes;
}

using DeformingParts = std::vector<std::shared_ptr<const DeformingPart>>; ///< by instance; null: it is rigid

DeformingParts deformingParts(const Scene& scene, const Animation& animation,
                              const Similarity& deviceFromScene) {
    const std::vector<bool> moved = movedNodes(scene, animation);
    std::vector<size_t> deforming; // instances
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const MeshDeformation* const deformation =
            scene.meshes[static_cast<size_t>(scene.instances[i].mesh)].deformation.get();
        if (deformation != nullptr && deformation->drivenBy(animation, moved))
            deforming.push_back(i);
    }
    DeformingParts parts(scene.instances.size());
    for (const size_t i : deforming)
        parts[i] =
            std::make_shared<const DeformingPart>(scene, animation, i, deviceFromScene, deforming.size());
    return parts;
}

/// `first` is one of the part's instances.
std::vector<Bounds> keptOut(Movement& movement, double duration, std::span<const Bounds> boxes,
                            const DeformingParts& deforming, const MovingPart& part, size_t first) {
    const size_t count = boxes.size();
    const bool anyDeforms = std::ranges::any_of(deforming, [](const auto& of) { return of != nullptr; });
    const size_t poses = std::clamp<size_t>(200000 / std::max<size_t>(count, 1),
                                            anyDeforms ? DeformingPart::kMostPoses : kFewestBoxes, kBoxes);
    std::vector<Bounds> swept(count);
    std::vector<Similarity> before(count);
    for (size_t k = 0; k <= poses; ++k) {
        movement.evaluate(duration * static_cast<double>(k) / static_cast<double>(poses));
        // A path on a part that deforms is checked where the animation has it.
        const Similarity carrier = part.deforming != nullptr ? Similarity{} : movement.of(first);
        for (size_t i = 0; i < count; ++i) {
            if (part.instances[i] || boxes[i].empty())
                continue;
            const bool deforms = deforming[i] != nullptr;
            const Similarity now = deforms ? carrier.inverse() : carrier.inverseTimes(movement.of(i));
            const double share = static_cast<double>(k) / static_cast<double>(poses);
            sweep(swept[i], deforms ? deforming[i]->boxAround(share) : boxes[i], k == 0 ? now : before[i],
                  now);
            before[i] = now;
        }
    }
    std::erase_if(swept, [](const Bounds& box) { return box.empty(); });
    return swept;
}

/// By instance: number of rays from the viewer that hit it first; many more for the one at the given place.
std::vector<size_t> showing(const TriangleSource& triangles, std::span<const Bounds> boxes,
                            const StrokeRequest& request) {
    std::vector<size_t> counts(boxes.size(), 0);
    Bounds all;
    for (const Bounds& box : boxes)
        if (!box.empty()) {
            all.include(box.low);
            all.include(box.high);
        }
    const double length = glm::length(request.front);
    const ProbeView view =
        viewOf(all, length > 0.0 && std::isfinite(length) ? request.front / length : glm::dvec3(0, 0, 1));
    std::vector<glm::dvec2> points;
    for (int i = 0; i < kSide * kSide; ++i)
        points.push_back(
            glm::dvec2((i % kSide + 0.5) / kSide * 2.0 - 1.0, (i / kSide + 0.5) / kSide * 2.0 - 1.0) *
            glm::dvec2(view.half));
    for (const auto& hit : probe(triangles, view, points))
        if (hit)
            ++counts[hit->object];
    if (request.place)
        if (const auto hit = hitAt(triangles, *request.place))
            counts[hit->object] += 2 * points.size();
    return counts;
}

} // namespace

std::vector<MovingPart> movingParts(const Scene& scene, const Similarity& deviceFromScene,
                                    const StrokeRequest& request) {
    const Animation* animation = playedAnimation(scene);
    if (animation == nullptr)
        return {};
    const std::vector<int> movers = moversOf(scene, *animation);
    const DeformingParts deforming = deformingParts(scene, *animation, deviceFromScene);
    // Instances under the same moved node move as one; one that deforms is a part of its own.
    std::map<int, std::vector<size_t>> byMover;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        const bool follows = instance.followsNode && instance.node >= 0;
        byMover[deforming[i] != nullptr ? -2 - static_cast<int>(i)
                : follows               ? movers[static_cast<size_t>(instance.node)]
                                        : -1]
            .push_back(i);
    }
    if (byMover.empty() || (byMover.size() == 1 && byMover.begin()->first == -1))
        return {};
    const TriangleSource triangles = trianglesOf(scene, deviceFromScene);
    const std::vector<Bounds> boxes = boxesOf(triangles, scene.instances.size());
    const std::vector<size_t> counts = showing(triangles, boxes, request);
    std::vector<std::pair<size_t, int>> order; // rays, mover
    for (const auto& [mover, instances] : byMover) {
        size_t rays = 0;
        for (const size_t i : instances)
            rays += counts[i];
        if (std::ranges::any_of(instances, [&](size_t i) { return !boxes[i].empty(); }))
            order.emplace_back(rays, mover);
    }
    std::ranges::stable_sort(order, std::greater{}, [](const auto& entry) { return entry.first; });
    order.resize(std::min(order.size(), kMaxParts));
    Movement movement(scene, *animation, deviceFromScene);
    std::vector<MovingPart> parts;
    for (const auto& [rays, mover] : order) {
        MovingPart& part = parts.emplace_back();
        part.instances.assign(scene.instances.size(), false);
        for (const size_t i : byMover[mover])
            part.instances[i] = true;
        const size_t first = byMover[mover].front();
        part.deforming = deforming[first];
        if (mover >= 0)
            part.motion = movement.over(first);
        part.keepOut = keptOut(movement, animation->duration, boxes, deforming, part, first);
    }
    return parts;
}

TriangleSource trianglesOf(TriangleSource triangles, const MovingPart& part) {
    return [triangles = std::move(triangles), &part](const TriangleVisitor& visit) {
        triangles([&](const SurfaceTriangle& t) {
            if (part.instances[t.object])
                visit(t);
        });
    };
}

} // namespace touchstone
