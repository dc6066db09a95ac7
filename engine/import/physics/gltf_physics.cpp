#include "engine/import/physics/gltf_physics.h"

#include "engine/import/physics/gltf_colliders.h"
#include "engine/import/physics/gltf_joints.h"

#include <algorithm>
#include <array>
#include <utility>

namespace touchstone {
namespace {

using nlohmann::json;

/// Reads the extension into a Physics.
class PhysicsReader {
  public:
    explicit PhysicsReader(PhysicsImport& import) : import_(import) {}

    std::shared_ptr<const Physics> read();

  private:
    void readMaterials(const json& root);
    void readBody(size_t n);
    [[nodiscard]] glm::dvec3 vector(const json& object, const char* name, const std::string& place) const {
        const auto found = import_.numbers(object, name, place, 3);
        return found ? glm::dvec3((*found)[0], (*found)[1], (*found)[2]) : glm::dvec3(0.0);
    }
    [[nodiscard]] Combine combine(const json& object, const char* name, const std::string& place) const;

    PhysicsImport& import_;
};

Combine PhysicsReader::combine(const json& object, const char* name, const std::string& place) const {
    constexpr std::array<std::pair<const char*, Combine>, 4> kWords{{{"average", Combine::Average},
                                                                     {"minimum", Combine::Minimum},
                                                                     {"maximum", Combine::Maximum},
                                                                     {"multiply", Combine::Multiply}}};
    const auto text = textField(import_.context, object, name, place);
    if (!text)
        return Combine::Average;
    for (const auto& [word, value] : kWords)
        if (*text == word)
            return value;
    import_.context.fail(place + "." + name, "\"" + text->substr(0, 40) + "\" is not a choice",
                         "use one of: average, minimum, maximum, multiply");
}

void PhysicsReader::readMaterials(const json& root) {
    const auto list = root.find("physicsMaterials");
    if (list == root.end() || !list->is_array())
        return; // readPhysics of the materials warns
    for (size_t i = 0; i < list->size(); ++i) {
        PhysicsMaterial& material = import_.physics.materials.emplace_back();
        const std::string place =
            std::string("extensions.") + import_.kPhysics + ".physicsMaterials[" + std::to_string(i) + "]";
        (void)import_.context.attempt("collides with the default material", [&] {
            const json& stated = (*list)[i];
            if (!stated.is_object())
                import_.context.fail(place, "should be an object");
            PhysicsMaterial read;
            read.staticFriction = import_.number(stated, "staticFriction", place, 0.0, import_.kAny, 0.6);
            read.dynamicFriction = import_.number(stated, "dynamicFriction", place, 0.0, import_.kAny, 0.6);
            read.restitution = import_.number(stated, "restitution", place, 0.0, 1.0, 0.0);
            read.frictionCombine = combine(stated, "frictionCombine", place);
            read.restitutionCombine = combine(stated, "restitutionCombine", place);
            material = read;
        });
    }
}

void PhysicsReader::readBody(size_t n) {
    std::string place;
    const json* stated = import_.statedAt(n, "motion", place);
    if (stated == nullptr)
        return;
    if (import_.physics.bodies.size() == kMaxBodies)
        import_.context.fail(place,
                             "is beyond the " + std::to_string(kMaxBodies) + " bodies that a scene can have");
    Body body;
    body.name = import_.scene.nodes[n].name;
    body.node = static_cast<int>(n);
    body.kinematic = import_.flag(*stated, "isKinematic");
    if (stated->contains("mass")) {
        const double mass = import_.number(*stated, "mass", place, 0.0, import_.kAny, 0.0);
        if (mass > 0.0) {
            body.mass = mass;
        } else {
            body.kinematic = true;
            import_.context.warn(place + ".mass",
                                 "is 0, which stands for an infinite mass: nothing moves the body");
        }
    }
    body.centreStated = stated->contains("centerOfMass");
    body.centreOfMass = vector(*stated, "centerOfMass", place);
    body.velocity = vector(*stated, "linearVelocity", place);
    body.spin = vector(*stated, "angularVelocity", place);
    body.gravityFactor = import_.number(*stated, "gravityFactor", place, -import_.kAny, import_.kAny, 1.0);
    if (const auto inertia = import_.numbers(*stated, "inertiaDiagonal", place, 3)) {
        std::vector<double> sorted = *inertia;
        std::ranges::sort(sorted);
        if (sorted[0] < 0.0)
            import_.context.warn(place + ".inertiaDiagonal", "is negative; it is computed from the volume");
        else if (sorted[0] > 0.0 && sorted[0] + sorted[1] < sorted[2] * (1.0 - 1e-6))
            import_.context.warn(
                place + ".inertiaDiagonal",
                "is that of no body: one moment is more than the sum of the others; it is computed "
                "from the volume");
        else
            body.inertia = glm::dvec3((*inertia)[0], (*inertia)[1], (*inertia)[2]);
    }
    if (const auto turn = import_.numbers(*stated, "inertiaOrientation", place, 4)) {
        const glm::dquat q((*turn)[3], (*turn)[0], (*turn)[1], (*turn)[2]);
        if (!(glm::length(q) > 1e-6))
            import_.context.fail(place + ".inertiaOrientation", "is no rotation");
        body.inertiaOrientation = glm::normalize(q);
    }
    import_.bodyOfNode[n] = static_cast<int>(import_.physics.bodies.size());
    import_.physics.bodies.push_back(std::move(body));
}

std::shared_ptr<const Physics> PhysicsReader::read() {
    bool stated = false;
    for (const json& node : import_.document.json.value("nodes", json::array()))
        stated = stated || (node.contains("extensions") && node["extensions"].is_object() &&
                            node["extensions"].contains(import_.kPhysics));
    if (!stated)
        return nullptr;
    (void)import_.context.attempt("collides with the default material", [&] {
        if (const json* root = extensionOf(import_.context, import_.document.json, import_.kPhysics, ""))
            readMaterials(*root);
    });
    for (size_t n = 0; n < import_.scene.nodes.size(); ++n) { // parents come before children
        if (import_.scene.nodes[n].parent >= 0)
            import_.bodyOfNode[n] = import_.bodyOfNode[static_cast<size_t>(import_.scene.nodes[n].parent)];
        if (import_.forest.shown[n])
            (void)import_.context.attempt("the body stays where it is", [&] { readBody(n); });
    }
    if (std::ranges::all_of(import_.physics.bodies, [](const Body& body) { return body.kinematic; }))
        return nullptr;
    ColliderReader colliders(import_);
    JointReader joints(import_);
    for (size_t n = 0; n < import_.scene.nodes.size(); ++n) {
        if (!import_.forest.shown[n])
            continue;
        (void)import_.context.attempt("nothing collides there", [&] { colliders.read(n); });
        (void)import_.context.attempt("the joint is left out", [&] { joints.read(n); });
    }
    return std::make_shared<const Physics>(std::move(import_.physics));
}

} // namespace

std::shared_ptr<const Physics> readPhysicsBodies(ImportContext& context, const GltfDocument& document,
                                                 const NodeForest& forest, const Scene& scene) {
    PhysicsImport import{.context = context, .document = document, .forest = forest, .scene = scene};
    return PhysicsReader(import).read();
}

} // namespace touchstone
