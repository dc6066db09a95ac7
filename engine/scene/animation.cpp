#include "engine/scene/animation.h"

#include "engine/scene/mesh_deformation.h"

#include <glm/gtc/matrix_transform.hpp>

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

glm::dmat4 compose(const glm::dvec3& translation, const glm::dquat& rotation,
                   const glm::dvec3& scale) noexcept {
    glm::dmat4 m = glm::mat4_cast(rotation);
    m[0] *= scale.x;
    m[1] *= scale.y;
    m[2] *= scale.z;
    m[3] = glm::dvec4(translation, 1.0);
    return m;
}

glm::dvec4 unit(const glm::dvec4& q) noexcept {
    const double length = glm::length(q);
    return length > 0.0 ? q / length : glm::dvec4(0.0, 0.0, 0.0, 1.0);
}

// Appendix C.4: a = acos |q0 . q1|, the sign of the dot product selects the short arc.
glm::dvec4 slerp(const glm::dvec4& from, const glm::dvec4& to, double t) noexcept {
    const double dot = glm::dot(from, to);
    const double angle = std::acos(std::min(std::abs(dot), 1.0));
    const double sine = std::sin(angle);
    // Below 1e-6 rad the chord and the arc differ by 1e-18 of their length.
    if (sine < 1e-6)
        return unit(glm::mix(from, dot < 0.0 ? -to : to, t));
    return unit((std::sin(angle * (1.0 - t)) * from + (dot < 0.0 ? -1.0 : 1.0) * std::sin(angle * t) * to) /
                sine);
}

} // namespace

namespace {

/// Where a time lies among a channel's keys: between two, or at one where it lies before or behind all.
struct KeySpan {
    size_t last = 0, next = 0;
    double t = 0.0, seconds = 0.0; // fraction and length of the span
};

KeySpan keysAt(const AnimationChannel& channel, double time) noexcept {
    const std::vector<float>& times = channel.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < static_cast<double>(key); });
    if (after == times.begin())
        return {};
    const size_t next = static_cast<size_t>(after - times.begin()), last = next - 1;
    if (after == times.end())
        return {last, last, 0.0, 0.0};
    const double begin = times[last], seconds = static_cast<double>(times[next]) - begin;
    return {last, next, (time - begin) / seconds, seconds};
}

/// Appendix C.5: cubic Hermite with tangents per second, scaled by the key interval.
template <class T>
T hermite(const KeySpan& at, const T& from, const T& out, const T& in, const T& to) noexcept {
    const double t = at.t, t2 = t * t, t3 = t2 * t;
    return (2.0 * t3 - 3.0 * t2 + 1.0) * from + (t3 - 2.0 * t2 + t) * (at.seconds * out) +
           (-2.0 * t3 + 3.0 * t2) * to + (t3 - t2) * (at.seconds * in);
}

} // namespace

glm::dvec4 sampleChannel(const AnimationChannel& channel, double time) noexcept {
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const bool rotation = channel.path == AnimatedPath::Rotation;
    const auto value = [&](size_t key) { return glm::dvec4(channel.values[cubic ? 3 * key + 1 : key]); };
    const auto finished = [&](const glm::dvec4& v) { return rotation ? unit(v) : v; };
    const KeySpan at = keysAt(channel, time);
    if (at.last == at.next || channel.interpolation == Interpolation::Step)
        return finished(value(at.last));
    if (!cubic)
        return rotation ? slerp(unit(value(at.last)), unit(value(at.next)), at.t)
                        : glm::mix(value(at.last), value(at.next), at.t);
    return finished(hermite(at, value(at.last), glm::dvec4(channel.values[3 * at.last + 2]),
                            glm::dvec4(channel.values[3 * at.next]), value(at.next)));
}

double sampleWeight(const AnimationChannel& channel, size_t target, double time) noexcept {
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const auto number = [&](size_t value) {
        return static_cast<double>(channel.weights[value * channel.targets + target]);
    };
    const auto value = [&](size_t key) { return number(cubic ? 3 * key + 1 : key); };
    const KeySpan at = keysAt(channel, time);
    if (at.last == at.next || channel.interpolation == Interpolation::Step)
        return value(at.last);
    if (!cubic)
        return glm::mix(value(at.last), value(at.next), at.t);
    return hermite(at, value(at.last), number(3 * at.last + 2), number(3 * at.next), value(at.next));
}

glm::dmat4 parentFromNode(const Node& node) noexcept {
    return node.hasMatrix ? node.matrix : compose(node.translation, node.rotation, node.scale);
}

std::vector<glm::dmat4> sceneFromNodes(const std::vector<Node>& nodes) {
    std::vector<glm::dmat4> sceneFromNode(nodes.size());
    for (size_t n = 0; n < nodes.size(); ++n) {
        const glm::dmat4 local = parentFromNode(nodes[n]);
        sceneFromNode[n] =
            nodes[n].parent >= 0 ? sceneFromNode[static_cast<size_t>(nodes[n].parent)] * local : local;
    }
    return sceneFromNode;
}

ScenePose::ScenePose(const Scene& scene)
    : local_(scene.nodes.size()), sceneFromNode_(scene.nodes.size()), sceneFromMesh_(scene.instances.size()) {
    for (const Animation& animation : scene.animations)
        for (const AnimationChannel& channel : animation.channels) {
            const bool known = std::ranges::any_of(
                nodeWeights_, [&](const NodeWeights& own) { return own.node == channel.node; });
            if (channel.path != AnimatedPath::Weights || known)
                continue;
            nodeWeights_.push_back({channel.node, weights_.size(), channel.targets, false});
            weights_.resize(weights_.size() + channel.targets);
        }
    evaluate(scene, nullptr, 0.0);
}

std::span<const double> ScenePose::weightsOf(int node) const noexcept {
    for (const NodeWeights& own : nodeWeights_)
        if (own.node == node && own.driven)
            return std::span(weights_).subspan(own.first, own.count);
    return {};
}

void ScenePose::evaluate(const Scene& scene, const Animation* animation, double time) noexcept {
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        local_[i] = {scene.nodes[i].translation, scene.nodes[i].scale, scene.nodes[i].rotation};
    for (NodeWeights& own : nodeWeights_)
        own.driven = false;
    if (animation != nullptr)
        for (const AnimationChannel& channel : animation->channels) {
            if (channel.path == AnimatedPath::Weights) {
                for (NodeWeights& own : nodeWeights_)
                    if (own.node == channel.node) {
                        own.driven = true;
                        for (size_t t = 0; t < own.count; ++t)
                            weights_[own.first + t] = sampleWeight(channel, t, time);
                    }
                continue;
            }
            const glm::dvec4 value = sampleChannel(channel, time);
            LocalPose& local = local_[static_cast<size_t>(channel.node)];
            switch (channel.path) {
            case AnimatedPath::Translation:
                local.translation = glm::dvec3(value);
                break;
            case AnimatedPath::Scale:
                local.scale = glm::dvec3(value);
                break;
            case AnimatedPath::Rotation:
                local.rotation = glm::dquat(value.w, value.x, value.y, value.z);
                break;
            case AnimatedPath::Weights:
                break;
            }
        }
    // Parents precede children, so one pass composes them all.
    for (size_t i = 0; i < scene.nodes.size(); ++i) {
        const Node& node = scene.nodes[i];
        const glm::dmat4 parentFrom =
            node.hasMatrix ? node.matrix
                           : compose(local_[i].translation, local_[i].rotation, local_[i].scale);
        sceneFromNode_[i] =
            node.parent >= 0 ? sceneFromNode_[static_cast<size_t>(node.parent)] * parentFrom : parentFrom;
    }
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const Instance& instance = scene.instances[i];
        sceneFromMesh_[i] = instance.followsNode
                                ? sceneFromNode_[static_cast<size_t>(instance.node)] * instance.nodeFromMesh
                                : instance.sceneFromMesh;
    }
}

std::vector<glm::dmat4> sceneFromMeshAt(const Scene& scene, const Animation* animation, double time) {
    ScenePose pose(scene);
    pose.evaluate(scene, animation, time);
    return {pose.sceneFromMesh().begin(), pose.sceneFromMesh().end()};
}

namespace {

/// False for an animation of cameras and empty nodes alone.
bool movesAnInstance(const Scene& scene, const Animation& animation) {
    const std::vector<bool> moved = movedNodes(scene, animation);
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return animates(scene, animation, moved, instance);
    });
}

} // namespace

bool animates(const Scene& scene, const Animation& animation, const std::vector<bool>& moved,
              const Instance& instance) {
    if (instance.followsNode && instance.node >= 0 && moved[static_cast<size_t>(instance.node)])
        return true;
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    return mesh.deformation != nullptr && mesh.deformation->drivenBy(animation, moved);
}

const Animation* playedAnimation(const Scene& scene) {
    if (scene.animation >= 0)
        return &scene.animations[static_cast<size_t>(scene.animation)];
    const Animation* first = nullptr;
    for (const Animation& animation : scene.animations) {
        if (animation.channels.empty())
            continue;
        if (movesAnInstance(scene, animation))
            return &animation;
        first = first != nullptr ? first : &animation;
    }
    return first;
}

std::vector<bool> movedNodes(const Scene& scene, const Animation& animation) {
    std::vector<bool> moved(scene.nodes.size(), false);
    for (const AnimationChannel& channel : animation.channels)
        if (channel.path != AnimatedPath::Weights)
            moved[static_cast<size_t>(channel.node)] = true;
    // Parents precede children.
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        if (const int parent = scene.nodes[n].parent; parent >= 0 && moved[static_cast<size_t>(parent)])
            moved[n] = true;
    return moved;
}

double loopedTime(const Animation& animation, double time) noexcept {
    if (!(animation.duration > 0.0))
        return 0.0;
    const double wrapped = std::fmod(time, animation.duration);
    return wrapped < 0.0 ? wrapped + animation.duration : wrapped;
}

} // namespace touchstone
