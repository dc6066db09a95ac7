#pragma once
// The objects of a world whose vertices an animation moves: skins and morph targets. Their vertices are
// evaluated on a fixed grid of the animation's time and published with a fitted search tree; a tick blends
// two publications. So a tick is a pure function of its times, and a replay needs no vertices.

#include "engine/core/checksum.h"
#include "engine/math/object_motion.h"
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

/// Construct off the servo (it allocates). One thread calls `advance`; a thread of its own may publish ahead.
class DeformingObjects {
  public:
    /// Null where the animation that plays in `source` deforms none of the objects.
    [[nodiscard]] static std::unique_ptr<DeformingObjects> of(const ScenePtr& source,
                                                              const HapticScene& haptic);
    DeformingObjects(const DeformingObjects&) = delete;
    DeformingObjects& operator=(const DeformingObjects&) = delete;
    ~DeformingObjects();

    /// The scene with the objects as they are in this tick; the others are those of the scene it was made of.
    [[nodiscard]] const HapticScene& scene() const noexcept { return *scene_; }

    /// Starts a thread that publishes ahead of `advance`, which from then on computes no publication itself.
    /// `time`: where `advance` will soon be, s.
    void publishAhead(double time);

    /// Moves the vertices to the animation's `time` (s, any). `begins`: they have no previous places. Sets
    /// `jumped` of the objects whose animation starts again at another place. `hold`: they stay.
    void advance(double time, bool begins, bool hold, std::span<ObjectMotion> motions) noexcept;

    /// Before the first `advance`: begins at `time`; false where its publication is not there yet, but
    /// wanted.
    [[nodiscard]] bool reach(double time) noexcept {
        advance(time, true, false, {});
        return !held_;
    }

    /// The tick's publication was not there in time: the vertices stayed where they were.
    [[nodiscard]] bool held() const noexcept { return held_; }
    /// Which places the tick blends.
    void addTo(Hash64& hash) const noexcept;

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
        MovedMesh moved;
        std::vector<uint32_t> source; // by welded vertex: vertex of the deformation
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

    DeformingObjects(ScenePtr source, const Animation& animation, const HapticScene& haptic);
    void add(const HapticScene& haptic, size_t object, const Instance& instance);
    void addSlots(size_t count);
    [[nodiscard]] Moment momentAt(double time) const noexcept;
    [[nodiscard]] double gridTime(int64_t index) const noexcept;
    void evaluate(double time, size_t part, std::vector<glm::vec3>& positions,
                  std::vector<glm::vec3>& normals) noexcept;
    void fill(Slot& slot, int64_t interval) noexcept;
    [[nodiscard]] const Slot* published(int64_t interval) const noexcept;
    [[nodiscard]] Slot* obtain(int64_t interval) noexcept;
    void stepTo(const Moment& moment, bool jumps, bool begins, std::span<ObjectMotion> motions) noexcept;
    [[nodiscard]] double travelOf(size_t part) const noexcept;
    [[nodiscard]] bool publishNext() noexcept;
    void publish(const std::stop_token& stop) noexcept;

    ScenePtr source_;
    const Animation* animation_;
    std::shared_ptr<HapticScene> scene_;
    std::vector<Deformed> deformed_;
    ScenePose pose_;
    int64_t intervals_ = 1; // of the grid in a lap
    std::vector<std::unique_ptr<Slot>> slots_;
    Slot *now_ = nullptr, *before_ = nullptr; // held by the servo; may be one
    Moment moment_, previous_;
    double lap_ = 0.0;
    bool held_ = false;
    bool placed_ = true; // the vertices have been where the animation has them since the last beginning
    std::atomic<int64_t> wanted_{0}; // interval of the servo
    std::atomic<int> direction_{1};  // in which it goes
    std::atomic<bool> ahead_{false};
    std::jthread publisher_; // last: it uses all of the above
};

} // namespace touchstone
