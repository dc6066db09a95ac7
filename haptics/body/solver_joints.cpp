// The joints of the solver: springs, detents, limits, threads and friction.

#include "haptics/body/solver_parts.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::body {

namespace {

/// Above this the product of a spring's rate and the step, squared, makes an explicit spring useless: it is
/// solved implicitly, whatever the integrator.
constexpr double kStiffest = 0.25;

/// Workspace from the joint's frame in a body.
Pose frameOf(std::span<const BodyState> states, int body, const Pose& inBody) {
    const Pose pose = poseOf(states, body);
    return {pose.rotation * inBody.rotation, pose.point(inBody.position)};
}

/// The torque's potential of the detents at q, and minus its slope. A cosine between neighbours, whose
/// minima are the detents.
struct Detent {
    double force = 0.0, energy = 0.0;
};
Detent detentAt(const BodyJoint& joint, double q) {
    if (joint.detents.empty() || joint.detentForce <= 0.0)
        return {};
    const auto above = std::ranges::lower_bound(joint.detents, q);
    if (above == joint.detents.begin() || above == joint.detents.end()) {
        // Beyond the outermost one: as wide as its only neighbour.
        const bool below = above == joint.detents.begin();
        if (joint.detents.size() < 2)
            return {};
        const double end = below ? joint.detents.front() : joint.detents.back();
        const double next = below ? joint.detents[1] : joint.detents[joint.detents.size() - 2];
        const double width = std::abs(end - next), phase = 2.0 * std::numbers::pi * (q - end) / width;
        return {-joint.detentForce * std::sin(phase),
                joint.detentForce * width / (2.0 * std::numbers::pi) * (1.0 - std::cos(phase))};
    }
    const double low = *(above - 1), width = *above - low;
    const double phase = 2.0 * std::numbers::pi * (q - low) / width;
    return {-joint.detentForce * std::sin(phase),
            joint.detentForce * width / (2.0 * std::numbers::pi) * (1.0 - std::cos(phase))};
}

/// The geometry of a joint now.
struct JointFrames {
    Pose a, b;
    glm::dmat3 axes;    // of a, workspace
    glm::dvec3 between; // from a's origin to b's
    glm::dvec3 angles;  // rad, about a's axes; of an axis about which it turns far, the whole angle
};

JointFrames framesOf(const BodyJoint& joint, std::span<const BodyState> states) {
    JointFrames frames;
    frames.a = frameOf(states, joint.a, joint.inA);
    frames.b = frameOf(states, joint.b, joint.inB);
    frames.axes = glm::mat3_cast(frames.a.rotation);
    frames.between = frames.b.position - frames.a.position;
    glm::dquat q = glm::conjugate(frames.a.rotation) * frames.b.rotation;
    if (q.w < 0.0)
        q = -q;
    // About the axis that turns: the twist about it. About the locked ones: by how much that axis is tilted.
    int turning = -1, free = 0;
    for (int i = 0; i < 3; ++i)
        if (!joint.axes[static_cast<size_t>(3 + i)].locked()) {
            turning = i;
            ++free;
        }
    const glm::dvec3 v(q.x, q.y, q.z);
    if (free == 1) {
        glm::dvec3 axis(0.0);
        axis[turning] = 1.0;
        frames.angles = glm::cross(axis, q * axis);
        frames.angles[turning] = 2.0 * std::atan2(v[turning], q.w);
    } else {
        const double sine = glm::length(v);
        frames.angles = sine > 1e-12 ? v * (2.0 * std::atan2(sine, q.w) / sine) : 2.0 * v;
    }
    return frames;
}

/// Row of a joint's axis: its velocity is that of the joint's reading.
template <class Row>
Row axisRow(const BodyJoint& joint, std::span<const BodyState> states, const JointFrames& frames, int axis) {
    Row row;
    row.a = joint.a;
    row.b = joint.b;
    const glm::dvec3 direction = frames.axes[axis % 3];
    if (axis >= 3) {
        row.angularA = -direction;
        row.angularB = direction;
        return row;
    }
    // d/dt of axis . (pB - pA), where the axis turns with a.
    const glm::dvec3 armA = frames.b.position - poseOf(states, joint.a).position,
                     armB = frames.b.position - poseOf(states, joint.b).position;
    row.linear = -direction;
    row.angularA = -glm::cross(armA, direction);
    row.angularB = glm::cross(armB, direction);
    return row;
}

/// The centripetal acceleration of a joint's point about a body's centre. The spin about the line between
/// them does not move the point: of a gyroscope that spin turns with the precession, and counts for nothing.
glm::dvec3 centripetal(std::span<const BodyState> states, int body, const glm::dvec3& point) {
    if (body < 0)
        return glm::dvec3(0.0);
    const BodyState& state = states[static_cast<size_t>(body)];
    const glm::dvec3 arm = point - state.pose.position;
    const double length2 = glm::dot(arm, arm);
    if (!(length2 > 0.0))
        return glm::dvec3(0.0);
    const glm::dvec3 across = state.spin - (glm::dot(state.spin, arm) / length2) * arm;
    return -glm::dot(across, across) * arm;
}

double positionOf(const BodyJoint& joint, const JointFrames& frames, int axis) {
    if (axis < 3)
        return glm::dot(frames.axes[axis], frames.between);
    const auto i = static_cast<size_t>(axis - 3);
    return frames.angles[axis - 3] + 2.0 * std::numbers::pi * joint.turns[i];
}

} // namespace

/// A spring from `offset` (target minus position) and a damper, of one axis.
void BodySolver::spring(const SolverState& s, const BodyJoint& joint, int axis, double stiffness,
                        double damping, double offset, double speed, double maxForce,
                        BodyIntegrator integrator, double dt) noexcept {
    Row row = axisRow<Row>(joint, s.states, framesOf(joint, s.states), axis);
    connect(s, row);
    if (!(row.response > 0.0))
        return;
    const bool stiff = (dt * dt * stiffness + dt * damping) * row.response > kStiffest;
    if (integrator == BodyIntegrator::Implicit || stiff) {
        const double gain = dt * (dt * stiffness + damping);
        if (!(gain > 0.0))
            return;
        row.softness = 1.0 / gain;
        row.target = row.softness * dt * (stiffness * offset + damping * speed);
        row.low = -maxForce * dt;
        row.high = maxForce * dt;
        addRow(row);
        return;
    }
    const double force = stiffness * offset + damping * (speed - velocity(s, row));
    apply(s, row, dt * std::clamp(force, -maxForce, maxForce));
}

void BodySolver::applySprings(const SolverState& s, BodyIntegrator integrator, double dt) noexcept {
    rowCount_ = 0;
    for (BodyJoint& joint : joints_) {
        if (!moves(s, joint.a) && !moves(s, joint.b))
            continue;
        const JointFrames frames = framesOf(joint, s.states);
        for (size_t i = 0; i < 3; ++i) {
            if (joint.axes[3 + i].locked())
                continue;
            const double change = frames.angles[static_cast<int>(i)] - joint.lastAngle[i];
            joint.turns[i] -= std::round(change / (2.0 * std::numbers::pi));
            joint.lastAngle[i] = frames.angles[static_cast<int>(i)];
        }
        for (int axis = 0; axis < 6; ++axis) {
            const JointAxis& stated = joint.axes[static_cast<size_t>(axis)];
            const double q = positionOf(joint, frames, axis);
            double scale = 1.0;
            if (stated.acceleration && stated.driven) {
                Row row = axisRow<Row>(joint, s.states, frames, axis);
                connect(s, row);
                scale = row.response > 0.0 ? 1.0 / row.response : 0.0;
            }
            if (stated.driven)
                spring(s, joint, axis, scale * stated.stiffness, scale * stated.damping, stated.target - q,
                       stated.targetSpeed, std::min(stated.maxForce, kFree), integrator, dt);
            if (stated.limitStiffness < kFree && (q < stated.min || q > stated.max))
                spring(s, joint, axis, stated.limitStiffness, stated.limitDamping,
                       (q < stated.min ? stated.min : stated.max) - q, 0.0, kFree, integrator, dt);
        }
        if (joint.freeAxis >= 0 && joint.detentForce > 0.0) {
            Row row = axisRow<Row>(joint, s.states, frames, joint.freeAxis);
            connect(s, row);
            apply(s, row, dt * detentAt(joint, positionOf(joint, frames, joint.freeAxis)).force);
        }
    }
}

void BodySolver::prepareJoint(const SolverState& s, BodyJoint& joint, double dt) noexcept {
    const JointFrames frames = framesOf(joint, s.states);
    const auto add = [&](Row row, double target, double low, double high, double& kept) {
        connect(s, row);
        row.target = target;
        row.low = low;
        row.high = high;
        row.impulse = std::clamp(kept, low, high);
        row.kept = &kept;
        addRow(row);
    };
    // Over a step the points of a turning body go along arcs. The velocity that ends on the joint is short of
    // the tangent's by half a step of the centripetal acceleration; with the tangent's, and a correction of
    // the place alone, a pendulum of 0.5 rad loses a sixth of its energy in a minute.
    const glm::dvec3 bend = 0.5 * dt *
                            (centripetal(s.states, joint.b, frames.b.position) -
                             centripetal(s.states, joint.a, frames.a.position));
    for (int axis = 0; axis < 6; ++axis) {
        const JointAxis& stated = joint.axes[static_cast<size_t>(axis)];
        double& kept = joint.impulse[static_cast<size_t>(axis)];
        if (stated.locked()) {
            const double target = axis < 3 ? -glm::dot(frames.axes[axis], bend) : 0.0;
            add(axisRow<Row>(joint, s.states, frames, axis), target, -kFree, kFree, kept);
            continue;
        }
        if (!stated.limited() || stated.limitStiffness < kFree) {
            kept = 0.0;
            continue;
        }
        // A limit may be reached in this step, and what is beyond returns at a fifth.
        const double q = positionOf(joint, frames, axis), below = q - stated.min, above = stated.max - q;
        const Row row = axisRow<Row>(joint, s.states, frames, axis);
        if (below < above)
            add(row, -below / dt * (below > 0.0 ? 1.0 : 0.2), 0.0, kFree, kept);
        else
            add(row, above / dt * (above > 0.0 ? 1.0 : 0.2), -kFree, 0.0, kept);
    }
    if (joint.pitch != 0.0) {
        Row row = axisRow<Row>(joint, s.states, frames, 0);
        const Row turn = axisRow<Row>(joint, s.states, frames, 3);
        const double lead = joint.pitch / (2.0 * std::numbers::pi);
        row.angularA -= lead * turn.angularA;
        row.angularB -= lead * turn.angularB;
        add(row, 0.0, -kFree, kFree, joint.impulse[6]);
    }
    if (joint.friction > 0.0 && joint.freeAxis >= 0)
        add(axisRow<Row>(joint, s.states, frames, joint.freeAxis), 0.0, -joint.friction * dt,
            joint.friction * dt, joint.impulse[7]);
}

void BodySolver::correctJoint(const SolverState& s, const BodyJoint& joint) noexcept {
    for (int axis = 0; axis < 6; ++axis) {
        if (!joint.axes[static_cast<size_t>(axis)].locked())
            continue;
        const JointFrames frames = framesOf(joint, s.states);
        Row row = axisRow<Row>(joint, s.states, frames, axis);
        connect(s, row);
        const double error =
            joint.axes[static_cast<size_t>(axis)].min -
            (axis < 3 ? glm::dot(frames.axes[axis], frames.between) : frames.angles[axis - 3]);
        if (row.response > 0.0)
            nudge(s, row, 0.5 * error / row.response);
    }
    if (joint.pitch == 0.0)
        return;
    const JointFrames frames = framesOf(joint, s.states);
    Row row = axisRow<Row>(joint, s.states, frames, 0);
    const Row turn = axisRow<Row>(joint, s.states, frames, 3);
    const double lead = joint.pitch / (2.0 * std::numbers::pi);
    row.angularA -= lead * turn.angularA;
    row.angularB -= lead * turn.angularB;
    connect(s, row);
    // The angle of this step is within half a turn of the last one.
    double angle = frames.angles[0];
    angle -= 2.0 * std::numbers::pi * std::round((angle - joint.lastAngle[0]) / (2.0 * std::numbers::pi)) -
             2.0 * std::numbers::pi * joint.turns[0];
    const double error = lead * angle - glm::dot(frames.axes[0], frames.between);
    if (row.response > 0.0)
        nudge(s, row, 0.5 * error / row.response);
}

JointReading BodySolver::reading(const BodyJoint& joint, std::span<const BodyState> states) noexcept {
    JointReading reading;
    const JointFrames frames = framesOf(joint, states);
    for (int axis = 0; axis < 6; ++axis) {
        const auto i = static_cast<size_t>(axis);
        reading.position[i] = positionOf(joint, frames, axis);
        const Row row = axisRow<Row>(joint, states, frames, axis);
        double v = 0.0;
        if (row.a >= 0)
            v += glm::dot(row.linear, states[static_cast<size_t>(row.a)].velocity) +
                 glm::dot(row.angularA, states[static_cast<size_t>(row.a)].spin);
        if (row.b >= 0)
            v += glm::dot(row.angularB, states[static_cast<size_t>(row.b)].spin) -
                 glm::dot(row.linear, states[static_cast<size_t>(row.b)].velocity);
        reading.velocity[i] = v;
    }
    return reading;
}

double BodySolver::springEnergy(std::span<const BodyState> states) const noexcept {
    double energy = 0.0;
    for (const BodyJoint& joint : joints_) {
        const JointFrames frames = framesOf(joint, states);
        for (int axis = 0; axis < 6; ++axis) {
            const JointAxis& stated = joint.axes[static_cast<size_t>(axis)];
            const double q = positionOf(joint, frames, axis);
            if (stated.driven && !stated.acceleration)
                energy += 0.5 * stated.stiffness * (q - stated.target) * (q - stated.target);
            if (stated.limitStiffness < kFree && (q < stated.min || q > stated.max)) {
                const double beyond = q - (q < stated.min ? stated.min : stated.max);
                energy += 0.5 * stated.limitStiffness * beyond * beyond;
            }
        }
        if (joint.freeAxis >= 0)
            energy += detentAt(joint, positionOf(joint, frames, joint.freeAxis)).energy;
    }
    return energy;
}

} // namespace touchstone::body
