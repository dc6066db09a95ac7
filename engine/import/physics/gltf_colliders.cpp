#include "engine/import/physics/gltf_colliders.h"

#include <algorithm>
#include <utility>

namespace touchstone {

using nlohmann::json;

void ColliderReader::takeMesh(int gltfMesh, const std::string& place, Collider& collider) {
    for (const Instance& instance : import_.scene.instances) {
        const auto gltfNode =
            static_cast<size_t>(import_.forest.gltfOfNode[static_cast<size_t>(instance.node)]);
        if (import_.document.model.nodes[gltfNode].mesh == gltfMesh &&
            import_.scene.meshes[static_cast<size_t>(instance.mesh)].triangleCount() > 0 &&
            std::ranges::find(collider.meshes, instance.mesh) == collider.meshes.end())
            collider.meshes.push_back(instance.mesh);
    }
    if (collider.meshes.empty())
        import_.context.fail(place, "refers to a mesh that the scene does not show",
                             "show it, or use a shape");
}

void ColliderReader::readImplicit(const json& shape, const std::string& place, Collider& collider) {
    const auto type = textField(import_.context, shape, "type", place);
    if (!type)
        import_.context.fail(place, "property 'type' is missing");
    static const json kNothing = json::object();
    const auto part = shape.find(*type);
    const json& stated = part != shape.end() ? *part : kNothing;
    const std::string at = place + "." + type->substr(0, 40);
    if (!stated.is_object())
        import_.context.fail(at, "should be an object");
    constexpr double kLeast = 1e-9;
    if (*type == "box") {
        collider.shape = ColliderShape::Box;
        if (const auto size = import_.numbers(stated, "size", at, 3))
            collider.size = {(*size)[0], (*size)[1], (*size)[2]};
        if (!(std::min({collider.size.x, collider.size.y, collider.size.z}) > 0.0))
            import_.context.fail(at + ".size", "is not positive in every direction");
        return;
    }
    if (*type == "sphere") {
        collider.shape = ColliderShape::Sphere;
        collider.radius = import_.number(stated, "radius", at, kLeast, import_.kAny, 0.5);
        return;
    }
    if (*type == "capsule" || *type == "cylinder") {
        collider.shape = *type == "capsule" ? ColliderShape::Capsule : ColliderShape::Cylinder;
        const double radius =
            import_.number(stated, "radius", at, kLeast, import_.kAny, 0.5); // of earlier drafts
        collider.height = import_.number(stated, "height", at, kLeast, import_.kAny, 0.5);
        collider.radius = import_.number(stated, "radiusBottom", at, 0.0, import_.kAny, radius);
        collider.top = import_.number(stated, "radiusTop", at, 0.0, import_.kAny, radius);
        if (!(collider.radius + collider.top > 0.0))
            import_.context.fail(at, "has no thickness");
        return;
    }
    if (*type == "mesh" || *type == "convex") { // of KHR_collision_shapes
        collider.shape = *type == "convex" ? ColliderShape::Hull : ColliderShape::Mesh;
        if (const json* hull = extensionOf(import_.context, shape, import_.kPhysics, place);
            hull && import_.flag(*hull, "convexHull"))
            collider.shape = ColliderShape::Hull;
        const auto mesh =
            indexField(import_.context, stated, "mesh", at, import_.document.model.meshes.size(), "meshes");
        if (!mesh)
            import_.context.fail(at, "property 'mesh' is missing");
        takeMesh(*mesh, at, collider);
        return;
    }
    import_.context.fail(place + ".type", "\"" + type->substr(0, 40) + "\" is not known");
}

/// `earlier`: as in the draft before KHR_implicit_shapes.
void ColliderReader::readShape(const json& geometry, const std::string& place, bool earlier,
                               Collider& collider) {
    if (geometry.contains("shape")) {
        const char *extension = "KHR_implicit_shapes", *other = "KHR_collision_shapes";
        if (earlier)
            std::swap(extension, other);
        const json* shapes = import_.listOf(extension, "shapes");
        if (shapes == nullptr)
            shapes = import_.listOf(extension = other, "shapes");
        const auto index = indexField(import_.context, geometry, "shape", place,
                                      shapes != nullptr ? shapes->size() : 0, "shapes");
        const json& shape = (*shapes)[static_cast<size_t>(*index)];
        const std::string at =
            std::string("extensions.") + extension + ".shapes[" + std::to_string(*index) + "]";
        if (!shape.is_object())
            import_.context.fail(at, "should be an object");
        return readImplicit(shape, at, collider);
    }
    collider.shape = import_.flag(geometry, "convexHull") ? ColliderShape::Hull : ColliderShape::Mesh;
    if (const auto mesh = indexField(import_.context, geometry, "mesh", place,
                                     import_.document.model.meshes.size(), "meshes"))
        return takeMesh(*mesh, place, collider);
    const auto node =
        indexField(import_.context, geometry, "node", place, import_.document.model.nodes.size(), "nodes");
    if (!node)
        import_.context.fail(place, "has neither a shape nor a mesh nor a node");
    const int mesh = import_.document.model.nodes[static_cast<size_t>(*node)].mesh;
    if (mesh < 0)
        import_.context.fail(place + ".node", "refers to a node without a mesh");
    collider.node = import_.forest.nodeOfGltf[static_cast<size_t>(*node)];
    takeMesh(mesh, place, collider);
}

void ColliderReader::readFilter(const json& stated, const std::string& place, Collider& collider) {
    const json* filters = import_.listOf(import_.kPhysics, "collisionFilters");
    const auto index = indexField(import_.context, stated, "collisionFilter", place,
                                  filters != nullptr ? filters->size() : 0, "collisionFilters");
    if (!index)
        return;
    const json& filter = (*filters)[static_cast<size_t>(*index)];
    const std::string at =
        std::string("extensions.") + import_.kPhysics + ".collisionFilters[" + std::to_string(*index) + "]";
    if (!filter.is_object())
        import_.context.fail(at, "should be an object");
    const auto bits = [&](const char* name) -> std::optional<uint64_t> {
        const auto list = filter.find(name);
        if (list == filter.end())
            return std::nullopt;
        if (!list->is_array())
            import_.context.fail(at + "." + name, "should be an array");
        uint64_t mask = 0;
        for (const json& system : *list) {
            if (!system.is_string())
                import_.context.fail(at + "." + name, "should hold names");
            const auto found =
                systems_.try_emplace(system.get<std::string>(), static_cast<int>(systems_.size())).first;
            if (found->second >= 64)
                import_.context.fail(at, "names more than 64 systems");
            mask |= uint64_t{1} << found->second;
        }
        return mask;
    };
    collider.systems = bits("collisionSystems").value_or(0);
    collider.collides = bits("collideWithSystems");
    collider.collidesNot = bits("notCollideWithSystems");
}

void ColliderReader::read(size_t n) {
    std::string place;
    const json* stated = import_.statedAt(n, "collider", place);
    if (stated == nullptr)
        return;
    Collider collider;
    collider.node = static_cast<int>(n);
    collider.body = import_.bodyOf(collider.node);
    if (stated->contains("geometry") && (*stated)["geometry"].is_object())
        readShape((*stated)["geometry"], place + ".geometry", false, collider);
    else if (stated->contains("shape"))
        readShape(*stated, place, true, collider);
    else if (const int mesh =
                 import_.document.model.nodes[static_cast<size_t>(import_.forest.gltfOfNode[n])].mesh;
             mesh >= 0) {
        collider.shape = ColliderShape::Mesh; // a collider with a friction alone, of our earlier scenes
        takeMesh(mesh, place, collider);
    } else {
        return; // a friction for the mesh above it
    }
    if (collider.shape == ColliderShape::Mesh && collider.body >= 0) {
        collider.shape = ColliderShape::Hull;
        const auto body = static_cast<size_t>(collider.body);
        if (!import_.physics.bodies[body].kinematic && !import_.flag((*stated), "convexHull"))
            import_.context.warn(place, "is a mesh that moves: it collides as its convex hull");
    }
    collider.material = indexField(import_.context, *stated, "physicsMaterial", place,
                                   import_.physics.materials.size(), "physicsMaterials")
                            .value_or(-1);
    readFilter(*stated, place, collider);
    if (import_.physics.colliders.size() == kMaxColliders)
        import_.context.fail(place, "is beyond the " + std::to_string(kMaxColliders) +
                                        " colliders that a scene can have");
    import_.physics.colliders.push_back(std::move(collider));
}

} // namespace touchstone
