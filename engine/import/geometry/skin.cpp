#include "engine/import/geometry/skin.h"

#include "engine/import/geometry/gltf_accessors.h"
#include "engine/scene/joint_mean.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>

namespace touchstone {
namespace {

/// Weights whose sum deviates from 1 by more than this are reported; less is rounding.
constexpr double kWeightTolerance = 1e-3;

/// One pair JOINTS_n, WEIGHTS_n.
struct InfluenceSet {
    RawAttribute joints, weights;
};

class InfluenceReader {
  public:
    InfluenceReader(ImportContext& context, const GltfDocument& document,
                    const tinygltf::Primitive& primitive, DracoPrimitive* draco, size_t vertexCount,
                    const std::string& place)
        : context_(context), document_(document), primitive_(primitive), draco_(draco), count_(vertexCount),
          place_(place) {}

    [[nodiscard]] std::vector<InfluenceSet> sets() {
        std::vector<InfluenceSet> sets;
        while (true) {
            const std::string suffix = std::to_string(sets.size());
            const std::string joints = "JOINTS_" + suffix, weights = "WEIGHTS_" + suffix;
            const bool hasJoints = primitive_.attributes.contains(joints),
                       hasWeights = primitive_.attributes.contains(weights);
            if (!hasJoints && !hasWeights) {
                refuseGaps(sets.size());
                return sets;
            }
            if (hasJoints != hasWeights)
                context_.fail(place_ + ".attributes", "has " + (hasJoints ? joints : weights) + " but no " +
                                                          (hasJoints ? weights : joints));
            const int accessor = primitive_.attributes.at(joints);
            if (document_.model.accessors[static_cast<size_t>(accessor)].normalized)
                context_.fail(place_ + ".attributes." + joints, "must not be normalized: it holds indices");
            sets.push_back({read(joints), read(weights)});
        }
    }

  private:
    /// A set after a gap in the numbering would be left out, which changes the pose.
    void refuseGaps(size_t read) const {
        for (const auto& [name, accessor] : primitive_.attributes)
            for (const std::string prefix : {"JOINTS_", "WEIGHTS_"}) {
                size_t number = 0;
                const char* end = name.data() + name.size();
                if (name.starts_with(prefix) &&
                    std::from_chars(name.data() + prefix.size(), end, number).ptr == end && number >= read)
                    context_.fail(place_ + ".attributes",
                                  "has " + name + " but no " + prefix + std::to_string(read),
                                  "number the sets of joints and weights without a gap");
            }
    }

    RawAttribute read(const std::string& name) {
        return readAttribute(context_, document_, primitive_, draco_, place_, name, count_, 4);
    }

    ImportContext& context_;
    const GltfDocument& document_;
    const tinygltf::Primitive& primitive_;
    DracoPrimitive* draco_;
    size_t count_;
    const std::string& place_;
};

bool isFinite(const glm::dvec3& v) {
    return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z);
}

glm::dmat4 sceneFromVertex(const VertexInfluences& influences, const SkinPose& skin, size_t vertex) {
    const size_t first = vertex * influences.perVertex;
    return meanOfJoints(std::span(influences.weights).subspan(first, influences.perVertex),
                        std::span(influences.joints).subspan(first, influences.perVertex),
                        skin.sceneFromMesh);
}

/// Transforms normal and tangent of a vertex. Returns -1 where `linear` mirrors, else 1.
int poseFrame(const glm::dmat3& linear, size_t vertex, Mesh& mesh) {
    double largest = 0.0;
    for (int column = 0; column < 3; ++column)
        for (int row = 0; row < 3; ++row)
            largest = std::max(largest, std::abs(linear[column][row]));
    // Scaled first, so that products of two entries neither overflow nor vanish.
    const glm::dmat3 m = largest > 0.0 ? linear / largest : linear;
    // The inverse transpose is the cofactor matrix over the determinant, of which only the sign counts; the
    // cofactor matrix also exists where the blend of joints has no inverse.
    const glm::dmat3 cofactor(glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1]));
    const int turn = glm::dot(m[0], cofactor[0]) < 0.0 ? -1 : 1;
    const auto unitOrZero = [](const glm::dvec3& v) {
        const double length = glm::length(v);
        return length > 1e-30 ? glm::vec3(v / length) : glm::vec3(0.0f);
    };
    if (!mesh.normals.empty())
        mesh.normals[vertex] =
            unitOrZero(static_cast<double>(turn) * (cofactor * glm::dvec3(mesh.normals[vertex])));
    if (!mesh.tangents.empty()) {
        const glm::vec4 t = mesh.tangents[vertex];
        mesh.tangents[vertex] =
            glm::vec4(unitOrZero(m * glm::dvec3(t.x, t.y, t.z)), t.w * static_cast<float>(turn));
    }
    return turn;
}

/// Exchanges two corners of each mirrored triangle. Where the joints of one triangle disagree, most of its
/// corners decide.
void turnMirrored(const std::vector<int8_t>& turns, Mesh& mesh) {
    for (size_t i = 0; i + 2 < mesh.indices.size(); i += 3)
        if (turns[mesh.indices[i]] + turns[mesh.indices[i + 1]] + turns[mesh.indices[i + 2]] < 0)
            std::swap(mesh.indices[i + 1], mesh.indices[i + 2]);
}

/// The centre of the drawn vertices: exporters leave stray ones behind.
glm::dvec3 centreOf(const std::vector<glm::dvec3>& positions, const Mesh& mesh) {
    Bounds bounds;
    for (const auto* indices : {&mesh.indices, &mesh.lineIndices, &mesh.pointIndices})
        for (const uint32_t index : *indices)
            bounds.include(positions[index]);
    return bounds.empty() ? glm::dvec3(0.0) : bounds.centre();
}

} // namespace

const SkinPose& SkinPoses::get(size_t skin) {
    const auto [found, isNew] = made_.try_emplace(skin);
    SkinPose& pose = found->second;
    if (!isNew)
        return pose;
    pose.place = element("skins", skin);
    const nlohmann::json& stated = document_.json["skins"][skin];
    const std::vector<size_t> joints = stated["joints"];
    if (joints.empty())
        context_.fail(pose.place + ".joints", "is empty: the mesh has nothing to follow");
    context_.spendGeometry(joints.size() * (sizeof(glm::dmat4) + sizeof(glm::mat4) + 2 * sizeof(size_t)),
                           pose.place);
    checkJoints(joints, pose.place);
    pose.jointFromMesh = inverseBinds(stated, pose.place);
    pose.sceneFromMesh.resize(joints.size());
    for (size_t j = 0; j < joints.size(); ++j) {
        const int node = forest_.nodeOfGltf[joints[j]];
        pose.joints.push_back(node);
        pose.driven = pose.driven || driven_[static_cast<size_t>(node)];
        const glm::dmat4& sceneFromJoint = sceneFromNode_[static_cast<size_t>(node)];
        pose.sceneFromMesh[j] =
            pose.jointFromMesh.empty() ? sceneFromJoint : sceneFromJoint * glm::dmat4(pose.jointFromMesh[j]);
    }
    return pose;
}

std::vector<glm::mat4> SkinPoses::inverseBinds(const nlohmann::json& skin, const std::string& place) const {
    if (!skin.contains("inverseBindMatrices"))
        return {};
    const int accessor = skin["inverseBindMatrices"];
    const std::string at = place + ".inverseBindMatrices";
    if (!accessorHasData(document_, accessor))
        context_.fail(at, "its buffer is declared without data");
    std::vector<glm::mat4> matrices = readMatrices(context_, document_, accessor, skin["joints"].size(), at);
    size_t mended = 0;
    for (glm::mat4& matrix : matrices) {
        const glm::vec4 row(matrix[0][3], matrix[1][3], matrix[2][3], matrix[3][3]);
        const glm::vec4 off = glm::abs(row - glm::vec4(0.0f, 0.0f, 0.0f, 1.0f));
        if (!(std::max({off.x, off.y, off.z, off.w}) < 1e-4f))
            ++mended;
        for (int column = 0; column < 4; ++column)
            matrix[column][3] = column == 3 ? 1.0f : 0.0f;
    }
    if (mended > 0)
        context_.warn(at, std::to_string(mended) +
                              " matrices are not affine: their last row counts as 0, 0, 0, 1");
    return matrices;
}

void SkinPoses::checkJoints(const std::vector<size_t>& joints, const std::string& place) {
    if (rootOf_.empty())
        for (size_t n = 0; n < nodes_.size(); ++n) {
            const int parent = nodes_[n].parent;
            rootOf_.push_back(parent < 0 ? static_cast<int>(n) : rootOf_[static_cast<size_t>(parent)]);
        }
    size_t hidden = 0;
    bool oneRoot = true;
    const auto nodeOf = [&](size_t joint) { return static_cast<size_t>(forest_.nodeOfGltf[joint]); };
    for (const size_t joint : joints) {
        hidden += forest_.shown[nodeOf(joint)] ? 0 : 1;
        oneRoot = oneRoot && rootOf_[nodeOf(joint)] == rootOf_[nodeOf(joints.front())];
    }
    if (hidden > 0)
        context_.warn(place, std::to_string(hidden) +
                                 " of its joints are not in the scene that is shown; they "
                                 "count where they are");
    if (!oneRoot)
        context_.warn(place, "its joints have no common root; they count where they are");
}

std::optional<VertexInfluences> readInfluences(ImportContext& context, const GltfDocument& document,
                                               const tinygltf::Primitive& primitive, DracoPrimitive* draco,
                                               const SkinPose& skin, size_t vertexCount,
                                               const std::string& place) {
    const std::vector<InfluenceSet> sets =
        InfluenceReader(context, document, primitive, draco, vertexCount, place).sets();
    if (sets.empty()) {
        context.warn(place,
                     "has no JOINTS_0 and WEIGHTS_0 for " + skin.place + ": its node moves it as a whole");
        return std::nullopt;
    }
    VertexInfluences result;
    result.perVertex = 4 * sets.size();
    const size_t joints = skin.sceneFromMesh.size(), all = vertexCount * result.perVertex;
    context.spendGeometry(all * (sizeof(uint32_t) + sizeof(float)), place);
    result.joints.resize(all);
    result.weights.resize(all);
    size_t negative = 0, odd = 0, none = 0;
    for (size_t v = 0; v < vertexCount; ++v) {
        double sum = 0.0;
        for (size_t k = 0; k < result.perVertex; ++k) {
            const InfluenceSet& set = sets[k / 4];
            const float joint = set.joints.values[4 * v + k % 4], weight = set.weights.values[4 * v + k % 4];
            negative += weight < 0.0f ? 1 : 0;
            const size_t at = v * result.perVertex + k;
            result.weights[at] = std::max(weight, 0.0f);
            sum += static_cast<double>(result.weights[at]);
            const bool exists =
                joint >= 0.0f && joint < static_cast<float>(joints) && joint == std::floor(joint);
            if (!exists && result.weights[at] > 0.0f)
                context.fail(place + ".attributes.JOINTS_" + std::to_string(k / 4),
                             "vertex " + std::to_string(v) + " follows joint " +
                                 nlohmann::json(joint).dump() + ", but " + skin.place + " has " +
                                 std::to_string(joints) + " of them");
            result.joints[at] = exists ? static_cast<uint32_t>(joint) : 0;
        }
        odd += sum > 0.0 && std::abs(sum - 1.0) > kWeightTolerance ? 1 : 0;
        if (!(sum > 0.0)) {
            ++none;
            result.weights[v * result.perVertex] = 1.0f;
        }
    }
    const std::string at = place + ".attributes.WEIGHTS_0";
    if (negative > 0)
        context.warn(at, std::to_string(negative) + " weights are negative and count as 0");
    if (none > 0)
        context.warn(at,
                     std::to_string(none) + " vertices have no weight at all and follow their first joint");
    if (odd > 0)
        context.warn(at,
                     std::to_string(odd) + " vertices have weights whose sum is not 1; they were normalised");
    return result;
}

glm::dvec3 poseVertices(ImportContext& context, const VertexInfluences& influences, const SkinPose& skin,
                        const std::string& place, Mesh& mesh) {
    const size_t count = mesh.positions.size();
    context.spendGeometry(count * (sizeof(glm::dvec3) + sizeof(int8_t)), place);
    std::vector<glm::dvec3> inScene(count);
    std::vector<int8_t> turns(count);
    const auto refuse = [&](size_t v) {
        context.fail(place,
                     "vertex " + std::to_string(v) + " has no finite place in the pose of " + skin.place,
                     "check the joints' transforms and the inverse bind matrices");
    };
    for (size_t v = 0; v < count; ++v) {
        const glm::dmat4 matrix = sceneFromVertex(influences, skin, v);
        inScene[v] = glm::dvec3(matrix * glm::dvec4(glm::dvec3(mesh.positions[v]), 1.0));
        if (!isFinite(inScene[v]))
            refuse(v);
        turns[v] = static_cast<int8_t>(poseFrame(glm::dmat3(matrix), v, mesh));
    }
    turnMirrored(turns, mesh);
    const glm::dvec3 origin = centreOf(inScene, mesh);
    for (size_t v = 0; v < count; ++v) {
        mesh.positions[v] = glm::vec3(inScene[v] - origin);
        if (!isFinite(glm::dvec3(mesh.positions[v])))
            refuse(v);
    }
    // Generated frames are better than frames with gaps.
    const auto lost = [](const glm::vec4& t) { return glm::vec3(t) == glm::vec3(0.0f); };
    if (std::any_of(mesh.tangents.begin(), mesh.tangents.end(), lost)) {
        mesh.tangents.clear();
        mesh.tangentsFromFile = false;
    }
    return origin;
}

} // namespace touchstone
