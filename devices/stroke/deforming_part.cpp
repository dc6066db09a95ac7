#include "devices/stroke/deforming_part.h"

#include "devices/stroke/stroke_check.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <memory>
#include <utility>

namespace touchstone {

namespace {

constexpr double kAnchorWay = 0.002; ///< m of the path between two anchors, about
constexpr double kMostAnchors = 512;
/// s between samples of an anchor's motion: those between which the hand feels vertices move straight.
constexpr double kAnchorSample = 1.0 / 240.0;
constexpr double kMostAnchorSamples = 1e6; ///< of all anchors: 64 MB
constexpr double kPoses = 24.0;            ///< of a second
constexpr double kFewestPoses = 8.0;
constexpr double kMostPlaces = 2e6; ///< vertices in all poses of all parts, but for the fewest poses

/// The corners' weights of the projection of `p`, moved into the triangle: near the closest place of it.
glm::dvec3 weightsNear(const std::array<glm::dvec3, 3>& t, const glm::dvec3& p) {
    const glm::dvec3 ab = t[1] - t[0], ac = t[2] - t[0], n = glm::cross(ab, ac);
    const double squared = glm::dot(n, n);
    const double v = glm::dot(glm::cross(p - t[0], ac), n) / squared,
                 w = glm::dot(glm::cross(ab, p - t[0]), n) / squared;
    const glm::dvec3 inside = glm::max(glm::dvec3(1.0 - v - w, v, w), 0.0);
    return inside / (inside.x + inside.y + inside.z);
}

glm::dvec3 placeOn(const std::array<glm::dvec3, 3>& t, const glm::dvec3& weights) {
    return weights.x * t[0] + weights.y * t[1] + weights.z * t[2];
}

/// The axes of a triangle: an edge, across it, and the normal. Nullopt where it has no area.
std::optional<glm::dmat3> axesOf(const std::array<glm::dvec3, 3>& t) {
    const glm::dvec3 edge = t[1] - t[0], normal = glm::cross(edge, t[2] - t[0]);
    if (!(glm::length(normal) > 0.0))
        return std::nullopt;
    const glm::dvec3 x = glm::normalize(edge), z = glm::normalize(normal);
    return glm::dmat3(x, glm::cross(z, x), z);
}

/// 0 to count - 1, each time halving the gaps.
std::vector<size_t> farApart(size_t count) {
    std::vector<size_t> order;
    for (size_t step = std::bit_ceil(std::max<size_t>(count, 1)); step > 0; step /= 2)
        for (size_t i = 0; i < count; i += step)
            if (step == std::bit_ceil(count) || i % (2 * step) != 0)
                order.push_back(i);
    return order;
}

} // namespace

class DeformingPart::Poser {
  public:
    explicit Poser(const DeformingPart& part)
        : part_(part), pose_(part.scene_), vertices_(*part.mesh_.deformation) {}

    void evaluate(double time) {
        pose_.evaluate(part_.scene_, &part_.animation_, time);
        vertices_.pose(pose_);
    }
    [[nodiscard]] glm::dvec3 at(size_t vertex) const {
        const glm::dmat4& sceneFromMesh = pose_.sceneFromMesh()[part_.instance_];
        return part_.deviceFromScene_.point(
            glm::dvec3(sceneFromMesh * glm::dvec4(vertices_.position(part_.mesh_.sources[vertex]), 1.0)));
    }
    void placesInto(Places& places) const {
        for (size_t v = 0; v < places.size(); ++v)
            places[v] = at(v);
    }

  private:
    const DeformingPart& part_;
    ScenePose pose_;
    DeformedVertices vertices_;
};

DeformingPart::DeformingPart(const Scene& scene, const Animation& animation, size_t instance,
                             const Similarity& deviceFromScene, size_t parts)
    : scene_(scene), animation_(animation), instance_(instance), deviceFromScene_(deviceFromScene),
      mesh_(scene.meshes[static_cast<size_t>(scene.instances[instance].mesh)]) {
    const glm::dmat4& sceneFromMesh = scene.instances[instance].sceneFromMesh;
    if (!scene.materials.empty() &&
        scene.materials[static_cast<size_t>(mesh_.material)].haptic.sides == SideChoice::Front)
        front_ = glm::determinant(glm::dmat3(sceneFromMesh)) < 0.0 ? -1 : 1;
    for (const glm::vec3& p : mesh_.positions)
        rest_.push_back(deviceFromScene.point(glm::dvec3(sceneFromMesh * glm::dvec4(glm::dvec3(p), 1.0))));
    const double fit = std::floor(kMostPlaces / static_cast<double>((rest_.size() + 1) * parts));
    poses_ = static_cast<size_t>(std::clamp(std::ceil(animation.duration * kPoses), kFewestPoses,
                                            std::clamp(fit, kFewestPoses, static_cast<double>(kMostPoses))));
    // The vertices' boxes, widened by half of their way from the pose before and half of that to the next.
    Poser poser(*this);
    Places before(rest_.size()), now(rest_.size());
    for (size_t i = 0; i <= poses_; ++i) {
        poser.evaluate(timeOf(i));
        poser.placesInto(now);
        Bounds box;
        double way = 0.0;
        for (const uint32_t v : mesh_.indices) {
            box.include(now[v]);
            way = i > 0 ? std::max(way, glm::distance(now[v], before[v])) : 0.0;
        }
        for (Bounds* of : {i > 0 ? &boxes_.back() : nullptr, &box})
            if (of != nullptr && !box.empty()) {
                of->low -= 0.5 * way;
                of->high += 0.5 * way;
            }
        boxes_.push_back(box);
        std::swap(before, now);
    }
}

double DeformingPart::timeOf(size_t pose) const {
    return animation_.duration * static_cast<double>(pose) / static_cast<double>(poses_);
}

Bounds DeformingPart::boxAround(double share) const {
    const double at = std::clamp(share, 0.0, 1.0) * static_cast<double>(poses_);
    Bounds box = boxes_[static_cast<size_t>(std::floor(at))];
    const Bounds& next = boxes_[static_cast<size_t>(std::ceil(at))];
    box.include(next.low);
    box.include(next.high);
    return box;
}

/// Made when a path is first tried.
const std::vector<DeformingPart::Moment>& DeformingPart::moments() const {
    if (!moments_.empty())
        return moments_;
    Poser poser(*this);
    for (const size_t i : farApart(poses_)) {
        Moment& moment = moments_.emplace_back(Moment{timeOf(i), Places(rest_.size())});
        poser.evaluate(moment.time);
        poser.placesInto(moment.places);
    }
    return moments_;
}

TriangleSource DeformingPart::trianglesAt(const Places& places) const {
    return [this, &places](const TriangleVisitor& visit) {
        SurfaceTriangle triangle;
        triangle.object = static_cast<uint32_t>(instance_);
        triangle.front = front_;
        for (size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
            triangle.a = places[mesh_.indices[i]];
            triangle.b = places[mesh_.indices[i + 1]];
            triangle.c = places[mesh_.indices[i + 2]];
            visit(triangle);
        }
    };
}

/// At equal steps of the path's period: the nearest triangles at rest.
std::vector<DeformingPart::Anchor> DeformingPart::anchorsAlong(const StrokePath& path) const {
    constexpr int kSteps = 1024;
    double way = 0.0;
    for (int i = 0; i < kSteps; ++i)
        way += glm::distance(path.position(path.period() * i / kSteps),
                             path.position(path.period() * (i + 1) / kSteps));
    const double count = std::clamp(std::ceil(way / kAnchorWay), 1.0, kMostAnchors);
    std::vector<glm::dvec3> points;
    for (double i = 0.0; i < count; i += 1.0)
        points.push_back(path.position(path.period() * i / count));
    std::vector<Anchor> anchors(points.size());
    std::vector<double> nearest(points.size(), INFINITY);
    for (size_t i = 0; i + 2 < mesh_.indices.size(); i += 3) {
        const std::array<glm::dvec3, 3> t{rest_[mesh_.indices[i]], rest_[mesh_.indices[i + 1]],
                                          rest_[mesh_.indices[i + 2]]};
        if (!axesOf(t))
            continue;
        const glm::dvec3 middle = (t[0] + t[1] + t[2]) / 3.0;
        const double radius =
            std::max({glm::distance(middle, t[0]), glm::distance(middle, t[1]), glm::distance(middle, t[2])});
        for (size_t k = 0; k < points.size(); ++k) {
            const double least = glm::distance(points[k], middle) - radius;
            if (!(least < nearest[k]))
                continue;
            const glm::dvec3 weights = weightsNear(t, points[k]);
            const double distance = glm::distance(points[k], placeOn(t, weights));
            if (distance < nearest[k]) {
                nearest[k] = distance;
                anchors[k] = {i / 3, weights};
            }
        }
    }
    return anchors;
}

glm::dvec3 DeformingPart::placeOf(const Anchor& anchor, const Places& places) const {
    std::array<glm::dvec3, 3> corners;
    for (size_t k = 0; k < 3; ++k)
        corners[k] = places[mesh_.indices[3 * anchor.triangle + k]];
    return placeOn(corners, anchor.weights);
}

/// A triangle that turns over within a sample has passed through a line: its other side is where the hand
/// is.
Similarity DeformingPart::motionOf(const Anchor& anchor, const Places& places,
                                   const Similarity* before) const {
    std::array<glm::dvec3, 3> rest, now;
    for (size_t k = 0; k < 3; ++k) {
        const uint32_t v = mesh_.indices[3 * anchor.triangle + k];
        rest[k] = rest_[v];
        now[k] = places[v];
    }
    const std::optional<glm::dmat3> from = axesOf(rest);
    std::optional<glm::dmat3> to = axesOf(now);
    if (before != nullptr && from && to && glm::dot((*to)[2], before->rotation * (*from)[2]) < 0.0)
        to = glm::dmat3((*to)[0], -(*to)[1], -(*to)[2]);
    Similarity motion;
    if (from && to)
        motion.rotation = glm::normalize(glm::quat_cast(*to * glm::transpose(*from)));
    else if (before != nullptr)
        motion.rotation = before->rotation;
    motion.translation = placeOf(anchor, places) - motion.rotation * placeOf(anchor, rest_);
    return motion;
}

PathMotion DeformingPart::motionOf(std::span<const Anchor> anchors) const {
    const double most = std::max(1.0, std::floor(kMostAnchorSamples / static_cast<double>(anchors.size())));
    const double steps = std::clamp(std::ceil(animation_.duration / kAnchorSample), 1.0, most);
    std::vector<std::vector<Similarity>> samples(anchors.size());
    Poser poser(*this);
    Places places = rest_;
    for (double i = 0.0; i <= steps; i += 1.0) {
        poser.evaluate(animation_.duration * i / steps);
        for (size_t k = 0; k < anchors.size(); ++k) {
            for (size_t corner = 0; corner < 3; ++corner) {
                const uint32_t v = mesh_.indices[3 * anchors[k].triangle + corner];
                places[v] = poser.at(v);
            }
            samples[k].push_back(
                motionOf(anchors[k], places, samples[k].empty() ? nullptr : &samples[k].back()));
        }
    }
    std::vector<PartMotion> parts;
    for (std::vector<Similarity>& of : samples)
        parts.emplace_back(std::move(of), animation_.duration);
    return PathMotion(std::move(parts));
}

/// In the air a surface that has passed through the hand lies between it and its anchor. Where the animation
/// starts again at another place (`last`: where the hand was), so does one that the hand jumps through; in
/// contact the hand must not jump at all.
bool DeformingPart::isFreeAt(const Moment& moment, const StrokePath& path, std::span<const Anchor> anchors,
                             double depth, const StrokePath* last) const {
    constexpr double kJump = 0.5;  // of the depth
    std::vector<glm::dvec3> lines; // from and to
    double longest = 0.0;
    const auto add = [&](const glm::dvec3& from, const glm::dvec3& to) {
        lines.insert(lines.end(), {from, to});
        longest = std::max(longest, glm::distance(from, to));
    };
    for (size_t k = 0; k < anchors.size(); ++k) {
        const double time = path.period() * static_cast<double>(k) / static_cast<double>(anchors.size());
        const glm::dvec3 hand = path.position(time), foot = placeOf(anchors[k], moment.places);
        const bool air = glm::distance(hand, foot) > kDepthFactor * depth;
        if (air)
            add(hand, glm::mix(foot, hand, 1e-3)); // not on the anchor's own triangle
        if (last != nullptr && air)
            add(last->position(time), hand);
        if (last != nullptr && !air && glm::distance(last->position(time), hand) > kJump * depth)
            return false;
    }
    const NearTriangles near(trianglesAt(moment.places), lines, longest);
    for (size_t i = 0; i + 1 < lines.size(); i += 2)
        if (!isFree(near, lines[i], lines[i + 1]))
            return false;
    return true;
}

std::optional<StrokePath> DeformingPart::carried(const StrokePath& laid, double depth,
                                                 std::span<const Bounds> keepOut, bool mayJump) const {
    const std::vector<Anchor> anchors = anchorsAlong(laid);
    const auto motion = std::make_shared<const PathMotion>(motionOf(anchors));
    const auto pathAt = [&](double time) {
        return laid.moved(
            [&](double share, const glm::dvec3& place) { return motion->at(share, time, place); });
    };
    const StrokePath last = pathAt(animation_.duration * (1.0 - 1e-9));
    for (const Moment& moment : moments()) {
        const StrokePath path = pathAt(moment.time);
        const TriangleSource triangles = trianglesAt(moment.places);
        const glm::dvec3 start = path.position(0.0), up = start - placeOf(anchors[0], moment.places);
        const bool again = moment.time == 0.0 && !mayJump;
        if (!strokeHolds(triangles, path, depth, keepOut) ||
            !isFreeAt(moment, path, anchors, depth, again ? &last : nullptr) ||
            maybeInside(triangles, start, glm::length(up) > 0.0 ? glm::normalize(up) : up))
            return std::nullopt;
    }
    return laid.carriedBy(motion);
}

} // namespace touchstone
