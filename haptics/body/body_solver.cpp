#include "haptics/body/body_solver.h"

#include "haptics/body/solver_parts.h"

#include <algorithm>
#include <utility>

namespace touchstone::body {

namespace {

constexpr int kIterations = 12, kPositionIterations = 4;

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

void BodySolver::addRow(const Row& row) noexcept {
    if (rowCount_ < rows_.size() && row.response > 0.0)
        rows_[rowCount_++] = row;
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

void BodySolver::correct(const SolverState& s) noexcept {
    for (int iteration = 0; iteration < kPositionIterations; ++iteration) {
        for (const BodyJoint& joint : joints_)
            if (moves(s, joint.a) || moves(s, joint.b))
                correctJoint(s, joint);
        for (size_t i = 0; i < activeCount_; ++i)
            correctContact(s, contacts_[active_[i].index]);
    }
}

} // namespace touchstone::body
