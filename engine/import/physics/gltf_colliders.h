#pragma once

#include "engine/import/physics/physics_import.h"

#include <map>
#include <string>

namespace touchstone {

/// Reads the colliders of nodes, with the shapes of KHR_implicit_shapes (or KHR_collision_shapes, their name
/// in earlier drafts); a collider's geometry is `shape`, `mesh` or `node`. Expects the file's materials and
/// bodies.
class ColliderReader {
  public:
    explicit ColliderReader(PhysicsImport& import) : import_(import) {}

    /// Adds the collider of node `n`, if it states one, to the import's. Throws what PhysicsImport::context
    /// fails with.
    void read(size_t n);

  private:
    using json = nlohmann::json;
    void readShape(const json& geometry, const std::string& place, bool earlier, Collider& collider);
    void readImplicit(const json& shape, const std::string& place, Collider& collider);
    void takeMesh(int gltfMesh, const std::string& place, Collider& collider);
    void readFilter(const json& stated, const std::string& place, Collider& collider);

    PhysicsImport& import_;
    std::map<std::string, int> systems_; // of collisions, by name: their bits
};

} // namespace touchstone
