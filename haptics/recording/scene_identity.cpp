#include "haptics/recording/scene_identity.h"

#include "engine/core/checksum.h"
#include "engine/import/volume_file/volume_edits.h"
#include "engine/scene/animation.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/soft_body.h"
#include "haptics/program/felt_program.h"

#include <fstream>
#include <system_error>
#include <vector>

namespace touchstone {

namespace {

void add(Hash64& hash, const glm::dvec3& v) {
    hash.add(v.x);
    hash.add(v.y);
    hash.add(v.z);
}

void add(Hash64& hash, const glm::dmat4& m) {
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            hash.add(m[column][row]);
}

void add(Hash64& hash, const glm::dquat& q) {
    for (const double part : {q.x, q.y, q.z, q.w})
        hash.add(part);
}

void add(Hash64& hash, const Similarity& s) {
    hash.add(s.scale);
    add(hash, s.rotation);
    add(hash, s.translation);
}

void add(Hash64& hash, const HapticObject& object) {
    if (object.shape != nullptr)
        hash.add(object.shape->identity());
    hash.addBytes(object.vertices);
    hash.addBytes(object.indices);
    hash.addBytes(object.sourceIndices);
    hash.addBytes(object.normals);
    hash.addBytes(object.tangents);
    for (const std::vector<glm::vec2>& uv : object.uv)
        hash.addBytes(uv);
    for (const std::vector<float>* values :
         {&object.stiffness, &object.damping, &object.friction, &object.heights})
        hash.addBytes(*values);
    hash.addBytes(object.smooth);
    hash.add(object.instance);
    hash.add(object.material);
    hash.add(object.closed);
    hash.add(object.oneSided);
    add(hash, object.workspaceFromObject);
    add(hash, object.objectFromMesh);
}

void add(Hash64& hash, const HapticFactor& factor) {
    factor.map.addTo(hash);
    hash.add(factor.min);
    hash.add(factor.max);
}

void add(Hash64& hash, const HapticMaterialData& material) {
    for (const double number :
         {material.stiffness, material.damping, material.staticFriction, material.dynamicFriction,
          material.viscousFriction, material.normalScale, material.heightScale})
        hash.add(number);
    material.normal.addTo(hash);
    // glTF's default is left out: recordings of before know no other.
    if (material.heightMid != 0.5)
        hash.add(material.heightMid);
    material.height.addTo(hash);
    for (const HapticFactor* factor : {&material.friction, &material.stiffnessMap, &material.dampingMap})
        add(hash, *factor);
    hash.add(material.shading);
    hash.add(material.plain);
    if (material.program != nullptr)
        hash.add(material.program->identity);
    if (const LocalDeformation& dent = material.deformation; dent.on())
        for (const double number : {dent.radius, dent.stiffness, dent.linear, dent.quadratic, dent.time})
            hash.add(number);
}

void add(Hash64& hash, const Animation& animation) {
    hash.add(animation.duration);
    for (const AnimationChannel& channel : animation.channels) {
        hash.add(channel.node);
        hash.add(channel.path);
        hash.add(channel.interpolation);
        hash.addBytes(channel.times);
        hash.addBytes(channel.values);
        if (channel.path == AnimatedPath::Weights)
            hash.addBytes(channel.weights);
    }
}

void add(Hash64& hash, const MeshDeformation& deformation) {
    hash.addBytes(deformation.positions);
    hash.addBytes(deformation.normals);
    for (const MorphTarget& target : deformation.targets) {
        hash.addBytes(target.positions);
        hash.addBytes(target.normals);
    }
    hash.addBytes(deformation.weights);
    hash.add(deformation.weightsNode);
    hash.addBytes(deformation.joints);
    hash.addBytes(deformation.jointFromMesh);
    hash.addBytes(deformation.vertexJoints);
    hash.addBytes(deformation.vertexWeights);
}

void add(Hash64& hash, const Node& node) {
    hash.add(node.parent);
    add(hash, node.translation);
    add(hash, node.rotation);
    add(hash, node.scale);
    hash.add(node.hasMatrix);
    add(hash, node.matrix);
}

void add(Hash64& hash, const SoftBody& soft) {
    hash.add(static_cast<int>(soft.kind));
    for (const double number :
         {soft.mass, soft.stretch, soft.shapeFrequency, soft.volumeStiffness, soft.damping, soft.friction,
          soft.thickness, soft.touchRadius, soft.breath, soft.breathTime})
        hash.add(number);
    for (const std::optional<glm::dvec3>& corner : {soft.fixedLow, soft.fixedHigh})
        for (int axis = 0; corner && axis < 3; ++axis)
            hash.add((*corner)[axis]);
    for (const int instance : soft.over)
        hash.add(instance);
}

/// Size and hash of a file's bytes; zeros where it cannot be read.
void readBytes(const std::filesystem::path& path, SceneIdentity& identity) {
    std::ifstream file(path, std::ios::binary);
    std::vector<std::byte> block(1 << 20);
    Hash64 hash;
    uint64_t size = 0;
    while (file) {
        file.read(reinterpret_cast<char*>(block.data()), static_cast<std::streamsize>(block.size()));
        const auto got = static_cast<size_t>(file.gcount());
        if (got == 0)
            break;
        hash.addBytes(std::span(block).first(got));
        size += got;
    }
    if (size == 0)
        return;
    identity.fileSize = size;
    identity.fileHash = hash.value();
}

} // namespace

uint64_t feltHash(const HapticScene& scene, const Scene& source) {
    Hash64 hash;
    for (const auto& object : scene.objects)
        add(hash, *object);
    for (const HapticMaterialData& material : scene.materials)
        add(hash, material);
    for (const Similarity& frame : scene.programFromObject)
        add(hash, frame);
    add(hash, scene.workspaceFromScene);
    if (const Animation* animation = playedAnimation(source)) {
        add(hash, *animation);
        for (const Node& node : source.nodes)
            add(hash, node);
        for (const Mesh& mesh : source.meshes)
            if (mesh.deformation != nullptr)
                add(hash, *mesh.deformation);
    }
    for (const Mesh& mesh : source.meshes)
        if (mesh.deformation != nullptr && mesh.deformation->soft != nullptr)
            add(hash, *mesh.deformation->soft);
    return hash.value();
}

SceneIdentity identify(const HapticScene& scene, const Scene& source, Fit fit) {
    SceneIdentity identity;
    identity.path = source.path;
    std::error_code error;
    const std::filesystem::path absolute = std::filesystem::weakly_canonical(source.path, error);
    if (!error && std::filesystem::exists(absolute, error))
        identity.absolutePath = absolute.string();
    if (source.volume != nullptr) { // a step of its surface must not wait for the disk
        identity.fileSize = source.file.size;
        identity.fileHash = source.file.hash;
    } else {
        readBytes(source.path, identity);
    }
    identity.feltHash = feltHash(scene, source);
    identity.fit = fit;
    identity.edits = withChoices({}, source);
    return identity;
}

} // namespace touchstone
