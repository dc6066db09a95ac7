#include "api/c/scene_arrays.h"

#include "api/c/calls.h"
#include "engine/import/mesh_file/flat_glb.h"
#include "engine/save/material_patch.h"

#include <cmath>
#include <limits>
#include <utility>

namespace touchstone::api {

namespace {

void requireFinite(const float* values, size_t count, const std::string& argument) {
    for (size_t i = 0; i < count; ++i)
        if (!std::isfinite(values[i]))
            refuseArgument(argument + "[" + std::to_string(i) + "]", "is not finite");
}

void check(const ts_mesh& mesh, const std::string& name, size_t materials) {
    constexpr size_t kMost = std::numeric_limits<uint32_t>::max() / 16; // an array of a GLB has below 4 GiB
    if (mesh.positions == nullptr)
        refuseArgument(name + ".positions", "is null");
    if (mesh.indices == nullptr)
        refuseArgument(name + ".indices", "is null");
    if (mesh.vertex_count < 3 || mesh.vertex_count > kMost)
        refuseArgument(name + ".vertex_count",
                       std::to_string(mesh.vertex_count) + " is not within 3 .. " + std::to_string(kMost));
    if (mesh.triangle_count < 1 || mesh.triangle_count > kMost)
        refuseArgument(name + ".triangle_count",
                       std::to_string(mesh.triangle_count) + " is not within 1 .. " + std::to_string(kMost));
    if (mesh.material >= std::max<size_t>(materials, 1))
        refuseArgument(name + ".material", std::to_string(mesh.material) + ", and there are " +
                                               std::to_string(materials) + " materials");
    requireFinite(mesh.positions, 3 * mesh.vertex_count, name + ".positions");
    if (mesh.normals != nullptr)
        requireFinite(mesh.normals, 3 * mesh.vertex_count, name + ".normals");
    if (mesh.texture != nullptr)
        requireFinite(mesh.texture, 2 * mesh.vertex_count, name + ".texture");
    for (size_t i = 0; i < 3 * mesh.triangle_count; ++i)
        if (mesh.indices[i] >= mesh.vertex_count)
            refuseArgument(entry((name + ".indices").c_str(), i), std::to_string(mesh.indices[i]) +
                                                                      " names no vertex; there are " +
                                                                      std::to_string(mesh.vertex_count));
}

void check(const ts_material& material, const std::string& name) {
    const auto number = [&](double value, const char* member) {
        if (std::isinf(value) || value < 0.0)
            refuseArgument(name + "." + member, "has to be finite and not negative, or NaN");
    };
    number(material.stiffness, "stiffness");
    number(material.damping, "damping");
    number(material.static_friction, "static_friction");
    number(material.dynamic_friction, "dynamic_friction");
    number(material.viscous_friction, "viscous_friction");
}

std::string nameOr(const char* name, const char* kind, size_t number) {
    return name != nullptr ? name : std::string(kind) + " " + std::to_string(number);
}

/// The arrays of all meshes, one after the other.
class Packed {
  public:
    template <class T>
    FlatRange add(const T* values, size_t count) {
        const FlatRange range{bytes.size(), count * sizeof(T)};
        const auto* begin = reinterpret_cast<const uint8_t*>(values);
        bytes.insert(bytes.end(), begin, begin + range.bytes);
        return range;
    }
    std::vector<uint8_t> bytes;
};

FlatMesh flatMesh(const ts_mesh& mesh, size_t number, Packed& packed) {
    FlatMesh flat;
    flat.name = nameOr(mesh.name, "mesh", number);
    flat.counts.material = mesh.material;
    flat.counts.vertices = static_cast<uint32_t>(mesh.vertex_count);
    flat.counts.triangles = static_cast<uint32_t>(mesh.triangle_count);
    flat.positions = packed.add(mesh.positions, 3 * mesh.vertex_count);
    if (mesh.normals != nullptr)
        flat.normals = packed.add(mesh.normals, 3 * mesh.vertex_count);
    if (mesh.texture != nullptr)
        flat.textureCoordinates = packed.add(mesh.texture, 2 * mesh.vertex_count);
    flat.corners = packed.add(mesh.indices, 3 * mesh.triangle_count);
    return flat;
}

/// What the material states, as the extension's fields.
nlohmann::ordered_json fieldsOf(const ts_material& material) {
    nlohmann::ordered_json fields = nlohmann::ordered_json::object();
    const auto set = [&](const char* name, double value) {
        if (!std::isnan(value))
            fields[name] = value;
    };
    set("stiffness", material.stiffness);
    set("damping", material.damping);
    set("staticFriction", material.static_friction);
    set("dynamicFriction", material.dynamic_friction);
    set("viscousFriction", material.viscous_friction);
    return fields;
}

} // namespace

SceneArrays arraysOf(const ts_mesh* meshes, size_t meshCount, const ts_material* materials,
                     size_t materialCount) {
    SceneArrays arrays{structsOf(meshes, meshCount, "meshes"),
                       structsOf(materials, materialCount, "materials")};
    if (arrays.meshes.empty())
        refuseArgument("mesh_count", "is 0: there is nothing to touch");
    for (size_t i = 0; i < arrays.meshes.size(); ++i)
        check(arrays.meshes[i], entry("meshes", i), arrays.materials.size());
    for (size_t i = 0; i < arrays.materials.size(); ++i)
        check(arrays.materials[i], entry("materials", i));
    return arrays;
}

std::vector<uint8_t> glbOf(const SceneArrays& arrays) {
    FlatMeshes flat;
    Packed packed;
    for (const ts_mesh& mesh : arrays.meshes)
        flat.meshes.push_back(flatMesh(mesh, flat.meshes.size(), packed));
    MaterialPatches patches;
    for (const ts_material& material : arrays.materials) {
        if (nlohmann::ordered_json fields = fieldsOf(material); !fields.empty())
            patches.emplace(flat.materials.size(), std::move(fields));
        flat.materials.push_back(nameOr(material.name, "material", flat.materials.size()));
    }
    if (flat.materials.empty())
        flat.materials.emplace_back("material 0");
    flat.arrays = packed.bytes;
    const std::vector<uint8_t> glb = touchstone::glbOf(flat, "Touchstone " TOUCHSTONE_VERSION, "meshes");
    return withMaterials(glb, patches, "meshes");
}

} // namespace touchstone::api
