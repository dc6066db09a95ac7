#include "engine/scene/scene_part.h"

#include "engine/core/error.h"
#include "engine/scene/clip_mesh.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <utility>

namespace touchstone {

namespace {

/// The nodes and all below them, ascending: parents come before children in Scene::nodes.
std::vector<int> withAllBelow(const Scene& scene, std::span<const int> nodes) {
    std::vector<bool> in(scene.nodes.size(), false);
    for (const int node : nodes)
        in[static_cast<size_t>(node)] = true;
    std::vector<int> all;
    for (size_t i = 0; i < in.size(); ++i) {
        const int parent = scene.nodes[i].parent;
        in[i] = in[i] || (parent >= 0 && in[static_cast<size_t>(parent)]);
        if (in[i])
            all.push_back(static_cast<int>(i));
    }
    return all;
}

std::string knownNames(const Scene& scene) {
    constexpr size_t kListed = 20;
    std::string all;
    for (size_t i = 0; i < std::min(kListed, scene.nodes.size()); ++i)
        all += (i == 0 ? "" : ", ") + nodeLabel(scene, static_cast<int>(i));
    return all + (scene.nodes.size() > kListed ? ", ..." : "");
}

std::vector<int> required(const Scene& scene, std::span<const std::string> names, const char* option) {
    std::vector<int> nodes;
    for (const std::string& name : names) {
        const std::vector<int> found = nodesNamed(scene, name);
        if (found.empty())
            throw Error(scene.path, option, "there is no object '" + name + "'",
                        scene.nodes.empty() ? "the scene has no nodes"
                                            : "choose one of: " + knownNames(scene));
        nodes.insert(nodes.end(), found.begin(), found.end());
    }
    return nodes;
}

} // namespace

std::optional<ClipPlane> clipPlane(const glm::dvec3& normal, double offset) {
    // The largest component first: the squares of very large and very small ones are infinite or zero.
    const double largest = std::max({std::abs(normal.x), std::abs(normal.y), std::abs(normal.z)});
    if (!(largest > 0.0) || !std::isfinite(normal.x) || !std::isfinite(normal.y) ||
        !std::isfinite(normal.z) || !std::isfinite(offset))
        return std::nullopt;
    return ClipPlane{glm::normalize(normal / largest), offset};
}

std::string nodeLabel(const Scene& scene, int node) {
    const std::string& name = scene.nodes[static_cast<size_t>(node)].name;
    return name.empty() ? "node " + std::to_string(node) : name;
}

std::vector<int> nodesNamed(const Scene& scene, std::string_view name) {
    std::vector<int> nodes;
    for (size_t i = 0; i < scene.nodes.size(); ++i)
        if (nodeLabel(scene, static_cast<int>(i)) == name)
            nodes.push_back(static_cast<int>(i));
    if (!nodes.empty() || name.empty())
        return nodes;
    for (const Instance& instance : scene.instances)
        if (instance.node >= 0 && scene.meshes[static_cast<size_t>(instance.mesh)].name == name)
            nodes.push_back(instance.node);
    std::ranges::sort(nodes);
    nodes.erase(std::ranges::unique(nodes).begin(), nodes.end());
    return nodes;
}

void hideNode(const Scene& scene, int node, ScenePart& part) {
    const std::vector<int> below = withAllBelow(scene, std::span(&node, 1));
    std::vector<int> all;
    std::ranges::set_union(part.hidden, below, std::back_inserter(all));
    part.hidden = std::move(all);
}

void showNode(const Scene& scene, int node, ScenePart& part) {
    const std::vector<int> below = withAllBelow(scene, std::span(&node, 1));
    std::vector<int> left;
    std::ranges::set_difference(part.hidden, below, std::back_inserter(left));
    part.hidden = std::move(left);
}

void isolateNodes(const Scene& scene, std::span<const int> nodes, ScenePart& part) {
    const std::vector<int> shown = withAllBelow(scene, nodes);
    part.hidden.clear();
    for (size_t i = 0, next = 0; i < scene.nodes.size(); ++i) {
        if (next < shown.size() && shown[next] == static_cast<int>(i))
            ++next;
        else
            part.hidden.push_back(static_cast<int>(i));
    }
}

bool isHidden(const ScenePart& part, int node) {
    return std::ranges::binary_search(part.hidden, node);
}

ScenePart partNamed(const Scene& scene, const PartNames& names) {
    ScenePart part;
    part.clip = names.clip;
    if (!names.isolate.empty())
        isolateNodes(scene, required(scene, names.isolate, "--isolate"), part);
    for (const int node : required(scene, names.hide, "--hide"))
        hideNode(scene, node, part);
    return part;
}

std::vector<bool> hiddenInstances(const Scene& scene, const ScenePart& part) {
    std::vector<bool> hidden(scene.instances.size(), false);
    for (size_t i = 0; i < hidden.size() && !part.hidden.empty(); ++i)
        hidden[i] = isHidden(part, scene.instances[i].node);
    return hidden;
}

glm::dvec4 planeInMesh(const ClipPlane& plane, const glm::dmat4& sceneFromMesh) {
    return glm::transpose(sceneFromMesh) * glm::dvec4(plane.normal, -plane.offset);
}

bool isFilled(const Scene& scene, const Instance& instance) {
    const Mesh& mesh = scene.meshes[static_cast<size_t>(instance.mesh)];
    return scene.volume != nullptr || // which is felt itself, whatever the material of its mesh states
           scene.materials[static_cast<size_t>(mesh.material)].haptic.implicit;
}

ScenePtr sceneOf(const ScenePtr& whole, const ScenePart& part) {
    if (part.whole())
        return whole;
    auto scene = std::make_shared<Scene>();
    scene->path = whole->path;
    scene->file = whole->file;
    scene->nodes = whole->nodes;
    scene->materials = whole->materials;
    scene->animations = whole->animations;
    scene->animation = whole->animation;
    scene->bounds = whole->bounds;
    const std::vector<bool> hidden = hiddenInstances(*whole, part);
    std::map<int, int> shared; // the whole's meshes that are kept as they are
    for (size_t i = 0; i < hidden.size(); ++i) {
        if (hidden[i])
            continue;
        Instance& kept = scene->instances.emplace_back(whole->instances[i]);
        const Mesh& mesh = whole->meshes[static_cast<size_t>(kept.mesh)];
        const int next = static_cast<int>(scene->meshes.size());
        std::optional<Mesh> cut;
        if (part.clip)
            cut = clippedMesh(mesh, planeInMesh(*part.clip, kept.sceneFromMesh),
                              clipTolerance(mesh, kept.sceneFromMesh));
        if (cut) {
            scene->meshes.push_back(*std::move(cut));
            kept.mesh = next;
            continue;
        }
        const auto [known, fresh] = shared.emplace(kept.mesh, next);
        if (fresh)
            scene->meshes.push_back(mesh);
        kept.mesh = known->second;
    }
    return scene;
}

} // namespace touchstone
