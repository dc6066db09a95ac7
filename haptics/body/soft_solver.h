#pragma once
// A soft body's step: Bullet's position-based dynamics of its vertices, as a function of the state before.

#include "engine/scene/soft_body.h"

#include <glm/glm.hpp>

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

namespace touchstone::body {

/// Steps of a soft body in a second; the servo blends two of them.
inline constexpr double kSoftRate = 250.0;
/// Steps after which a body that is calm sleeps.
inline constexpr uint32_t kSoftCalm = 125;

/// What a hand does to a soft body. Workspace.
struct SoftPush {
    glm::dvec3 point{0.0};  ///< m, of the surface as it was felt
    glm::dvec3 force{0.0};  ///< N, on the body
    double stiffness = 0.0; ///< N/m, of the hand's spring
    double most = 0.0;      ///< N, what its device can exert
    double fraction = 0.0;  ///< 0..1, between the two states in which it was felt
    double share = 0.0;     ///< 0..1, of a step in which it pushed
};

/// Bullet's unit is 1 cm, so that its tolerances fit what a hand touches.
struct SoftState {
    std::vector<glm::vec3> places;     ///< cm, workspace axes
    std::vector<glm::vec3> velocities; ///< cm/s
    std::vector<glm::vec3> anchor;     ///< cm: `places` when `calm` began
    uint32_t calm = 0;                 ///< steps in which no vertex left its anchor
    float gravity = 0.0f;              ///< m/s², in these steps
    bool operator==(const SoftState&) const = default;
};

/// The vertices of a soft body and what they meet, workspace, m.
struct SoftShape {
    std::vector<glm::dvec3> vertices;
    std::vector<uint32_t> triangles;            ///< 3 each into `vertices`
    std::vector<uint8_t> fixed;                 ///< by vertex: 1 where it is held
    std::vector<std::vector<glm::dvec3>> hulls; ///< what it lies on
};

/// One thread at a time. The constructor allocates, and so may `step`: never on the servo's own time.
class SoftSolver {
  public:
    /// `scale`: workspace m per model m.
    SoftSolver(const SoftBody& law, const SoftShape& shape, double scale);
    ~SoftSolver();
    SoftSolver(const SoftSolver&) = delete;
    SoftSolver& operator=(const SoftSolver&) = delete;

    [[nodiscard]] const SoftState& rest() const noexcept { return rest_; }
    /// m³, of a closed surface.
    [[nodiscard]] double volumeOf(const SoftState& state) const noexcept;

    /// `next` is `now` after 1 / kSoftRate s. It depends on nothing but the arguments: neither on earlier
    /// calls nor on addresses, so that a replay may begin anywhere. `gravity`: m/s², along -y. `number`:
    /// steps since the beginning, for the breath. `from`, `to`: the states between which `pushes` were felt.
    ///
    /// A push is a spring between the hand's place, which the force and its stiffness give, and each vertex
    /// under it, at the end of each substep (backward Euler), never more than the device can exert and never
    /// a pull. So it gives the body no more than a spring whose other end the hand holds. Two other ways
    /// failed: with the felt force itself, or with the hand's place taken from another state than that in
    /// which it was felt, a delay of two steps is a negative damper, and a jelly at rest under a hand moved
    /// by 1 to 4 mm.
    ///
    /// A body that no hand pushes and whose vertices stayed within 5 µm for half a second sleeps: the step
    /// copies it. A push, or another gravity, wakes it; one that breathes never sleeps.
    void step(const SoftState& now, const SoftState& from, const SoftState& to,
              std::span<const SoftPush> pushes, double gravity, uint64_t number, SoftState& next);
    [[nodiscard]] static bool asleep(const SoftState& state) noexcept { return state.calm >= kSoftCalm; }

  private:
    [[nodiscard]] double signedVolumeOf(const SoftState& state) const noexcept;

    struct Bullet;
    struct Pressed;
    struct Patch;

    void choose(std::span<const SoftPush> pushes, const SoftState& from, const SoftState& to);
    void load(const SoftState& state);
    void layOn(const std::vector<glm::dvec4>& halfSpaces);
    void substep();
    void writeTo(SoftState& next) const;
    void press(const Patch& patch, double dt);

    SoftBody law_;
    double scale_;
    SoftState rest_;
    std::vector<uint32_t> triangles_;
    std::vector<Patch> patches_;
    std::unique_ptr<Bullet> bullet_;
};

} // namespace touchstone::body
