#pragma once
// Rigid bodies, colliders and joints of a file (KHR_physics_rigid_bodies with KHR_implicit_shapes), as it
// states them. Indices are valid; numbers are finite and in their ranges.

#include <glm/glm.hpp>
#include <glm/gtc/quaternion.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

/// How two materials become one; of two different ones that which comes first here applies.
enum class Combine : uint8_t { Average, Minimum, Maximum, Multiply };

struct PhysicsMaterial {
    double staticFriction = 0.6, dynamicFriction = 0.6; ///< >= 0
    double restitution = 0.0;                           ///< 0..1
    Combine frictionCombine = Combine::Average, restitutionCombine = Combine::Average;
};

/// A node that moves, with all its descendants that are no bodies of their own. SI, the node's frame.
struct Body {
    std::string name;
    int node = -1;                     ///< Scene::nodes
    bool kinematic = false;            ///< nothing pushes it
    std::optional<double> mass;        ///< kg, > 0; else that of its volume with the density of water
    glm::dvec3 centreOfMass{0.0};      ///< m
    bool centreStated = false;         ///< else that of its volume
    std::optional<glm::dvec3> inertia; ///< kg m^2, principal; 0 in a component: it does not turn about it
    glm::dquat inertiaOrientation{1.0, 0.0, 0.0, 0.0};
    glm::dvec3 velocity{0.0}; ///< m/s
    glm::dvec3 spin{0.0};     ///< rad/s
    double gravityFactor = 1.0;
    double drag = 0.0; ///< 1/s: what is left alone loses its velocity at this rate
};

enum class ColliderShape : uint8_t { Box, Sphere, Capsule, Cylinder, Hull, Mesh };

/// What collides at a node. Lengths in m, the node's frame; capsule and cylinder along y.
struct Collider {
    int node = -1; ///< Scene::nodes; its pose is the collider's
    int body = -1; ///< Physics::bodies; -1: it rests
    ColliderShape shape = ColliderShape::Box;
    glm::dvec3 size{1.0};           ///< Box
    double radius = 0.5, top = 0.5; ///< Sphere; Capsule and Cylinder at the bottom and at the top
    double height = 1.0;            ///< Capsule (between the centres of its balls), Cylinder
    std::vector<int> meshes;        ///< Hull, Mesh: Scene::meshes
    int material = -1;              ///< Physics::materials; -1: the default
    uint64_t systems = 0;           ///< collision systems that it belongs to, one bit each
    std::optional<uint64_t> collides, collidesNot; ///< with whose systems
};

/// One of the six degrees of freedom of a joint: x, y, z, then the turns about them.
struct JointAxis {
    double min = -std::numeric_limits<double>::infinity(); ///< m or rad; min = max: locked
    double max = std::numeric_limits<double>::infinity();
    double limitStiffness = std::numeric_limits<double>::infinity(); ///< N/m or N m/rad beyond the limits
    double limitDamping = 0.0;
    bool driven = false;
    double target = 0.0, targetSpeed = 0.0; ///< m or rad, and per s
    double stiffness = 0.0, damping = 0.0;
    double maxForce = std::numeric_limits<double>::infinity(); ///< N or N m
    bool acceleration = false; ///< stiffness and damping are per kg (or kg m^2) of what they move

    [[nodiscard]] bool locked() const { return min == max && !(limitStiffness < 1e300); }
    [[nodiscard]] bool limited() const { return min > -1e300 || max < 1e300; }
};

/// A setting of the session that the free axis of a joint sets while it is moved by hand.
struct JointSetting {
    std::string name; ///< as `--set` takes it; empty: none
    /// One at each detent where there are as many, else the axis' range in equal parts. Empty: a number from
    /// `from` at the lower limit to `to` at the upper one.
    std::vector<std::string> values;
    double from = 0.0, to = 0.0;
    bool steps = false; ///< a button: each time that it is pressed goes to the next value
};

/// Holds the frame of one node to that of another: the pose of `connected` in the frame of `node`.
struct Joint {
    std::string name;
    int node = -1, connected = -1;     ///< Scene::nodes
    int body = -1, connectedBody = -1; ///< Physics::bodies; -1: the world. Not the same
    bool collides = false;             ///< the two bodies collide with each other
    std::array<JointAxis, 6> axes;
    // TOUCHSTONE_joint, of the joint's free axis (the first that is neither locked nor free of limits, else
    // the first that is not locked):
    std::optional<double> pitch; ///< m, not 0: the way along x of one turn about x; both must not be locked
    double friction = 0.0;       ///< N or N m: Coulomb friction of the free axis
    std::vector<double> detents; ///< m or rad, ascending
    double detentForce = 0.0;    ///< N or N m: greatest force back into a detent
    JointSetting setting;
};

struct Physics {
    std::vector<PhysicsMaterial> materials;
    std::vector<Body> bodies; ///< at least one that is not kinematic
    std::vector<Collider> colliders;
    std::vector<Joint> joints;
    bool loose = false; ///< the bodies are not only those of the file (engine/load/loose_bodies.h)
};

/// Bodies, colliders and joints that an import keeps.
inline constexpr size_t kMaxBodies = 2048, kMaxColliders = 16384, kMaxBodyJoints = 1024;

} // namespace touchstone
