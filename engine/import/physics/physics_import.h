#pragma once
// What the parts of KHR_physics_rigid_bodies share while a file is read: where nodes and the file state them,
// their numbers, and what was read before.

#include "engine/import/file/json_fields.h"
#include "engine/import/geometry/gltf_nodes.h"
#include "engine/scene/physics.h"
#include "engine/scene/scene.h"

#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// One file being read. Indices of the file become those of the scene.
struct PhysicsImport {
    static constexpr double kAny = 1e30;
    static constexpr const char* kPhysics = "KHR_physics_rigid_bodies";
    using json = nlohmann::json;

    ImportContext& context;
    const GltfDocument& document;
    const NodeForest& forest;
    const Scene& scene; ///< its nodes and instances

    Physics physics{};
    std::vector<int> bodyOfNode = std::vector<int>(scene.nodes.size(), -1);

    /// The body of a node: of itself or of its nearest ancestor that is one; -1: it rests.
    [[nodiscard]] int bodyOf(int node) const { return node < 0 ? -1 : bodyOfNode[static_cast<size_t>(node)]; }
    /// A part of the node's extension, and its place; null where it is absent.
    [[nodiscard]] const json* statedAt(size_t n, const char* part, std::string& place) const;
    /// An array of an extension of the whole file; null where it is absent.
    [[nodiscard]] const json* listOf(const char* extension, const char* name) const;
    [[nodiscard]] double number(const json& object, const char* name, const std::string& place, double low,
                                double high, double otherwise) const {
        return numberField(context, object, name, place, low, high).value_or(static_cast<float>(otherwise));
    }
    /// `count` 0: any number of them. Empty if absent.
    [[nodiscard]] std::optional<std::vector<double>> numbers(const json& object, const char* name,
                                                             const std::string& place, size_t count) const;
    [[nodiscard]] static bool flag(const json& object, const char* name) {
        const auto found = object.find(name);
        return found != object.end() && found->is_boolean() && found->get<bool>();
    }
    [[nodiscard]] std::string placeOf(size_t n) const {
        return element("nodes", static_cast<size_t>(forest.gltfOfNode[n])) + ".extensions." + kPhysics;
    }
};

} // namespace touchstone
