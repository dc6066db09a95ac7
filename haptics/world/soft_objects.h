#pragma once
// The soft bodies of a world: cloth and jelly. A thread steps them 250 times a second; a tick blends two of
// their states, as it does where an animation deforms a mesh (world/deforming_objects.h).

#include "engine/core/checksum.h"
#include "engine/exchange/triple_buffer.h"
#include "engine/math/object_motion.h"
#include "engine/scene/scene.h"
#include "haptics/body/soft_solver.h"
#include "haptics/scene/haptic_scene.h"

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

namespace touchstone {

/// Where the vertices of all soft bodies are, for the eye: object frames, one soft object after the other.
/// Written by whoever steps them, read by one thread.
using SoftPublication = TripleBuffer<std::vector<glm::vec3>>;

/// Construct off the servo (it allocates). One thread calls `advance`, `push` and `integrate`.
///
/// State S_k is k steps old. In the interval j a tick blends S_j and S_j+1, while S_j+2 is made of S_j+1 and
/// of what the hands did in interval j - 1. So a state is a function of the ticks before, and a replay makes
/// the same. In real time a thread has an interval for it; where it is late the bodies stand still for that
/// tick (`held`), and their time with them.
class SoftObjects {
  public:
    /// Null where `source` has no soft bodies that are felt as meshes.
    [[nodiscard]] static std::unique_ptr<SoftObjects> of(const ScenePtr& source, const HapticScene& haptic);
    SoftObjects(const SoftObjects&) = delete;
    SoftObjects& operator=(const SoftObjects&) = delete;
    ~SoftObjects();

    /// The scene with the objects as they are in this tick.
    [[nodiscard]] const HapticScene& scene() const noexcept { return *scene_; }
    /// Starts a thread that makes the states, which `advance` otherwise does.
    void stepApart();

    /// Moves the vertices on by what `integrate` added. `begins`: they have no previous places. `hold`: they
    /// stay, as they did where a tick was held. Sets `jumped` of the objects in the first tick.
    void advance(bool begins, bool hold, std::span<ObjectMotion> motions) noexcept;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// Nothing moved in this tick nor in the last one.
    [[nodiscard]] bool still() const noexcept { return still_ && wasStill_; }
    /// A hand's force `force` (N) on the object at `point` (m), workspace; stiffness in N/m. `most`: N, what
    /// its device can exert.
    void push(int object, const glm::dvec3& point, const glm::dvec3& force, double stiffness,
              double most) noexcept;
    /// Ends a tick of `dt` s. `gravity`: m/s².
    void integrate(double gravity, double dt) noexcept;
    /// Which states the tick blends.
    void addTo(Hash64& hash) const noexcept;

    /// Between two ticks: all that the next ticks depend on. Neither allocates.
    [[nodiscard]] size_t stateSize() const noexcept;
    void save(std::span<std::byte> bytes) const noexcept;
    /// False where the bytes do not fit. Not while a thread steps.
    [[nodiscard]] bool restore(std::span<const std::byte> bytes) noexcept;
    /// Servo: keeps the state before `tick` for another thread; dropped where that one does not keep up.
    void keep(uint64_t tick) noexcept;
    /// That thread: the next state that was kept.
    [[nodiscard]] bool takeKept(uint64_t& tick, std::vector<std::byte>& bytes);

    /// HapticScene::objects, in the order of the publication.
    struct Shown {
        size_t object = 0;
        size_t vertices = 0;
    };
    [[nodiscard]] const std::vector<Shown>& shown() const noexcept { return shown_; }
    [[nodiscard]] SoftPublication& publication() noexcept { return publication_; }

  private:
    static constexpr size_t kPushes = 64;
    static constexpr uint64_t kRing = 4;
    /// What the hands did in an interval.
    struct Input {
        struct Push {
            uint64_t body = 0; // as wide as a double: no padding goes into a recording
            body::SoftPush push;
        };
        std::array<Push, kPushes> pushes;
        uint64_t count = 0;
        double gravity = 0.0;
        double steps =
            0.0; // of its ticks, in steps of a state: the sum of the shares where a hand always pushed
    };
    struct Soft {
        size_t object = 0;
        std::shared_ptr<HapticObject> own;
        std::unique_ptr<body::SoftSolver> solver;
        std::vector<uint32_t> source;   // by source vertex: welded vertex
        std::vector<glm::vec3> normals; // of the welded vertices, while a state is published
        MeshInstant instant;
    };
    /// A state of one body, S_k, and the interval that begins with it.
    struct Part {
        body::SoftState state;
        std::vector<glm::vec3> vertices, normals; // object frame
        TriangleTree tree;                        // of the interval from S_k to S_k+1
        double longest = 0.0, radius = 0.0;       // of that interval
    };
    struct Moment {
        uint64_t interval = 0;
        double fraction = 0.0;
    };

    SoftObjects(const ScenePtr& source, const HapticScene& haptic, const std::vector<size_t>& objects);
    void add(const Scene& source, const HapticScene& haptic, size_t object);
    [[nodiscard]] Part& part(uint64_t state, size_t body) noexcept { return ring_[state % kRing][body]; }
    [[nodiscard]] const Part& part(uint64_t state, size_t body) const noexcept {
        return ring_[state % kRing][body];
    }
    [[nodiscard]] static bool wellFormed(const Input& input) noexcept;
    void publishState(uint64_t state, size_t body) noexcept;
    void publishInterval(uint64_t interval, size_t body) noexcept;
    void make(uint64_t state) noexcept;
    void show(uint64_t state) noexcept;
    void stepTo(const Moment& moment, bool begins) noexcept;
    void run(const std::stop_token& stop) noexcept;

    std::shared_ptr<HapticScene> scene_;
    std::vector<Soft> bodies_;
    std::vector<Shown> shown_;
    std::array<std::vector<Part>, kRing> ring_;
    size_t vertices_ = 0; // of all soft bodies
    SoftPublication publication_;
    Moment moment_, previous_;
    double pending_ = 0.0; // s, since the last `advance`
    Input gathered_;       // of this interval
    Input given_;          // of the one before, for the state that is being made
    bool held_ = false, first_ = true;
    bool still_ = false, wasStill_ = false;
    std::atomic<uint64_t> asked_{0}, made_{0}; // the state that is wanted, and the newest there is
    bool apart_ = false;
    /// Kept states, from the servo to one other thread.
    struct Kept {
        std::vector<std::byte> bytes;
        uint64_t tick = 0;
        std::atomic<bool> full{false};
    };
    std::array<Kept, 2> kept_;
    size_t keeps_ = 0, takes_ = 0;
    std::jthread thread_; // last: it uses all of the above
};

} // namespace touchstone
