#include "engine/scene/mesh_deformation.h"

#include "engine/scene/joint_mean.h"

#include <algorithm>
#include <cmath>

namespace touchstone {
namespace {

template <class T>
uint64_t bytesOf(const std::vector<T>& values) {
    return values.size() * sizeof(T);
}

} // namespace

uint64_t MeshDeformation::memoryBytes() const {
    uint64_t bytes = bytesOf(positions) + bytesOf(normals) + bytesOf(joints) + bytesOf(jointFromMesh) +
                     bytesOf(vertexJoints) + bytesOf(vertexWeights);
    for (const MorphTarget& target : targets)
        bytes += bytesOf(target.positions) + bytesOf(target.normals);
    return bytes;
}

bool MeshDeformation::drivenBy(const Animation& animation, const std::vector<bool>& moved) const {
    if (soft != nullptr)
        return false;
    const bool bends = std::ranges::any_of(
        joints, [&](int joint) { return static_cast<bool>(moved[static_cast<size_t>(joint)]); });
    return bends || std::ranges::any_of(animation.channels, [&](const AnimationChannel& channel) {
               return channel.path == AnimatedPath::Weights && channel.node == weightsNode;
           });
}

bool hasSoftBodies(const Scene& scene) {
    return std::ranges::any_of(scene.meshes, [](const Mesh& mesh) {
        return mesh.deformation != nullptr && mesh.deformation->soft != nullptr;
    });
}

DeformedVertices::DeformedVertices(const MeshDeformation& deformation)
    : deformation_(&deformation), meshFromVertex_(deformation.joints.size(), glm::dmat4(1.0)),
      weights_(deformation.weights) {}

void DeformedVertices::pose(const ScenePose& pose) noexcept {
    const MeshDeformation& d = *deformation_;
    for (size_t j = 0; j < d.joints.size(); ++j) {
        glm::dmat4& matrix = meshFromVertex_[j];
        matrix = pose.sceneFromNode()[static_cast<size_t>(d.joints[j])];
        if (!d.jointFromMesh.empty())
            matrix = matrix * glm::dmat4(d.jointFromMesh[j]);
    }
    const std::span<const double> driven = pose.weightsOf(d.weightsNode);
    for (size_t t = 0; t < weights_.size(); ++t)
        weights_[t] = t < driven.size() ? driven[t] : d.weights[t];
}

glm::dmat4 DeformedVertices::skinMatrix(size_t vertex) const noexcept {
    const MeshDeformation& d = *deformation_;
    const size_t first = vertex * d.perVertex;
    return meanOfJoints(std::span(d.vertexWeights).subspan(first, d.perVertex),
                        std::span(d.vertexJoints).subspan(first, d.perVertex), meshFromVertex_);
}

glm::dvec3 DeformedVertices::morphed(size_t vertex) const noexcept {
    const MeshDeformation& d = *deformation_;
    glm::dvec3 place(d.positions[vertex]);
    for (size_t t = 0; t < d.targets.size(); ++t)
        if (weights_[t] != 0.0 && !d.targets[t].positions.empty())
            place += weights_[t] * glm::dvec3(d.targets[t].positions[vertex]);
    return place;
}

glm::dvec3 DeformedVertices::position(size_t vertex) const noexcept {
    const glm::dvec3 place = morphed(vertex);
    if (deformation_->joints.empty())
        return place;
    return glm::dvec3(skinMatrix(vertex) * glm::dvec4(place, 1.0)) - deformation_->sceneFromSkin;
}

DeformedVertices::Frame DeformedVertices::frame(size_t vertex) const noexcept {
    const MeshDeformation& d = *deformation_;
    Frame frame;
    glm::dvec3 normal(0.0);
    if (!d.normals.empty()) {
        normal = glm::dvec3(d.normals[vertex]);
        for (size_t t = 0; t < d.targets.size(); ++t)
            if (weights_[t] != 0.0 && !d.targets[t].normals.empty())
                normal += weights_[t] * glm::dvec3(d.targets[t].normals[vertex]);
    }
    frame.position = morphed(vertex);
    if (!d.joints.empty()) {
        const glm::dmat4 matrix = skinMatrix(vertex);
        frame.position = glm::dvec3(matrix * glm::dvec4(frame.position, 1.0)) - d.sceneFromSkin;
        frame.linear = glm::dmat3(matrix);
        // Normals transform by the cofactor matrix: it exists where a blend of joints has no inverse.
        const glm::dmat3& m = frame.linear;
        const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
        frame.handedness = glm::dot(m[0], cofactor[0]) < 0.0 ? -1.0 : 1.0;
        normal = frame.handedness * (cofactor * normal);
    }
    const double length = glm::length(normal);
    if (length > 1e-30)
        frame.normal = normal / length;
    return frame;
}

namespace {

/// The tangent of the static pose, carried along with the surface; it stays at right angles to the normal.
glm::vec4 carried(const glm::vec4& tangent, const glm::dmat3& linear, const glm::dmat3& restLinear,
                  const glm::dvec3& normal) {
    if (!(std::abs(glm::determinant(restLinear)) > 0.0))
        return tangent;
    const glm::dvec3 along = linear * (glm::inverse(restLinear) * glm::dvec3(tangent));
    const glm::dvec3 level = along - glm::dot(along, normal) * normal;
    const double length = glm::length(level);
    return length > 1e-30 && std::isfinite(length) ? glm::vec4(glm::vec3(level / length), tangent.w)
                                                   : tangent;
}

void turnToFaces(const Mesh& mesh, DrawnVertices& drawn) {
    for (size_t t = 0; t + 2 < mesh.indices.size(); t += 3) {
        const uint32_t* corner = &mesh.indices[t];
        const glm::dvec3 a(drawn.positions[corner[0]]);
        const glm::dvec3 across = glm::cross(glm::dvec3(drawn.positions[corner[1]]) - a,
                                             glm::dvec3(drawn.positions[corner[2]]) - a);
        const double length = glm::length(across);
        for (size_t k = 0; k < 3 && length > 0.0; ++k)
            drawn.normals[corner[k]] = glm::vec3(across / length);
    }
}

} // namespace

void deform(const Mesh& mesh, const DeformedVertices& vertices, const DeformedVertices& rest,
            DrawnVertices& drawn) {
    drawn.positions.resize(mesh.positions.size());
    drawn.normals = mesh.normals;
    drawn.tangents = mesh.tangents;
    for (size_t v = 0; v < mesh.sources.size(); ++v) {
        const DeformedVertices::Frame frame = vertices.frame(mesh.sources[v]);
        drawn.positions[v] = glm::vec3(frame.position);
        if (mesh.normalsFromFile && frame.normal != glm::dvec3(0.0))
            drawn.normals[v] = glm::vec3(frame.normal);
        if (!drawn.tangents.empty())
            drawn.tangents[v] = carried(mesh.tangents[v], frame.linear, rest.frame(mesh.sources[v]).linear,
                                        glm::dvec3(drawn.normals[v]));
    }
    if (!mesh.normalsFromFile)
        turnToFaces(mesh, drawn);
}

} // namespace touchstone
