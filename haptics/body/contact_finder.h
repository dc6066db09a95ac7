#pragma once
// Where bodies are near each other: Bullet's collision detection, as a pure function of the poses.

#include "engine/scene/physics.h"
#include "haptics/body/rigid_body.h"

#include <algorithm>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace touchstone::body {

/// What collides, in the frame of its body (of the workspace where it rests). m.
struct ColliderForm {
    int body = -1;
    ColliderShape shape = ColliderShape::Box;
    Pose bodyFromCollider;
    glm::dvec3 size{1.0};
    double radius = 0.0, top = 0.0, height = 0.0;
    std::vector<glm::vec3> points; ///< Hull, Mesh: collider frame
    std::vector<uint32_t> indices; ///< Mesh
    bool round = false; ///< a ball about the body's centre of mass: it looks the same from everywhere
    double staticFriction = 0.6, dynamicFriction = 0.6, restitution = 0.0;
    Combine frictionCombine = Combine::Average, restitutionCombine = Combine::Average;
    uint64_t systems = 0;
    std::optional<uint64_t> collides, collidesNot;
};

/// Two points that may touch. `a` is a body.
struct FoundContact {
    int32_t a = -1, b = -1;        ///< bodies; b = -1: what rests
    uint32_t pair = 0;             ///< names the two colliders
    glm::dvec3 onA{0.0}, onB{0.0}; ///< workspace, at the poses that were given
    glm::dvec3 normal{0.0};        ///< unit, from b to a
};

/// The poses of a tick, which the finder reads.
struct FinderInput {
    struct Entry {
        Pose pose;
        glm::dvec3 velocity{0.0};
        double turning = 0.0; ///< m/s, of the body's farthest point by its spin
        bool awake = false;
    };
    uint64_t tick = 0;
    std::vector<Entry> bodies;

    FinderInput() = default;
    FinderInput(const FinderInput&) = default;
    /// Between equals in size: no allocation.
    FinderInput& operator=(const FinderInput& other) noexcept {
        tick = other.tick;
        std::copy(other.bodies.begin(), other.bodies.end(), bodies.begin());
        return *this;
    }
};

struct FinderOutput {
    /// How far a body was looked for contacts, from where it was.
    struct Room {
        glm::dvec3 position{0.0};
        double reach = 0.0; ///< m; 0: not awake
    };
    uint64_t tick = 0;
    size_t count = 0;                ///< of valid entries
    std::vector<Room> rooms;         ///< by body
    std::vector<FoundContact> found; ///< of a fixed size
    bool full = false;               ///< contacts were left out

    FinderOutput() = default;
    FinderOutput(const FinderOutput&) = default;
    FinderOutput& operator=(const FinderOutput& other) noexcept {
        tick = other.tick;
        count = other.count;
        full = other.full;
        std::copy(other.rooms.begin(), other.rooms.end(), rooms.begin());
        std::copy_n(other.found.begin(), count, found.begin());
        return *this;
    }
};

/// One thread; not the servo (it allocates). It keeps nothing from call to call, so that equal poses give
/// equal contacts, bit by bit: a replay computes them again.
class ContactFinder {
  public:
    /// `apart`: pairs of bodies that do not collide, the lower first.
    ContactFinder(std::vector<ColliderForm> forms, std::vector<std::pair<int, int>> apart);
    ~ContactFinder();
    ContactFinder(const ContactFinder&) = delete;
    ContactFinder& operator=(const ContactFinder&) = delete;

    /// Contacts of the pairs of which one at least is awake, within the way of `ahead` s.
    void find(const FinderInput& input, double ahead, FinderOutput& output);

    [[nodiscard]] const std::vector<ColliderForm>& forms() const;

  private:
    struct Bullet;
    std::unique_ptr<Bullet> bullet_;
};

} // namespace touchstone::body
