// Impacts with restitution: Newton's law, one contact after the other.

#include "haptics/body/body_solver.h"

#include <algorithm>
#include <array>
#include <span>

namespace touchstone::body {

namespace {

/// m/s. A contact that closes more slowly does not bounce.
constexpr double kBounceSpeed = 0.01;
constexpr int kBounces = 16;
/// Locked axes of the joints of two bodies that an impact regards, and rounds over them.
constexpr size_t kLocks = 24;
constexpr int kLockRounds = 8;
/// N s: a lock has no bounds.
constexpr double kUnbounded = 1e299;

/// The locked axes of the joints of a contact's bodies; how many.
template <class Row>
size_t locksOf(std::span<Row> rows, const Row& contact, std::span<Row*> found) {
    size_t count = 0;
    const auto touches = [&](int body) { return body >= 0 && (body == contact.a || body == contact.b); };
    for (Row& row : rows) {
        if (count == found.size())
            break;
        if (row.low < -kUnbounded && row.high > kUnbounded && row.softness == 0.0 && row.response > 0.0 &&
            (touches(row.a) || touches(row.b)))
            found[count++] = &row;
    }
    return count;
}

} // namespace

/// Newton's impacts one after the other, until nothing that bounces approaches: so the impulse goes through
/// Newton's cradle ball by ball.
///
/// Joints take part in an impact. Where they come only after it, a ball of a cradle is struck as if it were
/// free: it gets the velocity v and no spin, and the joint makes of that the v / (1 + I / (m l^2)) of a
/// pendulum, l the wire and I the ball's inertia, and as much is lost of the spin of the ball that struck.
/// Each of the four impacts of five balls, which are in ticks of their own, then loses
/// 1 - (1 + 0.4 (9 mm / 70 mm)^2)^-2 = 1.31 % of the energy: 5.1 % of the swing. With the locked axes held
/// before and after an impulse the velocities are linear in it, and the one for Newton's law follows from a
/// first guess.
void BodySolver::bounce(const SolverState& s, double dt) noexcept {
    std::array<Row*, kLocks> found{};
    // Velocities that the locked axes allow. The impulses are taken off those with which the solve of the
    // step begins, so that a lock does not give them twice.
    const auto hold = [&s](std::span<Row* const> locks) {
        for (int again = 0; again < kLockRounds; ++again)
            for (Row* const row : locks) {
                const double impulse = (row->target - velocity(s, *row)) / row->response;
                apply(s, *row, impulse);
                row->impulse -= impulse;
            }
    };
    for (int round = 0; round < kBounces; ++round) {
        bool any = false;
        for (size_t i = 0; i < activeCount_; ++i) {
            ActiveContact& active = active_[i];
            BodyContact& contact = contacts_[active.index];
            if (contact.restitution <= 0.0)
                continue;
            double v = velocity(s, active.normal);
            if (!(v < -kBounceSpeed) || active.gap > -v * dt)
                continue;
            const std::span<Row* const> locks(found.data(), locksOf(std::span(rows_.data(), rowCount_),
                                                                    active.normal, std::span<Row*>(found)));
            if (!locks.empty()) {
                hold(locks);
                v = velocity(s, active.normal);
                if (!(v < -kBounceSpeed) || active.gap > -v * dt)
                    continue;
            }
            double impulse = -(1.0 + contact.restitution) * v / active.normal.response;
            apply(s, active.normal, impulse);
            if (!locks.empty()) {
                hold(locks);
                const double change = velocity(s, active.normal) - v,
                             wanted = -(1.0 + contact.restitution) * v;
                // A body that its joints hold still does not give way: what is left approaches no more.
                const double more = change > 1e-3 * wanted ? impulse * (wanted / change - 1.0) : 0.0;
                apply(s, active.normal, more);
                hold(locks);
                impulse += more;
            }
            impact_ = std::max(impact_, impulse);
            any = true;
        }
        if (!any)
            return;
    }
}

} // namespace touchstone::body
