#pragma once
// Impulses of contacts and joints in one step: projected Gauss-Seidel on velocities, warm started, and a pass
// on positions that adds no velocity (Catto 2006; Müller and others 2007).

#include "engine/scene/physics.h"
#include "haptics/body/contact_finder.h"
#include "haptics/body/rigid_body.h"
#include "haptics/settings/haptic_settings.h"

#include <array>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone::body {

/// Two points that hold two bodies apart. Kept between two rounds of the finder: the points move with their
/// bodies, and the normal with one of them.
struct BodyContact {
    int32_t a = -1, b = -1;
    uint32_t pair = 0;
    int32_t frame = -1;                   ///< the body with which the normal turns; -1: the workspace
    bool roundA = false, roundB = false;  ///< then `onA` is from the body's centre, along the normal's frame
    glm::dvec3 onA{0.0}, onB{0.0};        ///< in the frames of a and of b (of the workspace, where b is -1)
    glm::dvec3 normal{0.0}, tangent{0.0}; ///< unit, in the frame of `frame`
    double staticFriction = 0.0, dynamicFriction = 0.0, restitution = 0.0;
    double impulse = 0.0, slide[2] = {0.0, 0.0}; ///< N s, of the last step
    bool slides = false;                         ///< it slid in the last step
};

/// A joint as the solver has it.
struct BodyJoint {
    int a = -1, b = -1; ///< bodies; -1: the world, one at most
    Pose inA, inB;      ///< its frames, in those of the bodies
    std::array<JointAxis, 6> axes;
    int freeAxis = -1;  ///< of friction and detents
    double pitch = 0.0; ///< m per turn; 0: no thread
    double friction = 0.0, detentForce = 0.0;
    std::vector<double> detents;
    JointSetting setting;
    std::array<double, 8> impulse{};            ///< N s, of the last step: six axes, thread, friction
    std::array<double, 3> turns{}, lastAngle{}; ///< whole turns about each axis, since angles wrap; rad
};

/// What a joint's free axis is at: m or rad, and its velocity.
struct JointReading {
    std::array<double, 6> position{}, velocity{};
};

struct SolverState {
    std::span<BodyState> states;
    std::span<const BodyMass> masses;
    std::span<const uint8_t> active; ///< by body: it moves in this step
};

class BodySolver {
  public:
    BodySolver(size_t bodies, size_t contacts, std::vector<BodyJoint> joints);

    /// Takes new contacts, and the impulses of the old ones that are the same.
    void adopt(std::span<const FoundContact> found, std::span<const ColliderForm> forms,
               std::span<const BodyState> states, std::span<const BodyMass> masses) noexcept;
    /// Forces of springs and detents, explicit: velocities change by them. Not those that `solve` has.
    void applySprings(const SolverState& s, BodyIntegrator integrator, double dt) noexcept;
    /// Changes velocities such that contacts do not approach and joints hold.
    void solve(const SolverState& s, BodyIntegrator integrator, double dt) noexcept;
    /// Moves bodies that penetrate or whose joints have come apart.
    void correct(const SolverState& s) noexcept;

    [[nodiscard]] static JointReading reading(const BodyJoint& joint,
                                              std::span<const BodyState> states) noexcept;
    /// J, of drives without a limit of force and of detents.
    [[nodiscard]] double springEnergy(std::span<const BodyState> states) const noexcept;

    [[nodiscard]] std::span<const BodyContact> contacts() const noexcept {
        return {contacts_.data(), count_};
    }
    [[nodiscard]] std::span<BodyContact> contactSlots() noexcept { return contacts_; }
    void setContactCount(size_t count) noexcept { count_ = count; }
    [[nodiscard]] size_t contactCapacity() const noexcept { return contacts_.size(); }
    [[nodiscard]] std::span<const BodyJoint> joints() const noexcept { return joints_; }
    [[nodiscard]] std::span<BodyJoint> joints() noexcept { return joints_; }
    /// N s, the largest impulse of a contact that closed in the last `solve`.
    [[nodiscard]] double impact() const noexcept { return impact_; }
    /// Bodies that something active meets and that do not move: to be woken.
    [[nodiscard]] std::span<const int> met() const noexcept { return {met_.data(), metCount_}; }

  private:
    /// One equation between two bodies: J v = linear (va - vb) + angularA wa + angularB wb.
    struct Row {
        int a = -1, b = -1; ///< -1: nothing that moves
        glm::dvec3 linear{0.0}, angularA{0.0}, angularB{0.0};
        glm::dvec3 turnA{0.0}, turnB{0.0};     ///< inverse inertia times the angular part
        double inverseA = 0.0, inverseB = 0.0; ///< 1/kg
        double response = 0.0;                 ///< J M^-1 J^T, 1/kg
        double target = 0.0;                   ///< of J v
        double softness = 0.0;                 ///< J v + softness * impulse = target
        double low = 0.0, high = 0.0;
        double impulse = 0.0;   ///< N s
        double* kept = nullptr; ///< where the impulse of the last step stands
    };
    struct ActiveContact {
        size_t index = 0;
        Row normal, tangent[2];
        double gap = 0.0;
    };

    static void connect(const SolverState& s, Row& row) noexcept;
    static double velocity(const SolverState& s, const Row& row) noexcept;
    static void apply(const SolverState& s, const Row& row, double impulse) noexcept;
    static void solveRow(const SolverState& s, Row& row) noexcept;
    void prepareContacts(const SolverState& s, double dt) noexcept;
    void prepareJoint(const SolverState& s, BodyJoint& joint, double dt) noexcept;
    void spring(const SolverState& s, const BodyJoint& joint, int axis, double stiffness, double damping,
                double offset, double speed, double maxForce, BodyIntegrator integrator, double dt) noexcept;
    void addRow(const Row& row) noexcept;
    void bounce(const SolverState& s, double dt) noexcept;
    void solveContact(const SolverState& s, ActiveContact& active) noexcept;
    void correctJoint(const SolverState& s, const BodyJoint& joint) noexcept;
    void correctContact(const SolverState& s, const BodyContact& contact) noexcept;

    std::vector<BodyContact> contacts_, old_;
    size_t count_ = 0;
    std::vector<BodyJoint> joints_;
    std::vector<ActiveContact> active_;
    size_t activeCount_ = 0;
    std::vector<Row> rows_;
    size_t rowCount_ = 0;
    std::vector<int> met_;
    size_t metCount_ = 0;
    double impact_ = 0.0;
};

} // namespace touchstone::body
