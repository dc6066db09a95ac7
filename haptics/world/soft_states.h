#pragma once
// Where the soft bodies of a world are: cloth and jelly. A thread steps them 250 times a second; a tick
// blends two of their states, as it does where an animation deforms a mesh (world/deforming_objects.h).

#include "engine/core/checksum.h"
#include "engine/exchange/kept_states.h"
#include "engine/exchange/triple_buffer.h"
#include "engine/scene/scene.h"
#include "haptics/body/hand_push.h"
#include "haptics/body/soft_solver.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/world/mesh_interval.h"

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

/// HapticScene::objects that are soft bodies and felt as meshes. `source` may be null.
[[nodiscard]] std::vector<size_t> softObjects(const Scene* source, const HapticScene& haptic);

/// Construct off the servo (it allocates). One thread calls `advance`, `push` and `integrate`.
///
/// State S_k is k steps old. In the interval j a tick blends S_j and S_j+1, while S_j+2 is made of S_j+1 and
/// of what the hands did in interval j - 1. So a state is a function of the ticks before, and a replay makes
/// the same. In real time a thread has an interval for it; where it is late the bodies stand still for that
/// tick (`held`), and their time with them.
class SoftStates {
  public:
    /// `objects`: softObjects of both.
    SoftStates(const Scene& source, const HapticScene& haptic, const std::vector<size_t>& objects);
    SoftStates(const SoftStates&) = delete;
    SoftStates& operator=(const SoftStates&) = delete;
    ~SoftStates();

    /// True where the soft bodies of a scene of equal geometry are these: they go on in it. Any thread.
    [[nodiscard]] bool fit(const Scene& source, const HapticScene& haptic,
                           const std::vector<size_t>& objects) const;
    /// Starts a thread that makes the states, which `advance` otherwise does.
    void stepApart();

    /// Begins a tick: goes on by what `integrate` added. `begins`: of a scene that takes the bodies over
    /// where they are; what was integrated is left to the next call, as in a replay that resumes there.
    /// `hold`: they stay, as they did where a tick was held. True in the first tick of all.
    bool advance(bool begins, bool hold) noexcept;
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// Of a body, in this tick and in the one before; the way of a vertex between them.
    [[nodiscard]] MeshMoment now(size_t body) const noexcept { return at(moment_, body); }
    [[nodiscard]] MeshMoment before(size_t body) const noexcept { return at(previous_, body); }
    [[nodiscard]] double travel(size_t body) const noexcept;
    /// Also in a tick that is held: false for a body that sleeps.
    [[nodiscard]] bool moves(size_t body) const noexcept;

    void push(int object, const body::HandPush& push) noexcept;
    /// Ends a tick of `dt` s. `gravity`: m/s².
    void integrate(double gravity, double dt) noexcept;
    /// Which states the tick blends.
    void addTo(Hash64& hash) const noexcept;

    /// Between two ticks: all that the next ticks depend on. Neither allocates.
    [[nodiscard]] size_t stateSize() const noexcept;
    void save(std::span<std::byte> bytes) const noexcept;
    /// False where the bytes do not fit. Not while a thread steps.
    [[nodiscard]] bool restore(std::span<const std::byte> bytes) noexcept;
    /// Servo: keeps the state before `tick` for another thread; false where that one does not keep up.
    [[nodiscard]] bool keep(uint64_t tick) noexcept;
    /// That thread: the next state that was kept.
    [[nodiscard]] bool takeKept(uint64_t& tick, std::vector<std::byte>& bytes) {
        return kept_.take(tick, bytes);
    }

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
        std::shared_ptr<const SoftBody> law;
        std::shared_ptr<const HapticObject> mesh; // at rest
        Similarity objectFromWorkspace;
        std::unique_ptr<body::SoftSolver> solver;
        std::vector<uint32_t> source;   // by source vertex: welded vertex
        std::vector<glm::vec3> normals; // of the welded vertices, while a state is published
    };
    /// A state of one body, S_k, and the interval that begins with it.
    struct Part {
        body::SoftState state;
        std::vector<glm::vec3> vertices, normals; // object frame
        MeshInterval interval;                    // from S_k to S_k+1
    };
    struct Moment {
        uint64_t interval = 0;
        double fraction = 0.0;
    };

    void add(const Scene& source, const HapticScene& haptic, size_t object);
    [[nodiscard]] MeshMoment at(const Moment& moment, size_t body) const noexcept;
    [[nodiscard]] Part& part(uint64_t state, size_t body) noexcept { return ring_[state % kRing][body]; }
    [[nodiscard]] const Part& part(uint64_t state, size_t body) const noexcept {
        return ring_[state % kRing][body];
    }
    [[nodiscard]] static bool wellFormed(const Input& input) noexcept;
    void publishState(uint64_t state, size_t body) noexcept;
    void publishInterval(uint64_t interval, size_t body) noexcept;
    void make(uint64_t state) noexcept;
    void show(uint64_t state) noexcept;
    void run(const std::stop_token& stop) noexcept;

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
    std::atomic<uint64_t> asked_{0}, made_{0}; // the state that is wanted, and the newest there is
    bool apart_ = false;
    KeptStates kept_;
    std::jthread thread_; // last: it uses all of the above
};

/// True where the soft bodies of a scene of equal geometry are those of `states` (null: none) and go on.
[[nodiscard]] bool softGoOn(const SoftStates* states, const Scene* source, const HapticScene& haptic);

} // namespace touchstone
