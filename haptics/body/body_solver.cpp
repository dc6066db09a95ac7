#include "haptics/body/body_solver.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::body {

namespace {

constexpr double kFree = 1e300; // an impulse or a force without a limit
/// m. A penetration that is left, so that bodies at rest keep their contacts.
constexpr double kSlop = 1e-5;
constexpr int kIterations = 12, kPositionIterations = 4;
/// Above this the product of a spring's rate and the step, squared, makes an explicit spring useless: it is
/// solved implicitly, whatever the integrator.
constexpr double kStiffest = 0.25;

bool moves(const SolverState& s, int body) {
    return body >= 0 && s.active[static_cast<size_t>(body)] != 0;
}

Pose poseOf(std::span<const BodyState> states, int body) {
    return body >= 0 ? states[static_cast<size_t>(body)].pose : Pose{};
}

/// Workspace from the joint's frame in a body.
Pose frameOf(std::span<const BodyState> states, int body, const Pose& inBody) {
    const Pose pose = poseOf(states, body);
    return {pose.rotation * inBody.rotation, pose.point(inBody.position)};
}

glm::dvec3 perpendicular(const glm::dvec3& n) {
    const glm::dvec3 other = std::abs(n.x) < 0.6 ? glm::dvec3(1.0, 0.0, 0.0) : glm::dvec3(0.0, 1.0, 0.0);
    return glm::normalize(glm::cross(n, other));
}

double mixed(Combine one, Combine other, double a, double b) {
    switch (std::min(one, other)) {
    case Combine::Average:
        return 0.5 * (a + b);
    case Combine::Minimum:
        return std::min(a, b);
    case Combine::Maximum:
        return std::max(a, b);
    case Combine::Multiply:
        return a * b;
    }
    return 0.5 * (a + b);
}

/// Where the contact is now.
struct ContactPlace {
    glm::dvec3 normal, onA, onB;
    double gap;
};
ContactPlace placeOf(const BodyContact& contact, std::span<const BodyState> states) {
    const Pose a = poseOf(states, contact.a), b = poseOf(states, contact.b),
               f = poseOf(states, contact.frame);
    ContactPlace place;
    place.normal = f.rotation * contact.normal;
    place.onA = a.position + (contact.roundA ? f.rotation : a.rotation) * contact.onA;
    place.onB = b.position + (contact.roundB ? f.rotation : b.rotation) * contact.onB;
    place.gap = glm::dot(place.onA - place.onB, place.normal);
    return place;
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

} // namespace

BodySolver::BodySolver(size_t bodies, size_t contacts, std::vector<BodyJoint> joints)
    : contacts_(contacts), old_(contacts), joints_(std::move(joints)), active_(contacts),
      rows_(16 * joints_.size()), met_(bodies) {}

/// The inverse masses of what moves, and the response to a unit impulse.
void BodySolver::connect(const SolverState& s, Row& row) noexcept {
    row.inverseA = row.inverseB = row.response = 0.0;
    row.turnA = row.turnB = glm::dvec3(0.0);
    const double length = glm::dot(row.linear, row.linear);
    if (moves(s, row.a)) {
        const auto a = static_cast<size_t>(row.a);
        row.inverseA = s.masses[a].inverse;
        row.turnA = turned(s.masses[a], s.states[a].pose.rotation, row.angularA);
        row.response += row.inverseA * length + glm::dot(row.angularA, row.turnA);
    }
    if (moves(s, row.b)) {
        const auto b = static_cast<size_t>(row.b);
        row.inverseB = s.masses[b].inverse;
        row.turnB = turned(s.masses[b], s.states[b].pose.rotation, row.angularB);
        row.response += row.inverseB * length + glm::dot(row.angularB, row.turnB);
    }
}

double BodySolver::velocity(const SolverState& s, const Row& row) noexcept {
    double v = 0.0;
    if (row.a >= 0) {
        const BodyState& a = s.states[static_cast<size_t>(row.a)];
        v += glm::dot(row.linear, a.velocity) + glm::dot(row.angularA, a.spin);
    }
    if (row.b >= 0) {
        const BodyState& b = s.states[static_cast<size_t>(row.b)];
        v += glm::dot(row.angularB, b.spin) - glm::dot(row.linear, b.velocity);
    }
    return v;
}

void BodySolver::apply(const SolverState& s, const Row& row, double impulse) noexcept {
    if (moves(s, row.a)) {
        BodyState& a = s.states[static_cast<size_t>(row.a)];
        a.velocity += (row.inverseA * impulse) * row.linear;
        a.spin += impulse * row.turnA;
    }
    if (moves(s, row.b)) {
        BodyState& b = s.states[static_cast<size_t>(row.b)];
        b.velocity -= (row.inverseB * impulse) * row.linear;
        b.spin += impulse * row.turnB;
    }
}

void BodySolver::solveRow(const SolverState& s, Row& row) noexcept {
    const double change =
        (row.target - velocity(s, row) - row.softness * row.impulse) / (row.response + row.softness);
    const double impulse = std::clamp(row.impulse + change, row.low, row.high);
    apply(s, row, impulse - row.impulse);
    row.impulse = impulse;
}

void BodySolver::adopt(std::span<const FoundContact> found, std::span<const ColliderForm> forms,
                       std::span<const BodyState> states, std::span<const BodyMass> masses) noexcept {
    std::swap(contacts_, old_);
    const size_t before = count_;
    count_ = std::min(found.size(), contacts_.size());
    size_t begin = 0; // both are in the order of their pairs
    for (size_t i = 0; i < count_; ++i) {
        const FoundContact& from = found[i];
        const ColliderForm& formA = forms[from.pair >> 16];
        const ColliderForm& formB = forms[from.pair & 0xffff];
        BodyContact& contact = contacts_[i] = BodyContact{};
        contact.a = from.a;
        contact.b = from.b;
        contact.pair = from.pair;
        contact.roundA = formA.round;
        contact.roundB = formB.round && from.b >= 0;
        contact.frame = contact.roundB ? (contact.roundA ? -1 : from.a) : from.b;
        const Pose a = poseOf(states, from.a), b = poseOf(states, from.b), f = poseOf(states, contact.frame);
        const glm::dquat back = glm::conjugate(f.rotation);
        contact.normal = back * from.normal;
        contact.tangent = perpendicular(contact.normal);
        contact.onA = contact.roundA ? back * (from.onA - a.position) : a.inversePoint(from.onA);
        contact.onB = contact.roundB ? back * (from.onB - b.position) : b.inversePoint(from.onB);
        contact.staticFriction =
            mixed(formA.frictionCombine, formB.frictionCombine, formA.staticFriction, formB.staticFriction);
        contact.dynamicFriction =
            std::min(contact.staticFriction, mixed(formA.frictionCombine, formB.frictionCombine,
                                                   formA.dynamicFriction, formB.dynamicFriction));
        contact.restitution =
            mixed(formA.restitutionCombine, formB.restitutionCombine, formA.restitution, formB.restitution);
        while (begin < before && old_[begin].pair < from.pair)
            ++begin;
        // The nearest old contact of the same colliders: within a tenth of the smaller body.
        double nearest = 0.1 * masses[static_cast<size_t>(from.a)].radius;
        nearest *= nearest;
        const BodyContact* same = nullptr;
        for (size_t k = begin; k < before && old_[k].pair == from.pair; ++k) {
            const glm::dvec3 way = old_[k].onB - contact.onB;
            if (old_[k].frame == contact.frame && glm::dot(way, way) < nearest) {
                nearest = glm::dot(way, way);
                same = &old_[k];
            }
        }
        if (same == nullptr)
            continue;
        contact.impulse = same->impulse;
        contact.slides = same->slides;
        // The friction's direction is kept, whatever the tangents.
        const glm::dvec3 slide =
            same->slide[0] * same->tangent + same->slide[1] * glm::cross(same->normal, same->tangent);
        contact.slide[0] = glm::dot(slide, contact.tangent);
        contact.slide[1] = glm::dot(slide, glm::cross(contact.normal, contact.tangent));
    }
}

void BodySolver::prepareContacts(const SolverState& s, double dt) noexcept {
    activeCount_ = metCount_ = 0;
    for (size_t i = 0; i < count_; ++i) {
        BodyContact& contact = contacts_[i];
        const bool movesA = moves(s, contact.a), movesB = moves(s, contact.b);
        if (!movesA && !movesB)
            continue;
        const ContactPlace place = placeOf(contact, s.states);
        ActiveContact& active = active_[activeCount_];
        active = ActiveContact{};
        active.index = i;
        active.gap = place.gap;
        const glm::dvec3 tangent = poseOf(s.states, contact.frame).rotation * contact.tangent;
        const glm::dvec3 armA = place.onA - poseOf(s.states, contact.a).position,
                         armB = place.onB - poseOf(s.states, contact.b).position;
        const auto row = [&](const glm::dvec3& direction) {
            Row made{.a = contact.a,
                     .b = contact.b,
                     .linear = direction,
                     .angularA = glm::cross(armA, direction),
                     .angularB = -glm::cross(armB, direction)};
            connect(s, made);
            return made;
        };
        active.normal = row(place.normal);
        // A gap may close in this step, and no further.
        active.normal.target = place.gap > 0.0 ? -place.gap / dt : 0.0;
        if (!(active.normal.response > 0.0))
            continue;
        const double approach = -velocity(s, active.normal);
        if (place.gap > approach * dt + kSlop && contact.impulse == 0.0)
            continue; // it cannot close in this step
        if (!movesA || (!movesB && contact.b >= 0)) {
            const int rests = movesA ? contact.b : contact.a, other = movesA ? contact.a : contact.b;
            const auto r = static_cast<size_t>(rests);
            if (s.masses[r].inverse > 0.0 && s.states[static_cast<size_t>(other)].quiet < 0.1 &&
                place.gap < 1e-4)
                met_[metCount_++] = rests;
            if (metCount_ == met_.size())
                --metCount_;
        }
        active.tangent[0] = row(tangent);
        active.tangent[1] = row(glm::cross(place.normal, tangent));
        ++activeCount_;
    }
}

void BodySolver::solveContact(const SolverState& s, ActiveContact& active) noexcept {
    BodyContact& contact = contacts_[active.index];
    // Friction first, within the cone of the last normal impulse: the normal constraint holds at the end.
    const double friction =
        (contact.slides ? contact.dynamicFriction : contact.staticFriction) * contact.impulse;
    double slide[2];
    for (int t = 0; t < 2; ++t)
        slide[t] = contact.slide[t] - velocity(s, active.tangent[t]) / active.tangent[t].response;
    const double size = std::hypot(slide[0], slide[1]);
    contact.slides = size > friction;
    if (size > friction) {
        const double most = contact.dynamicFriction * contact.impulse;
        slide[0] *= most / size;
        slide[1] *= most / size;
    }
    for (int t = 0; t < 2; ++t) {
        apply(s, active.tangent[t], slide[t] - contact.slide[t]);
        contact.slide[t] = slide[t];
    }
    const double change = (active.normal.target - velocity(s, active.normal)) / active.normal.response;
    const double impulse = std::max(0.0, contact.impulse + change);
    apply(s, active.normal, impulse - contact.impulse);
    contact.impulse = impulse;
}

void BodySolver::addRow(const Row& row) noexcept {
    if (rowCount_ < rows_.size() && row.response > 0.0)
        rows_[rowCount_++] = row;
}

namespace {

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

void BodySolver::solve(const SolverState& s, BodyIntegrator, double dt) noexcept {
    impact_ = 0.0;
    prepareContacts(s, dt);
    for (BodyJoint& joint : joints_)
        if (moves(s, joint.a) || moves(s, joint.b))
            prepareJoint(s, joint, dt);
    bounce(s, dt);
    for (size_t i = 0; i < rowCount_; ++i)
        apply(s, rows_[i], rows_[i].impulse);
    for (size_t i = 0; i < activeCount_; ++i) {
        const BodyContact& contact = contacts_[active_[i].index];
        apply(s, active_[i].normal, contact.impulse);
        for (int t = 0; t < 2; ++t)
            apply(s, active_[i].tangent[t], contact.slide[t]);
        active_[i].normal.impulse = contact.impulse; // before this step
    }
    for (int iteration = 0; iteration < kIterations; ++iteration) {
        for (size_t i = 0; i < rowCount_; ++i)
            solveRow(s, rows_[i]);
        for (size_t i = 0; i < activeCount_; ++i)
            solveContact(s, active_[i]);
    }
    for (size_t i = 0; i < rowCount_; ++i)
        if (rows_[i].kept != nullptr)
            *rows_[i].kept = rows_[i].impulse;
    for (size_t i = 0; i < activeCount_; ++i)
        impact_ = std::max(impact_, contacts_[active_[i].index].impulse - active_[i].normal.impulse);
}

namespace {

/// Moves two bodies by an impulse on positions.
template <class Row>
void nudge(const SolverState& s, const Row& row, double impulse) {
    if (moves(s, row.a))
        s.states[static_cast<size_t>(row.a)].pose.move((row.inverseA * impulse) * row.linear,
                                                       impulse * row.turnA);
    if (moves(s, row.b))
        s.states[static_cast<size_t>(row.b)].pose.move((-row.inverseB * impulse) * row.linear,
                                                       impulse * row.turnB);
}

} // namespace

void BodySolver::correctContact(const SolverState& s, const BodyContact& contact) noexcept {
    if (!moves(s, contact.a) && !moves(s, contact.b))
        return;
    const ContactPlace place = placeOf(contact, s.states);
    if (!(place.gap < -kSlop))
        return;
    Row row{.a = contact.a,
            .b = contact.b,
            .linear = place.normal,
            .angularA = glm::cross(place.onA - poseOf(s.states, contact.a).position, place.normal),
            .angularB = -glm::cross(place.onB - poseOf(s.states, contact.b).position, place.normal)};
    connect(s, row);
    // A gentle push: bodies that begin inside each other come apart by at most 0.2 mm in a pass.
    if (row.response > 0.0)
        nudge(s, row, std::min(0.2 * (-place.gap - kSlop), 2e-4) / row.response);
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

void BodySolver::correct(const SolverState& s) noexcept {
    for (int iteration = 0; iteration < kPositionIterations; ++iteration) {
        for (const BodyJoint& joint : joints_)
            if (moves(s, joint.a) || moves(s, joint.b))
                correctJoint(s, joint);
        for (size_t i = 0; i < activeCount_; ++i)
            correctContact(s, contacts_[active_[i].index]);
    }
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
