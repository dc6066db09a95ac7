#include "engine/import/geometry/gltf_physics.h"

#include "engine/import/file/json_fields.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>

namespace touchstone {
namespace {

using nlohmann::json;

constexpr double kAny = 1e30;
constexpr const char* kPhysics = "KHR_physics_rigid_bodies";

/// Reads the extension into a Physics. Indices of the file become those of the scene.
class PhysicsReader {
  public:
    PhysicsReader(ImportContext& context, const GltfDocument& document, const NodeForest& forest,
                  const Scene& scene)
        : context_(context), document_(document), forest_(forest), scene_(scene) {}

    std::shared_ptr<const Physics> read();

  private:
    void readMaterials(const json& root);
    void readBody(size_t n);
    void readCollider(size_t n);
    void readShape(const json& geometry, const std::string& place, bool earlier, Collider& collider);
    void readImplicit(const json& shape, const std::string& place, Collider& collider);
    void takeMesh(int gltfMesh, const std::string& place, Collider& collider);
    void readFilter(const json& stated, const std::string& place, Collider& collider);
    void readJoint(size_t n);
    void readLimit(const json& limit, const std::string& place, Joint& joint);
    void readDrive(const json& drive, const std::string& place, Joint& joint);
    void readSetting(const json& ours, const std::string& place, JointSetting& setting);
    void readOurs(const json& described, const std::string& place, Joint& joint);

    [[nodiscard]] const json* statedAt(size_t n, const char* part, std::string& place) const;
    [[nodiscard]] const json* listOf(const char* extension, const char* name) const;
    [[nodiscard]] double number(const json& object, const char* name, const std::string& place, double low,
                                double high, double otherwise) const {
        return numberField(context_, object, name, place, low, high).value_or(static_cast<float>(otherwise));
    }
    [[nodiscard]] std::optional<std::vector<double>> numbers(const json& object, const char* name,
                                                             const std::string& place, size_t count) const;
    [[nodiscard]] glm::dvec3 vector(const json& object, const char* name, const std::string& place) const {
        const auto found = numbers(object, name, place, 3);
        return found ? glm::dvec3((*found)[0], (*found)[1], (*found)[2]) : glm::dvec3(0.0);
    }
    [[nodiscard]] static bool flag(const json& object, const char* name) {
        const auto found = object.find(name);
        return found != object.end() && found->is_boolean() && found->get<bool>();
    }
    [[nodiscard]] Combine combine(const json& object, const char* name, const std::string& place) const;
    /// The body of a node: of itself or of its nearest ancestor that is one; -1: it rests.
    [[nodiscard]] int bodyOf(int node) const {
        return node < 0 ? -1 : bodyOfNode_[static_cast<size_t>(node)];
    }
    [[nodiscard]] std::string placeOf(size_t n) const {
        return element("nodes", static_cast<size_t>(forest_.gltfOfNode[n])) + ".extensions." + kPhysics;
    }

    ImportContext& context_;
    const GltfDocument& document_;
    const NodeForest& forest_;
    const Scene& scene_;
    Physics physics_;
    std::vector<int> bodyOfNode_;
    std::map<std::string, int> systems_;
};

/// A part of the node's extension; null where it is absent.
const json* PhysicsReader::statedAt(size_t n, const char* part, std::string& place) const {
    const auto gltfNode = static_cast<size_t>(forest_.gltfOfNode[n]);
    const json* stated =
        extensionOf(context_, document_.json["nodes"][gltfNode], kPhysics, element("nodes", gltfNode));
    if (stated == nullptr || !stated->contains(part))
        return nullptr;
    place = placeOf(n) + "." + part;
    const json& found = (*stated)[part];
    if (!found.is_object())
        context_.fail(place, "should be an object");
    return &found;
}

/// An array of an extension of the whole file; null where it is absent.
const json* PhysicsReader::listOf(const char* extension, const char* name) const {
    const json* root = extensionOf(context_, document_.json, extension, "");
    if (root == nullptr || !root->contains(name))
        return nullptr;
    const json& list = (*root)[name];
    if (!list.is_array())
        context_.fail(std::string("extensions.") + extension + "." + name, "should be an array");
    return &list;
}

std::optional<std::vector<double>> PhysicsReader::numbers(const json& object, const char* name,
                                                          const std::string& place, size_t count) const {
    const auto found = object.find(name);
    if (found == object.end())
        return std::nullopt;
    const std::string at = place + "." + name;
    if (!found->is_array() || (count > 0 && found->size() != count))
        context_.fail(at, "should be an array" +
                              (count > 0 ? " of " + std::to_string(count) + " numbers" : std::string()));
    std::vector<double> values;
    for (const json& value : *found) {
        if (!value.is_number() || !(std::abs(value.get<double>()) < kAny))
            context_.fail(at, "has an element that is no finite number");
        values.push_back(value.get<double>());
    }
    return values;
}

Combine PhysicsReader::combine(const json& object, const char* name, const std::string& place) const {
    constexpr std::array<std::pair<const char*, Combine>, 4> kWords{{{"average", Combine::Average},
                                                                     {"minimum", Combine::Minimum},
                                                                     {"maximum", Combine::Maximum},
                                                                     {"multiply", Combine::Multiply}}};
    const auto text = textField(context_, object, name, place);
    if (!text)
        return Combine::Average;
    for (const auto& [word, value] : kWords)
        if (*text == word)
            return value;
    context_.fail(place + "." + name, "\"" + text->substr(0, 40) + "\" is not a choice",
                  "use one of: average, minimum, maximum, multiply");
}

void PhysicsReader::readMaterials(const json& root) {
    const auto list = root.find("physicsMaterials");
    if (list == root.end() || !list->is_array())
        return; // readPhysics of the materials warns
    for (size_t i = 0; i < list->size(); ++i) {
        PhysicsMaterial& material = physics_.materials.emplace_back();
        const std::string place =
            std::string("extensions.") + kPhysics + ".physicsMaterials[" + std::to_string(i) + "]";
        (void)context_.attempt("collides with the default material", [&] {
            const json& stated = (*list)[i];
            if (!stated.is_object())
                context_.fail(place, "should be an object");
            PhysicsMaterial read;
            read.staticFriction = number(stated, "staticFriction", place, 0.0, kAny, 0.6);
            read.dynamicFriction = number(stated, "dynamicFriction", place, 0.0, kAny, 0.6);
            read.restitution = number(stated, "restitution", place, 0.0, 1.0, 0.0);
            read.frictionCombine = combine(stated, "frictionCombine", place);
            read.restitutionCombine = combine(stated, "restitutionCombine", place);
            material = read;
        });
    }
}

void PhysicsReader::readBody(size_t n) {
    std::string place;
    const json* stated = statedAt(n, "motion", place);
    if (stated == nullptr)
        return;
    if (physics_.bodies.size() == kMaxBodies)
        context_.fail(place, "is beyond the " + std::to_string(kMaxBodies) + " bodies that a scene can have");
    Body body;
    body.name = scene_.nodes[n].name;
    body.node = static_cast<int>(n);
    body.kinematic = flag(*stated, "isKinematic");
    if (stated->contains("mass")) {
        const double mass = number(*stated, "mass", place, 0.0, kAny, 0.0);
        if (mass > 0.0) {
            body.mass = mass;
        } else {
            body.kinematic = true;
            context_.warn(place + ".mass", "is 0, which stands for an infinite mass: nothing moves the body");
        }
    }
    body.centreStated = stated->contains("centerOfMass");
    body.centreOfMass = vector(*stated, "centerOfMass", place);
    body.velocity = vector(*stated, "linearVelocity", place);
    body.spin = vector(*stated, "angularVelocity", place);
    body.gravityFactor = number(*stated, "gravityFactor", place, -kAny, kAny, 1.0);
    if (const auto inertia = numbers(*stated, "inertiaDiagonal", place, 3)) {
        std::vector<double> sorted = *inertia;
        std::ranges::sort(sorted);
        if (sorted[0] < 0.0)
            context_.warn(place + ".inertiaDiagonal", "is negative; it is computed from the volume");
        else if (sorted[0] > 0.0 && sorted[0] + sorted[1] < sorted[2] * (1.0 - 1e-6))
            context_.warn(place + ".inertiaDiagonal",
                          "is that of no body: one moment is more than the sum of the others; it is computed "
                          "from the volume");
        else
            body.inertia = glm::dvec3((*inertia)[0], (*inertia)[1], (*inertia)[2]);
    }
    if (const auto turn = numbers(*stated, "inertiaOrientation", place, 4)) {
        const glm::dquat q((*turn)[3], (*turn)[0], (*turn)[1], (*turn)[2]);
        if (!(glm::length(q) > 1e-6))
            context_.fail(place + ".inertiaOrientation", "is no rotation");
        body.inertiaOrientation = glm::normalize(q);
    }
    bodyOfNode_[n] = static_cast<int>(physics_.bodies.size());
    physics_.bodies.push_back(std::move(body));
}

void PhysicsReader::takeMesh(int gltfMesh, const std::string& place, Collider& collider) {
    for (const Instance& instance : scene_.instances) {
        const auto gltfNode = static_cast<size_t>(forest_.gltfOfNode[static_cast<size_t>(instance.node)]);
        if (document_.model.nodes[gltfNode].mesh == gltfMesh &&
            scene_.meshes[static_cast<size_t>(instance.mesh)].triangleCount() > 0 &&
            std::ranges::find(collider.meshes, instance.mesh) == collider.meshes.end())
            collider.meshes.push_back(instance.mesh);
    }
    if (collider.meshes.empty())
        context_.fail(place, "refers to a mesh that the scene does not show", "show it, or use a shape");
}

void PhysicsReader::readImplicit(const json& shape, const std::string& place, Collider& collider) {
    const auto type = textField(context_, shape, "type", place);
    if (!type)
        context_.fail(place, "property 'type' is missing");
    static const json kNothing = json::object();
    const auto part = shape.find(*type);
    const json& stated = part != shape.end() ? *part : kNothing;
    const std::string at = place + "." + type->substr(0, 40);
    if (!stated.is_object())
        context_.fail(at, "should be an object");
    constexpr double kLeast = 1e-9;
    if (*type == "box") {
        collider.shape = ColliderShape::Box;
        if (const auto size = numbers(stated, "size", at, 3))
            collider.size = {(*size)[0], (*size)[1], (*size)[2]};
        if (!(std::min({collider.size.x, collider.size.y, collider.size.z}) > 0.0))
            context_.fail(at + ".size", "is not positive in every direction");
        return;
    }
    if (*type == "sphere") {
        collider.shape = ColliderShape::Sphere;
        collider.radius = number(stated, "radius", at, kLeast, kAny, 0.5);
        return;
    }
    if (*type == "capsule" || *type == "cylinder") {
        collider.shape = *type == "capsule" ? ColliderShape::Capsule : ColliderShape::Cylinder;
        const double radius = number(stated, "radius", at, kLeast, kAny, 0.5); // of earlier drafts
        collider.height = number(stated, "height", at, kLeast, kAny, 0.5);
        collider.radius = number(stated, "radiusBottom", at, 0.0, kAny, radius);
        collider.top = number(stated, "radiusTop", at, 0.0, kAny, radius);
        if (!(collider.radius + collider.top > 0.0))
            context_.fail(at, "has no thickness");
        return;
    }
    if (*type == "mesh" || *type == "convex") { // of KHR_collision_shapes
        collider.shape = *type == "convex" ? ColliderShape::Hull : ColliderShape::Mesh;
        if (const json* hull = extensionOf(context_, shape, kPhysics, place);
            hull && flag(*hull, "convexHull"))
            collider.shape = ColliderShape::Hull;
        const auto mesh = indexField(context_, stated, "mesh", at, document_.model.meshes.size(), "meshes");
        if (!mesh)
            context_.fail(at, "property 'mesh' is missing");
        takeMesh(*mesh, at, collider);
        return;
    }
    context_.fail(place + ".type", "\"" + type->substr(0, 40) + "\" is not known");
}

/// `earlier`: as in the draft before KHR_implicit_shapes.
void PhysicsReader::readShape(const json& geometry, const std::string& place, bool earlier,
                              Collider& collider) {
    if (geometry.contains("shape")) {
        const char *extension = "KHR_implicit_shapes", *other = "KHR_collision_shapes";
        if (earlier)
            std::swap(extension, other);
        const json* shapes = listOf(extension, "shapes");
        if (shapes == nullptr)
            shapes = listOf(extension = other, "shapes");
        const auto index =
            indexField(context_, geometry, "shape", place, shapes != nullptr ? shapes->size() : 0, "shapes");
        const json& shape = (*shapes)[static_cast<size_t>(*index)];
        const std::string at =
            std::string("extensions.") + extension + ".shapes[" + std::to_string(*index) + "]";
        if (!shape.is_object())
            context_.fail(at, "should be an object");
        return readImplicit(shape, at, collider);
    }
    collider.shape = flag(geometry, "convexHull") ? ColliderShape::Hull : ColliderShape::Mesh;
    if (const auto mesh =
            indexField(context_, geometry, "mesh", place, document_.model.meshes.size(), "meshes"))
        return takeMesh(*mesh, place, collider);
    const auto node = indexField(context_, geometry, "node", place, document_.model.nodes.size(), "nodes");
    if (!node)
        context_.fail(place, "has neither a shape nor a mesh nor a node");
    const int mesh = document_.model.nodes[static_cast<size_t>(*node)].mesh;
    if (mesh < 0)
        context_.fail(place + ".node", "refers to a node without a mesh");
    collider.node = forest_.nodeOfGltf[static_cast<size_t>(*node)];
    takeMesh(mesh, place, collider);
}

void PhysicsReader::readFilter(const json& stated, const std::string& place, Collider& collider) {
    const json* filters = listOf(kPhysics, "collisionFilters");
    const auto index = indexField(context_, stated, "collisionFilter", place,
                                  filters != nullptr ? filters->size() : 0, "collisionFilters");
    if (!index)
        return;
    const json& filter = (*filters)[static_cast<size_t>(*index)];
    const std::string at =
        std::string("extensions.") + kPhysics + ".collisionFilters[" + std::to_string(*index) + "]";
    if (!filter.is_object())
        context_.fail(at, "should be an object");
    const auto bits = [&](const char* name) -> std::optional<uint64_t> {
        const auto list = filter.find(name);
        if (list == filter.end())
            return std::nullopt;
        if (!list->is_array())
            context_.fail(at + "." + name, "should be an array");
        uint64_t mask = 0;
        for (const json& system : *list) {
            if (!system.is_string())
                context_.fail(at + "." + name, "should hold names");
            const auto found =
                systems_.try_emplace(system.get<std::string>(), static_cast<int>(systems_.size())).first;
            if (found->second >= 64)
                context_.fail(at, "names more than 64 systems");
            mask |= uint64_t{1} << found->second;
        }
        return mask;
    };
    collider.systems = bits("collisionSystems").value_or(0);
    collider.collides = bits("collideWithSystems");
    collider.collidesNot = bits("notCollideWithSystems");
}

void PhysicsReader::readCollider(size_t n) {
    std::string place;
    const json* stated = statedAt(n, "collider", place);
    if (stated == nullptr)
        return;
    Collider collider;
    collider.node = static_cast<int>(n);
    collider.body = bodyOf(collider.node);
    if (stated->contains("geometry") && (*stated)["geometry"].is_object())
        readShape((*stated)["geometry"], place + ".geometry", false, collider);
    else if (stated->contains("shape"))
        readShape(*stated, place, true, collider);
    else if (const int mesh = document_.model.nodes[static_cast<size_t>(forest_.gltfOfNode[n])].mesh;
             mesh >= 0) {
        collider.shape = ColliderShape::Mesh; // a collider with a friction alone, of our earlier scenes
        takeMesh(mesh, place, collider);
    } else {
        return; // a friction for the mesh above it
    }
    if (collider.shape == ColliderShape::Mesh && collider.body >= 0) {
        collider.shape = ColliderShape::Hull;
        const auto body = static_cast<size_t>(collider.body);
        if (!physics_.bodies[body].kinematic && !flag((*stated), "convexHull"))
            context_.warn(place, "is a mesh that moves: it collides as its convex hull");
    }
    collider.material =
        indexField(context_, *stated, "physicsMaterial", place, physics_.materials.size(), "physicsMaterials")
            .value_or(-1);
    readFilter(*stated, place, collider);
    if (physics_.colliders.size() == kMaxColliders)
        context_.fail(place,
                      "is beyond the " + std::to_string(kMaxColliders) + " colliders that a scene can have");
    physics_.colliders.push_back(std::move(collider));
}

void PhysicsReader::readLimit(const json& limit, const std::string& place, Joint& joint) {
    if (!limit.is_object())
        context_.fail(place, "should be an object");
    const double low = number(limit, "min", place, -kAny, kAny, -std::numeric_limits<double>::infinity()),
                 high = number(limit, "max", place, -kAny, kAny, std::numeric_limits<double>::infinity());
    if (!(low <= high))
        context_.fail(place, "has a 'min' above its 'max'");
    for (const auto& [name, first] : {std::pair{"linearAxes", 0}, std::pair{"angularAxes", 3}}) {
        const auto axes = numbers(limit, name, place, 0);
        if (!axes)
            continue;
        for (const double axis : *axes) {
            if (!(axis == 0.0 || axis == 1.0 || axis == 2.0))
                context_.fail(place + "." + name, "has an axis that is not 0, 1 or 2");
            JointAxis& to = joint.axes[static_cast<size_t>(first + static_cast<int>(axis))];
            to.min = low;
            to.max = high;
            if (limit.contains("stiffness"))
                to.limitStiffness = number(limit, "stiffness", place, 0.0, kAny, 0.0);
            to.limitDamping = number(limit, "damping", place, 0.0, kAny, 0.0);
        }
    }
}

void PhysicsReader::readDrive(const json& drive, const std::string& place, Joint& joint) {
    if (!drive.is_object())
        context_.fail(place, "should be an object");
    const auto type = textField(context_, drive, "type", place),
               mode = textField(context_, drive, "mode", place);
    if (!type || (*type != "linear" && *type != "angular"))
        context_.fail(place + ".type", "is neither linear nor angular");
    const auto axis = indexField(context_, drive, "axis", place, 3, "axes");
    if (!axis)
        context_.fail(place, "property 'axis' is missing");
    JointAxis& to = joint.axes[static_cast<size_t>(*axis + (*type == "angular" ? 3 : 0))];
    to.driven = true;
    to.acceleration = mode && *mode == "acceleration";
    to.maxForce = number(drive, "maxForce", place, 0.0, kAny, std::numeric_limits<double>::infinity());
    to.target = number(drive, "positionTarget", place, -kAny, kAny, 0.0);
    to.targetSpeed = number(drive, "velocityTarget", place, -kAny, kAny, 0.0);
    to.stiffness = number(drive, "stiffness", place, 0.0, kAny, 0.0);
    to.damping = number(drive, "damping", place, 0.0, kAny, 0.0);
}

/// TOUCHSTONE_joint: the setting of the session that the joint is for. Whether there is one of this name is
/// found where bodies are made.
void PhysicsReader::readSetting(const json& ours, const std::string& place, JointSetting& setting) {
    const auto name = ours.find("setting");
    if (name == ours.end())
        return;
    if (!name->is_string() || name->get_ref<const std::string&>().empty())
        context_.fail(place + ".setting", "should be the name of a setting");
    setting.name = name->get<std::string>();
    setting.steps = flag(ours, "press");
    if (const auto values = ours.find("values"); values != ours.end()) {
        if (!values->is_array() || values->size() < 2 || values->size() > 1024)
            context_.fail(place + ".values", "should be an array of 2 to 1024 values");
        for (const json& value : *values) {
            if (!value.is_string() && !value.is_number())
                context_.fail(place + ".values", "should hold words or numbers");
            setting.values.push_back(value.is_string() ? value.get<std::string>() : value.dump());
        }
        return;
    }
    if (setting.steps)
        context_.fail(place + ".press", "needs 'values' to step through");
    setting.from = number(ours, "from", place, -kAny, kAny, 0.0);
    setting.to = number(ours, "to", place, -kAny, kAny, 0.0);
    if (setting.from == setting.to)
        context_.fail(place, "has a setting, but neither 'values' nor a range 'from' .. 'to'");
}

/// TOUCHSTONE_joint: a thread, friction and detents, which the standard cannot state.
void PhysicsReader::readOurs(const json& described, const std::string& place, Joint& joint) {
    const json* ours = extensionOf(context_, described, "TOUCHSTONE_joint", place);
    if (ours == nullptr)
        return;
    const std::string at = place + ".extensions.TOUCHSTONE_joint";
    if (ours->contains("pitch")) {
        joint.pitch = number(*ours, "pitch", at, -kAny, kAny, 0.0);
        if (*joint.pitch == 0.0)
            context_.fail(at + ".pitch", "is 0: a thread without a way");
        if (joint.axes[0].locked() || joint.axes[3].locked())
            context_.fail(at + ".pitch", "needs a way along x and a turn about x, and one of them is locked");
    }
    joint.friction = number(*ours, "friction", at, 0.0, kAny, 0.0);
    joint.detentForce = number(*ours, "detentForce", at, 0.0, kAny, 0.0);
    if (const auto detents = numbers(*ours, "detents", at, 0)) {
        if (detents->size() > 1024)
            context_.fail(at + ".detents", "has more than 1024 elements");
        if (!std::ranges::is_sorted(*detents) || std::ranges::adjacent_find(*detents) != detents->end())
            context_.fail(at + ".detents", "should ascend");
        joint.detents = *detents;
    }
    readSetting(*ours, at, joint.setting);
}

void PhysicsReader::readJoint(size_t n) {
    std::string place;
    const json* stated = statedAt(n, "joint", place);
    if (stated == nullptr)
        return;
    if (physics_.joints.size() == kMaxBodyJoints)
        context_.fail(place,
                      "is beyond the " + std::to_string(kMaxBodyJoints) + " joints that a scene can have");
    Joint joint;
    joint.name = scene_.nodes[n].name;
    joint.node = static_cast<int>(n);
    const auto other =
        indexField(context_, *stated, "connectedNode", place, document_.model.nodes.size(), "nodes");
    if (!other)
        context_.fail(place, "leads nowhere: property 'connectedNode' is missing");
    joint.connected = forest_.nodeOfGltf[static_cast<size_t>(*other)];
    joint.body = bodyOf(joint.node);
    joint.connectedBody = bodyOf(joint.connected);
    if (joint.body == joint.connectedBody)
        context_.fail(place, joint.body < 0 ? "joins two nodes that do not move"
                                            : "joins two nodes of the same body");
    joint.collides = flag(*stated, "enableCollision");
    const json* described = listOf(kPhysics, "physicsJoints");
    const auto index = indexField(context_, *stated, "joint", place,
                                  described != nullptr ? described->size() : 0, "physicsJoints");
    if (!index)
        context_.fail(place, "property 'joint' is missing");
    const json& description = (*described)[static_cast<size_t>(*index)];
    const std::string at =
        std::string("extensions.") + kPhysics + ".physicsJoints[" + std::to_string(*index) + "]";
    if (!description.is_object())
        context_.fail(at, "should be an object");
    const auto each = [&](const char* name, auto&& read) {
        if (!description.contains(name))
            return;
        if (!description[name].is_array())
            context_.fail(at + "." + name, "should be an array");
        for (size_t i = 0; i < description[name].size(); ++i)
            read(description[name][i], at + "." + name + "[" + std::to_string(i) + "]");
    };
    each("limits", [&](const json& limit, const std::string& where) { readLimit(limit, where, joint); });
    each("drives", [&](const json& drive, const std::string& where) { readDrive(drive, where, joint); });
    readOurs(description, at, joint);
    physics_.joints.push_back(std::move(joint));
}

std::shared_ptr<const Physics> PhysicsReader::read() {
    bool stated = false;
    for (const json& node : document_.json.value("nodes", json::array()))
        stated = stated || (node.contains("extensions") && node["extensions"].is_object() &&
                            node["extensions"].contains(kPhysics));
    if (!stated)
        return nullptr;
    (void)context_.attempt("collides with the default material", [&] {
        if (const json* root = extensionOf(context_, document_.json, kPhysics, ""))
            readMaterials(*root);
    });
    bodyOfNode_.assign(scene_.nodes.size(), -1);
    for (size_t n = 0; n < scene_.nodes.size(); ++n) { // parents come before children
        if (scene_.nodes[n].parent >= 0)
            bodyOfNode_[n] = bodyOfNode_[static_cast<size_t>(scene_.nodes[n].parent)];
        if (forest_.shown[n])
            (void)context_.attempt("the body stays where it is", [&] { readBody(n); });
    }
    if (std::ranges::all_of(physics_.bodies, [](const Body& body) { return body.kinematic; }))
        return nullptr;
    for (size_t n = 0; n < scene_.nodes.size(); ++n) {
        if (!forest_.shown[n])
            continue;
        (void)context_.attempt("nothing collides there", [&] { readCollider(n); });
        (void)context_.attempt("the joint is left out", [&] { readJoint(n); });
    }
    return std::make_shared<const Physics>(std::move(physics_));
}

} // namespace

std::shared_ptr<const Physics> readPhysicsBodies(ImportContext& context, const GltfDocument& document,
                                                 const NodeForest& forest, const Scene& scene) {
    return PhysicsReader(context, document, forest, scene).read();
}

} // namespace touchstone
