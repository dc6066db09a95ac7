// The contacts of the solver.

#include "haptics/body/solver_parts.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone::body {

namespace {

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

} // namespace

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
        const glm::dvec3 armA = place.onA - poseOf(s.states, contact.a).position,
                         armB = place.onB - poseOf(s.states, contact.b).position;
        const auto row = [&](const glm::dvec3& direction) {
            return Row{.a = contact.a,
                       .b = contact.b,
                       .linear = direction,
                       .angularA = glm::cross(armA, direction),
                       .angularB = -glm::cross(armB, direction)};
        };
        Row normal = row(place.normal);
        const double approach = -velocity(s, normal);
        if (place.gap > approach * dt + kSlop && contact.impulse == 0.0)
            continue; // it cannot close in this step: most of those that are found
        connect(s, normal);
        if (!(normal.response > 0.0))
            continue;
        // A gap may close in this step, and no further.
        normal.target = place.gap > 0.0 ? -place.gap / dt : 0.0;
        if (!movesA || (!movesB && contact.b >= 0)) {
            const int rests = movesA ? contact.b : contact.a, other = movesA ? contact.a : contact.b;
            const auto r = static_cast<size_t>(rests);
            if (s.masses[r].inverse > 0.0 && s.states[static_cast<size_t>(other)].quiet < 0.1 &&
                place.gap < 1e-4)
                met_[metCount_++] = rests;
            if (metCount_ == met_.size())
                --metCount_;
        }
        const glm::dvec3 tangent = poseOf(s.states, contact.frame).rotation * contact.tangent;
        active_[activeCount_++] = {.index = i,
                                   .normal = normal,
                                   .tangent = {row(tangent), row(glm::cross(place.normal, tangent))},
                                   .gap = place.gap};
        for (Row& slide : active_[activeCount_ - 1].tangent)
            connect(s, slide);
    }
}

/// The three rows of a contact, between the same two bodies: their velocities are read and written once. What
/// does not move has no inverse mass in the rows, so that impulses leave it as it is.
void BodySolver::solveContact(const SolverState& s, ActiveContact& active) noexcept {
    BodyContact& contact = contacts_[active.index];
    BodyState nothing;
    BodyState& a = contact.a >= 0 ? s.states[static_cast<size_t>(contact.a)] : nothing;
    BodyState& b = contact.b >= 0 ? s.states[static_cast<size_t>(contact.b)] : nothing;
    glm::dvec3 velocityA = a.velocity, spinA = a.spin, velocityB = b.velocity, spinB = b.spin;
    const auto speed = [&](const Row& row) {
        const double ofA = glm::dot(row.linear, velocityA) + glm::dot(row.angularA, spinA);
        return ofA + (glm::dot(row.angularB, spinB) - glm::dot(row.linear, velocityB));
    };
    const auto push = [&](const Row& row, double impulse) {
        velocityA += (row.inverseA * impulse) * row.linear;
        spinA += impulse * row.turnA;
        velocityB -= (row.inverseB * impulse) * row.linear;
        spinB += impulse * row.turnB;
    };
    // Friction first, within the cone of the last normal impulse: the normal constraint holds at the end.
    const double friction =
        (contact.slides ? contact.dynamicFriction : contact.staticFriction) * contact.impulse;
    double slide[2];
    for (int t = 0; t < 2; ++t)
        slide[t] = contact.slide[t] - speed(active.tangent[t]) / active.tangent[t].response;
    const double squared = slide[0] * slide[0] + slide[1] * slide[1];
    contact.slides = squared > friction * friction;
    if (contact.slides) {
        const double share = contact.dynamicFriction * contact.impulse / std::sqrt(squared);
        slide[0] *= share;
        slide[1] *= share;
    }
    for (int t = 0; t < 2; ++t) {
        push(active.tangent[t], slide[t] - contact.slide[t]);
        contact.slide[t] = slide[t];
    }
    const double change = (active.normal.target - speed(active.normal)) / active.normal.response;
    const double impulse = std::max(0.0, contact.impulse + change);
    push(active.normal, impulse - contact.impulse);
    contact.impulse = impulse;
    a.velocity = velocityA;
    a.spin = spinA;
    b.velocity = velocityB;
    b.spin = spinB;
}

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

} // namespace touchstone::body
