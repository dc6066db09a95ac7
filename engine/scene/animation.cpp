#include "engine/scene/animation.h"

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

glm::dvec4 sampleChannel(const AnimationChannel& channel, double time) noexcept {
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    const bool rotation = channel.path == AnimatedPath::Rotation;
    const auto value = [&](size_t key) { return glm::dvec4(channel.values[cubic ? 3 * key + 1 : key]); };
    const auto finished = [&](const glm::dvec4& v) { return rotation ? unit(v) : v; };

    const std::vector<float>& times = channel.times;
    const auto after = std::upper_bound(times.begin(), times.end(), time,
                                        [](double t, float key) { return t < static_cast<double>(key); });
    if (after == times.begin())
        return finished(value(0));
    if (after == times.end())
        return finished(value(times.size() - 1));
    const size_t next = static_cast<size_t>(after - times.begin()), last = next - 1;
    const double begin = times[last], span = static_cast<double>(times[next]) - begin;
    const double t = (time - begin) / span;

    switch (channel.interpolation) {
    case Interpolation::Step:
        return finished(value(last));
    case Interpolation::Linear:
        return rotation ? slerp(unit(value(last)), unit(value(next)), t)
                        : glm::mix(value(last), value(next), t);
    case Interpolation::CubicSpline:
        break;
    }
    // Appendix C.5: cubic Hermite with tangents per second, scaled by the key interval.
    const glm::dvec4 out = span * glm::dvec4(channel.values[3 * last + 2]),
                     in = span * glm::dvec4(channel.values[3 * next]);
    const double t2 = t * t, t3 = t2 * t;
    return finished((2.0 * t3 - 3.0 * t2 + 1.0) * value(last) + (t3 - 2.0 * t2 + t) * out +
                    (-2.0 * t3 + 3.0 * t2) * value(next) + (t3 - t2) * in);
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
    evaluate(scene, nullptr, 0.0);
}

void ScenePose::evaluate(const Scene& scene, const Animation* animation, double time) noexcept {
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        local_[i] = {scene.nodes[i].translation, scene.nodes[i].scale, scene.nodes[i].rotation};
    if (animation != nullptr)
        for (const AnimationChannel& channel : animation->channels) {
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

/// False for an animation of joints, cameras and empty nodes alone.
bool movesAnInstance(const Scene& scene, const Animation& animation) {
    const std::vector<bool> moved = movedNodes(scene, animation);
    return std::ranges::any_of(scene.instances, [&](const Instance& instance) {
        return instance.followsNode && instance.node >= 0 && moved[static_cast<size_t>(instance.node)];
    });
}

} // namespace

const Animation* playedAnimation(const Scene& scene) {
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
