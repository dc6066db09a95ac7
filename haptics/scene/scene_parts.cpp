#include "haptics/scene/scene_parts.h"

#include "engine/scene/clip_mesh.h"
#include "haptics/program/felt_program.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/scene/shape_object.h"
#include "haptics/shape/field/cut_field.h"

#include <optional>
#include <utility>

namespace touchstone {

namespace {

/// Keeps name, material, pose and size, for what names the object.
std::shared_ptr<const HapticObject> emptied(const HapticObject& object) {
    auto empty = std::make_shared<HapticObject>();
    empty->name = object.name;
    empty->instance = object.instance;
    empty->material = object.material;
    empty->workspaceFromObject = object.workspaceFromObject;
    empty->objectFromMesh = object.objectFromMesh;
    empty->diagonal = object.diagonal;
    empty->oneSided = object.oneSided;
    empty->vertices.emplace_back(0.0f); // spare, as in every object
    return empty;
}

/// Cuts the objects of one scene by one plane.
class ObjectCutter {
  public:
    ObjectCutter(const HapticScene& whole, const Scene& source, const ClipPlane& plane)
        : whole_(whole), source_(source), plane_(plane) {
        cut_.path = source.path;
        cut_.instances = source.instances;
        cut_.meshes.resize(1);
    }

    std::shared_ptr<const HapticObject> cut(const std::shared_ptr<const HapticObject>& object,
                                            const Progress& progress) {
        const glm::dvec4 sphere =
            boundingSphere(*object, whole_.workspaceFromScene.inverse() * object->workspaceFromObject);
        const double distance = plane_.distance(glm::dvec3(sphere));
        if (distance <= -sphere.w)
            return object;
        if (distance > sphere.w)
            return emptied(*object);
        const auto i = static_cast<size_t>(object->instance);
        Instance& instance = cut_.instances[i];
        const Mesh& mesh = source_.meshes[static_cast<size_t>(source_.instances[i].mesh)];
        instance.mesh = 0;
        std::optional<Mesh> left = clippedMesh(mesh, planeInMesh(plane_, instance.sceneFromMesh),
                                               clipTolerance(mesh, instance.sceneFromMesh));
        // A field, too: a plane beside its body would leave a cap of it within the proxy's radius.
        if (left && left->indices.empty())
            return emptied(*object);
        if (object->shape != nullptr)
            return cutShape(*object);
        if (!left)
            return object; // its sphere crosses the plane, but no triangle does
        cut_.meshes[0] = *std::move(left);
        const auto& material = whole_.materials[static_cast<size_t>(object->material)];
        return buildCutObject(cut_, object->instance, mesh, whole_.workspaceFromScene,
                              meshUse(material, object->oneSided), progress);
    }

  private:
    /// The field's part as a body with a face; every shape that a file names is a field.
    [[nodiscard]] std::shared_ptr<const HapticObject> cutShape(const HapticObject& object) const {
        const auto field = std::dynamic_pointer_cast<const FieldShape>(object.shape);
        const Similarity place = whole_.workspaceFromScene.inverseTimes(object.workspaceFromObject);
        const glm::dvec3 normal = glm::conjugate(place.rotation) * plane_.normal;
        const double offset = -plane_.distance(place.translation) / place.scale;
        return withShape(object, std::make_shared<CutField>(field, normal, offset));
    }

    const HapticScene& whole_;
    const Scene& source_;
    const ClipPlane& plane_;
    Scene cut_; // the source's instances, and the mesh that is being cut
};

} // namespace

ObjectUse meshUse(const HapticMaterialData& material, bool oneSided) {
    ObjectUse use;
    use.oneSided = oneSided;
    for (const HapticMap* map : {&material.normal, &material.height, &material.friction.map,
                                 &material.stiffnessMap.map, &material.dampingMap.map})
        if (!map->empty())
            use.uv[map->layout().texCoord & 1] = true;
    if (!material.height.empty())
        use.uvGradients[material.height.layout().texCoord & 1] = true;
    if (material.program != nullptr && material.program->usesCoordinates)
        use.uv[0] = true;
    use.tangents = !material.normal.empty();
    use.normals = material.shading != ShadingMode::Off;
    return use;
}

std::shared_ptr<HapticScene> partOf(const HapticScene& whole, const Scene& source, const ScenePart& part,
                                    const Progress& progress) {
    const std::shared_ptr<HapticScene> felt = copyOf(whole);
    felt->warnings = whole.warnings;
    const std::vector<bool> hidden = hiddenInstances(source, part);
    std::optional<ObjectCutter> cutter;
    if (part.clip)
        cutter.emplace(whole, source, *part.clip);
    const size_t count = felt->objects.size();
    for (size_t k = 0; k < count; ++k) {
        std::shared_ptr<const HapticObject>& object = felt->objects[k];
        if (object->instance < 0)
            continue; // a shape that is in no file
        const auto i = static_cast<size_t>(object->instance);
        if (hidden[i])
            object = emptied(*object);
        else if (cutter)
            object =
                cutter->cut(object, progress.part(static_cast<double>(k) / static_cast<double>(count),
                                                  static_cast<double>(k + 1) / static_cast<double>(count)));
        felt->restMotions[k] = {object->workspaceFromObject, object->workspaceFromObject};
        felt->restSpheres[k] = boundingSphere(*object, object->workspaceFromObject);
        felt->boundingRadii[k] = object->boundingRadius;
    }
    // Texels are those of the whole: what touch has made of a texture stays while the plane moves, and a
    // hidden object keeps its own.
    if (whole.wholeObjects.empty())
        felt->wholeObjects = whole.objects;
    if (whole.hasRays())
        felt->buildRays(); // of the objects that are new
    return felt;
}

} // namespace touchstone
