#include "engine/import/physics/gltf_soft_bodies.h"

#include "engine/import/file/json_fields.h"
#include "engine/scene/mesh_deformation.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numeric>
#include <utility>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr const char* kSoft = "TOUCHSTONE_soft_body";
constexpr double kLargest = 1e6;
/// kg: below it a float's arithmetic with the hand's forces loses the vertices.
constexpr double kLeastMass = 1e-4;

size_t placesOf(const Mesh& mesh) {
    std::vector<std::array<float, 3>> places;
    for (const glm::vec3& p : mesh.positions)
        places.push_back({p.x, p.y, p.z});
    std::ranges::sort(places);
    return static_cast<size_t>(std::ranges::unique(places).begin() - places.begin());
}

/// How thick the points are, as a share of their size: 0 where all lie in one plane.
double thickness(const std::vector<glm::dvec3>& points) {
    const auto farthest = [&](const auto& distance) {
        glm::dvec3 found(0.0);
        double most = -1.0;
        for (const glm::dvec3& p : points)
            if (const double away = distance(p); away > most) {
                most = away;
                found = p;
            }
        return std::pair(found, std::max(most, 0.0));
    };
    const glm::dvec3 origin = points.empty() ? glm::dvec3(0.0) : points.front();
    const auto [a, length] = farthest([&](const glm::dvec3& p) { return glm::distance(p, origin); });
    const glm::dvec3 along = (a - origin) / length;
    const auto [b, breadth] =
        farthest([&](const glm::dvec3& p) { return glm::length(glm::cross(p - origin, along)); });
    const glm::dvec3 normal = glm::cross(along, b - origin) / breadth;
    const double height =
        farthest([&](const glm::dvec3& p) { return std::abs(glm::dot(p - origin, normal)); }).second;
    return length > 0.0 && breadth > 0.0 ? height / length : 0.0;
}

/// Reads one extension after the other. `fail` of the context leaves out what it is called for.
class SoftBodyReader {
  public:
    SoftBodyReader(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                   Scene& scene)
        : context_(context), document_(document), forest_(forest), scene_(scene) {}

    void read(size_t n);

  private:
    [[nodiscard]] double number(const char* name, double low, double high, double otherwise) const {
        return static_cast<double>(
            numberField(context_, *stated_, name, place_, low, high).value_or(static_cast<float>(otherwise)));
    }
    [[nodiscard]] glm::dvec3 corner(const json& box, const char* name) const;
    void readKind(SoftBody& body) const;
    void readFixed(SoftBody& body) const;
    void readOver(SoftBody& body) const;
    [[nodiscard]] std::vector<int> instancesOf(int node) const;
    [[nodiscard]] int meshFor(int instance) const;
    void checkMesh(const Mesh& mesh) const;

    ImportContext& context_;
    const GltfDocument& document_;
    const NodeForest& forest_;
    Scene& scene_;
    const json* stated_ = nullptr;
    std::string place_;
    size_t made_ = 0;
};

glm::dvec3 SoftBodyReader::corner(const json& box, const char* name) const {
    const auto found = box.find(name);
    if (found == box.end() || !found->is_array() || found->size() != 3 ||
        !std::ranges::all_of(*found, [](const json& value) {
            return value.is_number() && std::abs(value.get<double>()) <= kLargest;
        }))
        context_.fail(place_ + ".fixed." + name, "should be an array of 3 numbers");
    return {(*found)[0].get<double>(), (*found)[1].get<double>(), (*found)[2].get<double>()};
}

void SoftBodyReader::readKind(SoftBody& body) const {
    const auto kind = textField(context_, *stated_, "kind", place_);
    if (kind != "cloth" && kind != "jelly")
        context_.fail(place_ + ".kind", "should be cloth or jelly");
    body.kind = kind == "cloth" ? SoftKind::Cloth : SoftKind::Jelly;
    const bool jelly = body.kind == SoftKind::Jelly;
    body.mass = number("mass", kLeastMass, 1e3, 0.05);
    body.stretch = number("stretch", 1e-3, 1.0, jelly ? 0.1 : 0.5);
    body.shapeFrequency = number("shapeFrequency", 0.0, 100.0, jelly ? 25.0 : 0.0);
    body.volumeStiffness = number("volumeStiffness", 0.0, kLargest, jelly ? 8000.0 : 0.0);
    body.damping = number("damping", 0.0, 500.0, jelly ? 60.0 : 20.0);
    body.friction = number("friction", 0.0, 1.0, 0.3);
    body.thickness = number("thickness", 1e-5, 1.0, 1e-3);
    body.touchRadius = number("touchRadius", 1e-4, 1.0, 6e-3);
    body.breath = number("breath", 0.0, 0.5, 0.0);
    body.breathTime = number("breathTime", 0.2, 1e3, 4.0);
    if (!jelly && (body.shapeFrequency > 0.0 || body.volumeStiffness > 0.0 || body.breath > 0.0))
        context_.fail(place_, "is a cloth, which has no shape and no volume of its own");
}

void SoftBodyReader::readFixed(SoftBody& body) const {
    const auto found = stated_->find("fixed");
    if (found == stated_->end())
        return;
    if (!found->is_object())
        context_.fail(place_ + ".fixed", "should be an object with min and max");
    body.fixedLow = corner(*found, "min");
    body.fixedHigh = corner(*found, "max");
}

std::vector<int> SoftBodyReader::instancesOf(int node) const {
    std::vector<int> instances;
    for (size_t i = 0; i < scene_.instances.size(); ++i)
        if (scene_.instances[i].node == node)
            instances.push_back(static_cast<int>(i));
    return instances;
}

void SoftBodyReader::readOver(SoftBody& body) const {
    const auto found = stated_->find("over");
    if (found == stated_->end())
        return;
    if (!found->is_array() || found->size() > 64)
        context_.fail(place_ + ".over", "should be an array of at most 64 nodes");
    for (const json& value : *found) {
        if (!value.is_number_unsigned() || value.get<uint64_t>() >= forest_.nodeOfGltf.size())
            context_.fail(place_ + ".over", "names a node that does not exist");
        const int node = forest_.nodeOfGltf[value.get<size_t>()];
        for (const int instance : instancesOf(node)) {
            const Instance& placed = scene_.instances[static_cast<size_t>(instance)];
            std::vector<glm::dvec3> points;
            for (const glm::vec3& p : scene_.meshes[static_cast<size_t>(placed.mesh)].positions)
                points.emplace_back(placed.sceneFromMesh * glm::dvec4(glm::dvec3(p), 1.0));
            constexpr double kThinnest = 0.01; // a vertex at its fastest does not pass it in a step
            if (!(thickness(points) >= kThinnest))
                context_.fail(place_ + ".over",
                              "names a flat mesh, which a soft body would pass: give it a thickness "
                              "of a hundredth of its length");
            body.over.push_back(instance);
        }
    }
}

/// What Bullet would divide by.
void SoftBodyReader::checkMesh(const Mesh& mesh) const {
    if (mesh.indices.empty())
        context_.fail(place_, "is at a mesh without triangles");
    if (const size_t places = placesOf(mesh); places > kMaxSoftVertices)
        context_.fail(place_, "is at a mesh of vertices at " + std::to_string(places) +
                                  " places; a soft body has at most " + std::to_string(kMaxSoftVertices));
    double area = 0.0;
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3) {
        const glm::dvec3 a(mesh.positions[mesh.indices[i]]);
        area += glm::length(glm::cross(glm::dvec3(mesh.positions[mesh.indices[i + 1]]) - a,
                                       glm::dvec3(mesh.positions[mesh.indices[i + 2]]) - a));
    }
    if (!(area > 0.0))
        context_.fail(place_, "is at a mesh whose triangles have no area");
}

/// The mesh of one instance alone.
int SoftBodyReader::meshFor(int instance) const {
    const int mesh = scene_.instances[static_cast<size_t>(instance)].mesh;
    if (std::ranges::count(scene_.instances, mesh, &Instance::mesh) == 1)
        return mesh;
    scene_.meshes.push_back(scene_.meshes[static_cast<size_t>(mesh)]);
    return static_cast<int>(scene_.meshes.size()) - 1;
}

void SoftBodyReader::read(size_t n) {
    const auto gltfNode = static_cast<size_t>(forest_.gltfOfNode[n]);
    place_ = element("nodes", gltfNode);
    stated_ = extensionOf(context_, document_.json["nodes"][gltfNode], kSoft, place_);
    if (stated_ == nullptr || !forest_.shown[n])
        return;
    place_ += std::string(".extensions.") + kSoft;
    if (scene_.physics != nullptr)
        context_.fail(place_, "is in a scene with rigid bodies that move, which soft bodies do not meet");
    for (const Animation& animation : scene_.animations) {
        const std::vector<bool> moved = movedNodes(scene_, animation);
        if (moved[n])
            context_.fail(place_, "is at a node that an animation moves");
    }
    for (const Mesh& mesh : scene_.meshes)
        if (mesh.deformation != nullptr && mesh.deformation->soft == nullptr)
            context_.fail(place_, "is in a scene with skins or morph targets that an animation drives");
    const std::vector<int> instances = instancesOf(static_cast<int>(n));
    if (instances.empty())
        context_.fail(place_, "is at a node without a mesh");
    auto body = std::make_shared<SoftBody>();
    readKind(*body);
    readFixed(*body);
    readOver(*body);
    for (const int instance : instances) {
        checkMesh(scene_.meshes[static_cast<size_t>(scene_.instances[static_cast<size_t>(instance)].mesh)]);
        if (std::ranges::find(body->over, instance) != body->over.end())
            context_.fail(place_ + ".over", "names the soft body itself");
        if (made_ >= kMaxSoftBodies)
            context_.fail(place_, "is beyond the " + std::to_string(kMaxSoftBodies) +
                                      " soft meshes that a scene can have");
        const int own = meshFor(instance);
        scene_.instances[static_cast<size_t>(instance)].mesh = own;
        Mesh& mesh = scene_.meshes[static_cast<size_t>(own)];
        auto deformation = std::make_shared<MeshDeformation>();
        deformation->positions = mesh.positions;
        deformation->normals = mesh.normals;
        deformation->soft = body;
        mesh.sources.resize(mesh.positions.size());
        std::iota(mesh.sources.begin(), mesh.sources.end(), 0u);
        mesh.deformation = std::move(deformation);
        ++made_;
    }
}

} // namespace

void readSoftBodies(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                    Scene& scene) {
    SoftBodyReader reader(context, document, forest, scene);
    for (size_t n = 0; n < scene.nodes.size(); ++n)
        (void)context.attempt("it stays hard", [&] { reader.read(n); });
}

} // namespace touchstone
