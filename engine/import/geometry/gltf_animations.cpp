#include "engine/import/geometry/gltf_animations.h"

#include "engine/import/geometry/gltf_accessors.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <set>
#include <utility>

namespace touchstone {
namespace {

/// A quaternion this far from unit length is reported; less is rounding and quantisation.
constexpr double kUnitTolerance = 1e-2;

std::optional<AnimatedPath> pathOf(const std::string& name) {
    if (name == "translation")
        return AnimatedPath::Translation;
    if (name == "rotation")
        return AnimatedPath::Rotation;
    if (name == "scale")
        return AnimatedPath::Scale;
    if (name == "weights")
        return AnimatedPath::Weights;
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

/// The key times, and their indices in the file: a key that is not after the preceding one is skipped.
struct KeyTimes {
    std::vector<float> times;
    std::vector<size_t> keys;
    size_t stated = 0;
};

KeyTimes readTimes(ImportContext& context, const GltfDocument& document, int accessor,
                   const std::string& place) {
    if (accessorComponents(document, accessor) != 1 ||
        document.model.accessors[static_cast<size_t>(accessor)].componentType !=
            TINYGLTF_COMPONENT_TYPE_FLOAT)
        context.fail(place, "should be a SCALAR accessor of floats");
    const std::vector<float> stated = readFloats(context, document, accessor, place);
    if (stated.empty())
        context.fail(place, "has no keys");
    KeyTimes result;
    result.stated = stated.size();
    size_t negative = 0;
    for (size_t i = 0; i < stated.size(); ++i) {
        if (!std::isfinite(stated[i]))
            context.fail(place, "time " + std::to_string(i) + " is not a finite number");
        negative += stated[i] < 0.0f ? 1 : 0;
        if (!result.times.empty() && stated[i] <= result.times.back())
            continue;
        result.times.push_back(stated[i]);
        result.keys.push_back(i);
    }
    if (negative > 0)
        context.warn(place, std::to_string(negative) + " times are negative; what is before 0 is not played");
    if (const size_t skipped = stated.size() - result.times.size(); skipped > 0)
        context.warn(place,
                     std::to_string(skipped) + " times are not after the one before; their keys are skipped");
    return result;
}

/// Normalises a rotation. Returns whether it was off unit length; throws Error if it has no direction.
bool normaliseRotation(const ImportContext& context, glm::vec4& key, size_t index, const std::string& place) {
    constexpr double kNone = 1e-6;
    const double length = glm::length(glm::dvec4(key));
    if (!(length > kNone))
        context.fail(place, "rotation " + std::to_string(index) + " has length 0");
    if (std::abs(length - 1.0) <= kUnitTolerance)
        return false;
    key = glm::vec4(glm::dvec4(key) / length);
    return true;
}

std::vector<glm::vec4> readKeys(ImportContext& context, const GltfDocument& document, int accessor,
                                const AnimationChannel& channel, const KeyTimes& at,
                                const std::string& place) {
    const int components = channel.path == AnimatedPath::Rotation ? 4 : 3;
    const size_t perKey = channel.interpolation == Interpolation::CubicSpline ? 3 : 1;
    if (accessorComponents(document, accessor) != components)
        context.fail(place, "should have " + std::to_string(components) + " components");
    const size_t needed = at.stated * perKey;
    if (accessorCount(document, accessor) != needed)
        context.fail(place, "has " + std::to_string(accessorCount(document, accessor)) + " values where " +
                                std::to_string(needed) + " are needed");
    const std::vector<float> values = readFloats(context, document, accessor, place);
    std::vector<glm::vec4> keys;
    keys.reserve(at.keys.size() * perKey);
    size_t odd = 0;
    for (const size_t key : at.keys)
        for (size_t i = key * perKey; i < (key + 1) * perKey; ++i) {
            glm::vec4 value(0.0f);
            for (int c = 0; c < components; ++c)
                value[c] = values[i * static_cast<size_t>(components) + static_cast<size_t>(c)];
            if (glm::any(glm::isnan(value)) || glm::any(glm::isinf(value)))
                context.fail(place, "value " + std::to_string(i) + " is not finite");
            const bool isTangent = perKey == 3 && i % 3 != 1;
            if (channel.path == AnimatedPath::Rotation && !isTangent)
                odd += normaliseRotation(context, value, i, place) ? 1 : 0;
            keys.push_back(value);
        }
    if (odd > 0)
        context.warn(place, std::to_string(odd) + " rotations are not of unit length and were normalised");
    return keys;
}

/// The most morph targets of a primitive of the node's mesh.
size_t targetsOf(const GltfDocument& document, int gltfNode) {
    const int mesh = document.model.nodes[static_cast<size_t>(gltfNode)].mesh;
    size_t most = 0;
    if (mesh >= 0)
        for (const tinygltf::Primitive& primitive :
             document.model.meshes[static_cast<size_t>(mesh)].primitives)
            most = std::max(most, primitive.targets.size());
    return most;
}

std::vector<float> readWeights(ImportContext& context, const GltfDocument& document, int accessor,
                               const AnimationChannel& channel, const KeyTimes& at,
                               const std::string& place) {
    const size_t perKey = (channel.interpolation == Interpolation::CubicSpline ? 3 : 1) * channel.targets;
    if (accessorComponents(document, accessor) != 1)
        context.fail(place, "should be a SCALAR accessor");
    if (accessorCount(document, accessor) != at.stated * perKey)
        context.fail(place, "has " + std::to_string(accessorCount(document, accessor)) + " values where " +
                                std::to_string(at.stated * perKey) + " are needed");
    const std::vector<float> values = readFloats(context, document, accessor, place);
    if (std::any_of(values.begin(), values.end(), [](float value) { return !std::isfinite(value); }))
        context.fail(place, "has a weight that is not finite");
    std::vector<float> keys;
    keys.reserve(at.keys.size() * perKey);
    for (const size_t key : at.keys)
        keys.insert(keys.end(), values.begin() + static_cast<std::ptrdiff_t>(key * perKey),
                    values.begin() + static_cast<std::ptrdiff_t>((key + 1) * perKey));
    return keys;
}

std::optional<AnimationChannel> readChannel(ImportContext& context, const GltfDocument& document,
                                            const NodeForest& forest, const std::vector<Node>& nodes,
                                            const tinygltf::Animation& animation, size_t index,
                                            const std::string& place) {
    const tinygltf::AnimationChannel& gltf = animation.channels[index];
    const std::string channelPlace = place + "." + element("channels", index);
    if (static_cast<size_t>(gltf.sampler) >= animation.samplers.size())
        context.fail(channelPlace + ".sampler", "refers to a sampler that does not exist");
    const auto path = pathOf(gltf.target_path);
    if (!path)
        context.warn(channelPlace + ".target.path",
                     "\"" + gltf.target_path.substr(0, 40) + "\" cannot be animated");
    const tinygltf::AnimationSampler& sampler = animation.samplers[static_cast<size_t>(gltf.sampler)];
    const std::string samplerPlace = place + "." + element("samplers", static_cast<size_t>(gltf.sampler));
    if (!accessorHasData(document, sampler.input) || !accessorHasData(document, sampler.output)) {
        context.warn(samplerPlace, "its buffer is declared without data: not animated");
        return std::nullopt;
    }
    AnimationChannel channel;
    KeyTimes at = readTimes(context, document, sampler.input, samplerPlace + ".input");
    // A channel without a node belongs to an extension or to nothing: the specification requires ignoring it.
    if (!path || gltf.target_node < 0)
        return std::nullopt;
    channel.node = forest.nodeOfGltf[static_cast<size_t>(gltf.target_node)];
    channel.path = *path;
    if (channel.path == AnimatedPath::Weights) {
        channel.targets = targetsOf(document, gltf.target_node);
        if (channel.targets == 0) {
            context.warn(channelPlace + ".target", "animates the weights of a node without morph targets");
            return std::nullopt;
        }
    } else if (nodes[static_cast<size_t>(channel.node)].hasMatrix)
        context.fail(channelPlace + ".target.node", "animates a node that has a matrix",
                     "export the node with translation, rotation and scale");
    channel.interpolation = interpolationOf(context, sampler.interpolation, samplerPlace);
    if (channel.path == AnimatedPath::Weights)
        channel.weights =
            readWeights(context, document, sampler.output, channel, at, samplerPlace + ".output");
    else
        channel.values = readKeys(context, document, sampler.output, channel, at, samplerPlace + ".output");
    channel.times = std::move(at.times);
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
        std::set<std::pair<int, AnimatedPath>> targets;
        for (size_t c = 0; c < gltf.channels.size(); ++c) {
            context.stopIfCancelled();
            std::optional<AnimationChannel> channel;
            // The static model is right without it.
            (void)context.attempt("it is not animated", [&] {
                channel = readChannel(context, document, forest, nodes, gltf, c, element("animations", a));
            });
            if (!channel)
                continue;
            if (!targets.emplace(channel->node, channel->path).second) {
                context.warn(element("animations", a) + "." + element("channels", c) + ".target",
                             "is animated by an earlier channel already; this one is left out");
                continue;
            }
            animation.duration = std::max(animation.duration, static_cast<double>(channel->times.back()));
            animation.channels.push_back(std::move(*channel));
        }
        animations.push_back(std::move(animation));
    }
    return animations;
}

int chosenAnimation(const ImportContext& context, const std::vector<Animation>& animations,
                    const std::optional<std::string>& wanted) {
    if (!wanted)
        return -1;
    const auto named = std::ranges::find(animations, *wanted, &Animation::name);
    if (named != animations.end())
        return static_cast<int>(named - animations.begin());
    size_t index = 0;
    const char* const end = wanted->data() + wanted->size();
    const auto [stop, fault] = std::from_chars(wanted->data(), end, index);
    if (!wanted->empty() && fault == std::errc() && stop == end && index < animations.size())
        return static_cast<int>(index);
    constexpr size_t kListed = 20;
    std::string known;
    for (size_t a = 0; a < std::min(animations.size(), kListed); ++a)
        known += (a > 0 ? ", " : "") + std::to_string(a) + " '" + animations[a].name.substr(0, 40) + "'";
    context.fail("animations", "there is no animation '" + wanted->substr(0, 40) + "'",
                 animations.empty() ? "the file has none" : "choose one of: " + known);
}

} // namespace touchstone
