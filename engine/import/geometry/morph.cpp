#include "engine/import/geometry/morph.h"

#include "engine/import/geometry/gltf_accessors.h"

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

std::string otherCount(size_t count, size_t vertices) {
    return "has " + std::to_string(count) + " vertices where the attribute has " + std::to_string(vertices);
}

std::string targetPlace(const std::string& primitive, size_t target) {
    return primitive + "." + element("targets", target);
}

void warnOfTargets(ImportContext& context, const GltfDocument& document, const tinygltf::Primitive& primitive,
                   const std::string& place) {
    const auto position = primitive.attributes.find("POSITION");
    if (position == primitive.attributes.end())
        return;
    const size_t vertices = accessorCount(document, position->second);
    for (size_t t = 0; t < primitive.targets.size(); ++t)
        for (const auto& [name, accessor] : primitive.targets[t])
            if (!primitive.attributes.contains(name))
                context.warn(targetPlace(place, t) + "." + name,
                             "displaces an attribute that the primitive does not have; ignored");
            else if (accessorCount(document, accessor) != vertices)
                context.warn(targetPlace(place, t) + "." + name,
                             otherCount(accessorCount(document, accessor), vertices) +
                                 "; where its weight is 0, it is ignored");
}

} // namespace

std::vector<size_t> morphTargetCounts(ImportContext& context, const GltfDocument& document) {
    std::vector<size_t> counts;
    for (size_t m = 0; m < document.model.meshes.size(); ++m) {
        const auto& primitives = document.model.meshes[m].primitives;
        size_t most = 0;
        for (const tinygltf::Primitive& primitive : primitives)
            most = std::max(most, primitive.targets.size());
        for (size_t p = 0; p < primitives.size(); ++p) {
            context.stopIfCancelled();
            const std::string place = element("meshes", m) + "." + element("primitives", p);
            if (primitives[p].targets.size() != most)
                context.warn(place + ".targets", "has " + std::to_string(primitives[p].targets.size()) +
                                                     " morph targets where another primitive has " +
                                                     std::to_string(most));
            warnOfTargets(context, document, primitives[p], place);
        }
        counts.push_back(most);
    }
    return counts;
}

std::vector<double> morphWeights(ImportContext& context, const GltfDocument& document, size_t gltfMesh,
                                 size_t targets, int gltfNode) {
    const bool ofNode = gltfNode >= 0 && !document.model.nodes[static_cast<size_t>(gltfNode)].weights.empty();
    const std::vector<double>& stated = ofNode ? document.model.nodes[static_cast<size_t>(gltfNode)].weights
                                               : document.model.meshes[gltfMesh].weights;
    const std::string place =
        (ofNode ? element("nodes", static_cast<size_t>(gltfNode)) : element("meshes", gltfMesh)) + ".weights";
    if (!stated.empty() && stated.size() != targets)
        context.warn(place, "has " + std::to_string(stated.size()) + " weights for " +
                                std::to_string(targets) + " morph targets; " +
                                (stated.size() < targets ? "the others count as 0" : "the rest is ignored"));
    size_t used = std::min(stated.size(), targets);
    while (used > 0 && stated[used - 1] == 0.0)
        --used;
    context.spendGeometry(used * sizeof(double), place);
    return {stated.begin(), stated.begin() + static_cast<std::ptrdiff_t>(used)};
}

MorphTargets::MorphTargets(ImportContext& context, const GltfDocument& document,
                           const tinygltf::Primitive& primitive, std::span<const double> weights,
                           const std::string& place)
    : context_(context), document_(document), primitive_(primitive), place_(place) {
    for (size_t i = 0; i < std::min(primitive.targets.size(), weights.size()); ++i)
        if (weights[i] != 0.0)
            shown_.push_back({i, weights[i]});
}

std::string MorphTargets::at(size_t target) const {
    return targetPlace(place_, target);
}

bool MorphTargets::displaces(const std::string& attribute) const {
    return std::any_of(shown_.begin(), shown_.end(), [&](const Target& target) {
        return primitive_.targets[target.index].contains(attribute);
    });
}

void MorphTargets::displace(const std::string& attribute, RawAttribute& base) const {
    if (!displaces(attribute))
        return;
    context_.spendGeometry(base.values.size() * sizeof(double), place_);
    std::vector<double> sum(base.values.begin(), base.values.end());
    const auto width = static_cast<size_t>(base.components);
    for (const Target& target : shown_) {
        const auto found = primitive_.targets[target.index].find(attribute);
        if (found == primitive_.targets[target.index].end())
            continue;
        const std::string place = at(target.index) + "." + attribute;
        if (!accessorHasData(document_, found->second)) {
            context_.warn(place, "its buffer is declared without data: not displaced");
            continue;
        }
        const auto components = static_cast<size_t>(accessorComponents(document_, found->second));
        if (components != width && !(width == 4 && components == 3)) // a tangent's w, a colour's alpha
            context_.fail(place, "has " + std::to_string(components) + " components");
        const size_t count = accessorCount(document_, found->second), vertices = base.values.size() / width;
        if (count != vertices)
            context_.fail(place, otherCount(count, vertices));
        const std::vector<float> values = readFloats(context_, document_, found->second, place);
        for (size_t i = 0; i < values.size(); ++i) {
            if (!std::isfinite(values[i]))
                context_.fail(place, "vertex " + std::to_string(i / components) + " is not a finite number",
                              "remove the broken vertex, or re-export the model");
            sum[i / components * width + i % components] += target.weight * static_cast<double>(values[i]);
        }
    }
    for (size_t i = 0; i < sum.size(); ++i)
        base.values[i] = static_cast<float>(sum[i]);
}

} // namespace touchstone
