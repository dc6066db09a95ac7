#pragma once
// The rigid bodies of a scene: moved at the servo's rate by the hands' forces, gravity, joints and contacts
// among them (docs/bodies.md).

#include "engine/exchange/kept_states.h"
#include "engine/exchange/triple_buffer.h"
#include "engine/scene/scene.h"
#include "haptics/body/body_solver.h"
#include "haptics/body/contact_finder.h"
#include "haptics/body/finder_thread.h"
#include "haptics/body/hand_push.h"
#include "haptics/body/rigid_body.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/settings/haptic_settings.h"

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone::body {

/// Poses of the bodies for another thread.
struct BodyPoses {
    std::vector<Pose> workspaceFromBody;
    double impact = 0.0; ///< N s, the largest impulse of two bodies that met since the last publication

    BodyPoses() = default;
    BodyPoses(const BodyPoses&) = default;
    BodyPoses& operator=(const BodyPoses& other) noexcept {
        impact = other.impact;
        std::copy(other.workspaceFromBody.begin(), other.workspaceFromBody.end(), workspaceFromBody.begin());
        return *this;
    }
};
using BodyPublication = TripleBuffer<BodyPoses>;

/// An object of HapticScene that belongs to a body.
struct BodyObject {
    size_t object = 0;
    int body = -1;
    Similarity bodyFromObject;
};

/// Bodies that may be awake at the same time; others wait asleep.
inline constexpr size_t kMaxAwake = 256;

/// Of one scene and one servo. Construct off the servo (it allocates); what is noexcept neither allocates nor
/// locks nor throws, and its work is bounded by kMaxAwake and the capacity for contacts.
class BodyWorld {
  public:
    /// Null where the scene has no body that moves. `warnings` (may be null): what is felt otherwise than the
    /// file states.
    [[nodiscard]] static std::shared_ptr<BodyWorld> make(const Scene& scene, const HapticScene& haptic,
                                                         std::vector<Warning>* warnings = nullptr);

    /// In the next `integrate`, after the pushes before it (push_bodies.cpp).
    void push(int object, const HandPush& push) noexcept;
    /// Torque (N m, workspace) on an object.
    void turn(int object, const glm::dvec3& torque) noexcept;
    /// The body of a haptic object; -1: none.
    [[nodiscard]] int bodyOf(int object) const noexcept {
        return object >= 0 && static_cast<size_t>(object) < bodyOfObject_.size()
                   ? bodyOfObject_[static_cast<size_t>(object)]
                   : -1;
    }
    /// The state after `dt` s, under the forces since the last call.
    void integrate(BodyIntegrator integrator, double gravity, double dt) noexcept;

    /// How contacts are found. InStep: in beginTick, every kFindEvery ticks, which allocates: offline.
    /// Apart: by a thread; the newest result is taken. Replayed: in beginTick, from the poses that `repeat`
    /// names.
    enum class Finding : uint8_t { InStep, Apart, Replayed };
    static constexpr uint64_t kFindEvery = 4;
    /// Off the servo.
    void setFinding(Finding finding);
    /// Replayed: what `found` was in the tick that begins next.
    void repeat(uint32_t found) noexcept { repeat_ = found; }
    /// Begins a tick: contacts of the newest poses. With Finding::Apart nothing allocates.
    void beginTick() noexcept;
    /// 0: the tick took no new contacts; else one more than the age, in ticks, of the poses they are for.
    [[nodiscard]] uint32_t found() const noexcept { return found_; }

    /// Writes the poses of this tick and of the last one. Returns true where one changed.
    bool writePoses(std::span<ObjectMotion> motions, bool first) noexcept;
    /// Puts the objects where the hands felt them in the last tick: after `restore`.
    void showPublished(std::span<ObjectMotion> motions) const noexcept;
    /// Kinematic bodies that the animation moves follow their object. Before writePoses.
    void followAnimation(std::span<const ObjectMotion> motions, std::span<const uint8_t> animated,
                         double time) noexcept;

    /// The state before a tick, whole, in `bytes` of stateCapacity(); returns how many are used. What is
    /// being found apart is dropped, as in a replay that begins here.
    size_t save(std::span<std::byte> bytes) noexcept;
    [[nodiscard]] size_t stateCapacity() const noexcept;
    /// False, with nothing changed, where the bytes are no state of these bodies.
    [[nodiscard]] bool restore(std::span<const std::byte> bytes) noexcept;
    /// Servo: keeps the state before `tick` for another thread; false where that one does not keep up.
    [[nodiscard]] bool keep(uint64_t tick) noexcept;
    /// Another thread: the kept states in order; false where there is none.
    bool takeKept(uint64_t& tick, std::vector<std::byte>& bytes) { return kept_.take(tick, bytes); }

    [[nodiscard]] std::span<const BodyState> states() const noexcept { return states_; }
    [[nodiscard]] std::span<BodyState> states() noexcept { return states_; }
    [[nodiscard]] std::span<const BodyMass> masses() const noexcept { return masses_; }
    [[nodiscard]] std::span<const BodyObject> objects() const noexcept { return objects_; }
    [[nodiscard]] const std::vector<std::string>& names() const noexcept { return names_; }
    [[nodiscard]] const BodySolver& solver() const noexcept { return *solver_; }
    [[nodiscard]] size_t awake() const noexcept { return awake_.size(); }
    /// Everything that moves: kinetic, of gravity (0 at the workspace's origin) and of the joints' springs,
    /// J.
    [[nodiscard]] double energy(double gravity) const noexcept;
    /// N s, the largest impulse of two bodies that met in the last `integrate`.
    [[nodiscard]] double impact() const noexcept { return met_; }
    [[nodiscard]] const std::shared_ptr<BodyPublication>& publication() const noexcept {
        return publication_;
    }
    /// Hash of the poses that move; 0 where none has moved.
    void addTo(Hash64& hash) const noexcept;
    void wake(int body) noexcept;
    /// Wakes all bodies: as in a scene that begins.
    void wakeAll() noexcept;

  private:
    friend class BodyBuilder;
    BodyWorld() = default;
    void finish();
    struct Push;
    void adopt(const FinderOutput& output) noexcept;
    void sleep(int body) noexcept;
    [[nodiscard]] bool takes(int body) noexcept;
    void measurePush(Push& push, double dt) const noexcept;
    double solvePush(Push& push, double dt) noexcept;
    void applyPushes(BodyIntegrator integrator, double dt) noexcept;
    [[nodiscard]] int islandOf(int body) noexcept;
    void writeBody(int body, std::span<ObjectMotion> motions, bool first) noexcept;
    void fillInput(FinderInput& input) const noexcept;
    void sleepWhereQuiet(double dt) noexcept;
    void keepSound() noexcept;
    void publish() noexcept;

    /// Of a tick: of each contact of each hand. What is beyond them is left out.
    static constexpr size_t kMaxPushes = 256;
    struct Push {
        int body = -1;
        HandPush hand;
        glm::dvec3 torque{0.0};            ///< N m, workspace, besides that of the force
        glm::dvec3 lever{0.0}, along{0.0}; ///< from the body's centre; the force's direction
        glm::dvec3 turns{0.0};             ///< (kg m)^-1: spin for an impulse along it
        double rate = 0.0;                 ///< dt^2 k / m of its spring and what that meets
        double exerted = 0.0;              ///< N, along the force
        bool atEnd = false;                ///< the force is that of the end of the step
    };

    std::vector<std::string> names_;
    std::vector<BodyMass> masses_;
    std::vector<BodyState> states_, initial_;
    std::vector<uint8_t> active_;       ///< by body: awake and not held
    std::vector<Push> pushes_;          ///< of this tick, in the order of the hands
    std::vector<BodyObject> objects_;   ///< by body
    std::vector<uint32_t> firstObject_; ///< of each body in `objects_`, and the end
    std::vector<int> bodyOfObject_;     ///< of each haptic object; -1
    std::vector<int> awake_;            ///< bodies, capacity kMaxAwake
    std::vector<int> settled_;          ///< fell asleep; written until they rest in two ticks
    std::vector<int> followers_;        ///< kinematic bodies that an animation moves
    std::vector<int> island_;           ///< scratch
    double scale_ = 1.0;                ///< workspace metres of one of the scene
    double followed_ = 0.0;             ///< s, of the last followAnimation
    std::unique_ptr<BodySolver> solver_;
    std::shared_ptr<ContactFinder> finder_;
    std::unique_ptr<FinderThread> thread_;
    FinderInput input_;
    FinderOutput output_;
    std::vector<FinderInput> history_; ///< Replayed: of the last kHistory ticks
    std::shared_ptr<BodyPublication> publication_;
    BodyPoses outgoing_;
    KeptStates kept_;
    Finding finding_ = Finding::InStep;
    static constexpr uint64_t kHistory = 64;
    uint64_t tick_ = 0, earliest_ = 0; ///< of the next beginTick; results for earlier poses are dropped
    uint32_t found_ = 0, repeat_ = 0;
    int unpublished_ = 3;
    bool stirs_ = false; ///< a body woke: it has no contacts yet
    double impact_ = 0.0, met_ = 0.0;
};

} // namespace touchstone::body
