#pragma once
// Where the vertices are that an animation moves: skins and morph targets. They are evaluated on a fixed grid
// of the animation's time and published with a fitted search tree; a tick blends two publications. So a tick
// is a pure function of its times, and a replay needs no vertices.

#include "engine/core/checksum.h"
#include "engine/scene/mesh_deformation.h"
#include "engine/scene/scene.h"
#include "haptics/scene/haptic_scene.h"
#include "haptics/world/mesh_interval.h"

#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <stop_token>
#include <thread>
#include <vector>

namespace touchstone {

/// Publications in a second of the animation. Between two of them a vertex moves straight; a limb that turns
/// at 2 revolutions/s deviates by 1e-4 of its length.
inline constexpr double kPublicationRate = 240.0;

/// HapticScene::objects whose vertices the animation that plays in `source` moves. `source` may be null.
[[nodiscard]] std::vector<size_t> deformingObjects(const Scene* source, const HapticScene& haptic);

/// Construct off the servo (it allocates). One thread calls `advance`; a thread of its own may publish ahead.
class DeformingStates {
  public:
    /// `objects`: deformingObjects of both, one at least.
    DeformingStates(ScenePtr source, const HapticScene& haptic, const std::vector<size_t>& objects);
    DeformingStates(const DeformingStates&) = delete;
    DeformingStates& operator=(const DeformingStates&) = delete;
    ~DeformingStates();

    /// True where the deforming objects of a scene are these, of the same source: they go on in it. Any
    /// thread.
    [[nodiscard]] bool fit(const ScenePtr& source, const HapticScene& haptic,
                           const std::vector<size_t>& objects) const;

    /// Starts a thread that publishes ahead of `advance`, which from then on computes no publication itself.
    /// `time`: where `advance` will soon be, s.
    void publishAhead(double time);

    /// Moves the vertices to the animation's `time` (s, any). `begins`: they have no previous places. `hold`:
    /// they stay.
    void advance(double time, bool begins, bool hold) noexcept;
    /// The tick's publication was not there in time: the vertices stayed where they were.
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// Which places the tick blends.
    void addTo(Hash64& hash) const noexcept;

    // Of an object, in the order of `objects`, after `advance`:
    [[nodiscard]] MeshMoment now(size_t object) const noexcept {
        return now_->parts[object].at(moment_.fraction);
    }
    /// In the tick before; now, where it stands still.
    [[nodiscard]] MeshMoment before(size_t object) const noexcept {
        return still(object) ? now(object) : before_->parts[object].at(previous_.fraction);
    }
    /// It has no previous places in this tick.
    [[nodiscard]] bool still(size_t object) const noexcept {
        return begins_ || (restarts_ && deformed_[object].jumps);
    }
    /// The animation started again at another place, or the vertices were not there for the ticks before.
    [[nodiscard]] bool jumped(size_t object) const noexcept {
        return late_ || (restarts_ && deformed_[object].jumps && !begins_);
    }
    /// An upper bound of the way of a vertex since the tick before, object units.
    [[nodiscard]] double travel(size_t object) const noexcept;

  private:
    /// One object's vertices at both ends of an interval of the grid.
    struct Part {
        std::vector<glm::vec3> from, to, normalsFrom, normalsTo; // object frame
        MeshInterval interval;

        [[nodiscard]] MeshMoment at(double fraction) const noexcept {
            return {&interval,
                    {from.data(), to.data(), fraction},
                    normalsFrom.empty() ? VertexBlend{}
                                        : VertexBlend{normalsFrom.data(), normalsTo.data(), fraction}};
        }
    };
    /// Who may touch a slot. The servo takes Ready ones only and gives them back.
    enum class Use : uint8_t { Empty, Writing, Ready, Held };
    struct Slot {
        std::atomic<Use> use{Use::Empty};
        std::atomic<int64_t> interval{-1};
        std::vector<Part> parts;
    };
    /// An object that deforms.
    struct Deformed {
        size_t object = 0;                        // HapticScene::objects
        std::shared_ptr<const HapticObject> rest; // as the scene has it
        std::vector<uint32_t> source;             // by welded vertex: vertex of the deformation
        const Mesh* mesh = nullptr;
        DeformedVertices vertices;
        glm::dmat3 normalFromMesh{1.0};
        bool jumps = false; // the animation does not end where it begins
    };
    /// A place on the grid.
    struct Moment {
        int64_t interval = -1;
        double fraction = 0.0;
    };

    void add(const HapticScene& haptic, size_t object);
    void addSlots(size_t count);
    [[nodiscard]] Moment momentAt(double time) const noexcept;
    [[nodiscard]] double gridTime(int64_t index) const noexcept;
    void evaluate(double time, size_t part, std::vector<glm::vec3>& positions,
                  std::vector<glm::vec3>& normals) noexcept;
    void fill(Slot& slot, int64_t interval) noexcept;
    [[nodiscard]] const Slot* published(int64_t interval) const noexcept;
    [[nodiscard]] Slot* obtain(int64_t interval) noexcept;
    [[nodiscard]] bool publishNext() noexcept;
    void publish(const std::stop_token& stop) noexcept;

    ScenePtr source_;
    const Animation* animation_;
    std::vector<Deformed> deformed_;
    ScenePose pose_;
    int64_t intervals_ = 1; // of the grid in a lap
    std::vector<std::unique_ptr<Slot>> slots_;
    Slot *now_ = nullptr, *before_ = nullptr; // held by the servo; may be one
    Moment moment_, previous_;
    double lap_ = 0.0;
    bool held_ = false;
    bool begins_ = true, restarts_ = false, late_ = false; // of this tick: still, jumped
    bool placed_ = true; // the vertices have been where the animation has them since the last beginning
    std::atomic<int64_t> wanted_{0}; // interval of the servo
    std::atomic<int> direction_{1};  // in which it goes
    std::atomic<bool> ahead_{false};
    std::jthread publisher_; // last: it uses all of the above
};

} // namespace touchstone
