#include "engine/scene/import/gltf_animations.h"

#include "engine/scene/import/gltf_accessors.h"

#include <algorithm>
#include <cmath>
#include <optional>

namespace touchstone {
namespace {

/// A quaternion this far from unit length is not rounding or quantisation but a broken file.
constexpr double kRotationTolerance = 0.1;

std::optional<AnimatedPath> pathOf(const std::string& name) {
    if (name == "translation")
        return AnimatedPath::Translation;
    if (name == "rotation")
        return AnimatedPath::Rotation;
    if (name == "scale")
        return AnimatedPath::Scale;
    return std::nullopt;
}

Interpolation interpolationOf(const ImportContext& context, const std::string& name,
                              const std::string& place) {
    if (name.empty() || name == "LINEAR")
        return Interpolation::Linear;
    if (name == "STEP")
        return Interpolation::Step;
    if (name == "CUBICSPLINE")
        return Interpolation::CubicSpline;
    context.fail(place + ".interpolation",
                 "\"" + name.substr(0, 40) + "\" is not LINEAR, STEP or CUBICSPLINE");
}

std::vector<float> readTimes(ImportContext& context, const GltfDocument& document, int accessor,
                             const std::string& place) {
    if (accessorComponents(document, accessor) != 1 ||
        document.model.accessors[static_cast<size_t>(accessor)].componentType !=
            TINYGLTF_COMPONENT_TYPE_FLOAT)
        context.fail(place, "should be a SCALAR accessor of floats");
    std::vector<float> times = readFloats(context, document, accessor, place);
    for (size_t i = 0; i < times.size(); ++i) {
        if (!std::isfinite(times[i]))
            context.fail(place, "time " + std::to_string(i) + " is not a finite number");
        if (times[i] < 0.0f)
            context.fail(place, "time " + std::to_string(i) + " is negative");
        if (i > 0 && times[i] <= times[i - 1])
            context.fail(place, "time " + std::to_string(i) + " is not after the one before it");
    }
    return times;
}

std::vector<glm::vec4> readKeys(ImportContext& context, const GltfDocument& document, int accessor,
                                const AnimationChannel& channel, const std::string& place) {
    const int components = channel.path == AnimatedPath::Rotation ? 4 : 3;
    const bool cubic = channel.interpolation == Interpolation::CubicSpline;
    if (accessorComponents(document, accessor) != components)
        context.fail(place, "should have " + std::to_string(components) + " components");
    const size_t needed = channel.times.size() * (cubic ? 3 : 1);
    if (accessorCount(document, accessor) != needed)
        context.fail(place, "has " + std::to_string(accessorCount(document, accessor)) + " values where " +
                                std::to_string(needed) + " are needed");
    const std::vector<float> values = readFloats(context, document, accessor, place);
    std::vector<glm::vec4> keys(needed, glm::vec4(0.0f));
    for (size_t i = 0; i < needed; ++i) {
        for (int c = 0; c < components; ++c)
            keys[i][c] = values[i * static_cast<size_t>(components) + static_cast<size_t>(c)];
        if (glm::any(glm::isnan(keys[i])) || glm::any(glm::isinf(keys[i])))
            context.fail(place, "value " + std::to_string(i) + " is not finite");
        const bool isTangent = cubic && i % 3 != 1;
        if (channel.path == AnimatedPath::Rotation && !isTangent &&
            std::abs(glm::length(glm::dvec4(keys[i])) - 1.0) > kRotationTolerance)
            context.fail(place, "rotation " + std::to_string(i) + " is not of unit length");
    }
    return keys;
}

std::optional<AnimationChannel> readChannel(ImportContext& context, const GltfDocument& document,
                                            const NodeForest& forest, const std::vector<Node>& nodes,
                                            const tinygltf::Animation& animation, size_t index,
                                            const std::string& place) {
    const tinygltf::AnimationChannel& gltf = animation.channels[index];
    const std::string at = place + "." + element("channels", index);
    if (static_cast<size_t>(gltf.sampler) >= animation.samplers.size())
        context.fail(at + ".sampler", "refers to a sampler that does not exist");
    const auto path = pathOf(gltf.target_path);
    if (!path)
        context.warn(at + ".target.path",
                     gltf.target_path == "weights"
                         ? "morph targets stay in their rest pose"
                         : "\"" + gltf.target_path.substr(0, 40) + "\" cannot be animated");
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<size_t>(gltf.sampler)];
    const std::string samplerPlace = place + "." + element("samplers", static_cast<size_t>(gltf.sampler));
    if (!accessorHasData(document, sampler.input) || !accessorHasData(document, sampler.output)) {
        context.warn(samplerPlace, "its buffer is declared without data: not animated");
        return std::nullopt;
    }
    AnimationChannel channel;
    channel.times = readTimes(context, document, sampler.input, samplerPlace + ".input");
    // Without a node an extension or nobody is meant: the specification says to ignore it.
    if (!path || gltf.target_node < 0)
        return std::nullopt;
    channel.node = forest.nodeOfGltf[static_cast<size_t>(gltf.target_node)];
    channel.path = *path;
    if (nodes[static_cast<size_t>(channel.node)].hasMatrix)
        context.fail(at + ".target.node", "animates a node that has a matrix",
                     "export the node with translation, rotation and scale");
    channel.interpolation = interpolationOf(context, sampler.interpolation, samplerPlace);
    channel.values = readKeys(context, document, sampler.output, channel, samplerPlace + ".output");
    return channel;
}

} // namespace

std::vector<Animation> readAnimations(ImportContext& context, const GltfDocument& document,
                                      const NodeForest& forest, const std::vector<Node>& nodes) {
    std::vector<Animation> animations;
    for (size_t a = 0; a < document.model.animations.size(); ++a) {
        const tinygltf::Animation& gltf = document.model.animations[a];
        Animation animation;
        animation.name = gltf.name;
        for (size_t c = 0; c < gltf.channels.size(); ++c) {
            context.stopIfCancelled();
            auto channel = readChannel(context, document, forest, nodes, gltf, c, element("animations", a));
            if (!channel)
                continue;
            animation.duration = std::max(animation.duration, static_cast<double>(channel->times.back()));
            animation.channels.push_back(std::move(*channel));
        }
        animations.push_back(std::move(animation));
    }
    return animations;
}

} // namespace touchstone
