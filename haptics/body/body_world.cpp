#include "haptics/body/body_world.h"

#include <algorithm>
#include <cmath>

namespace touchstone::body {

namespace {

/// m/s: a body whose farthest point is slower is quiet; after kRestAfter (s) with all that it touches, it
/// falls asleep.
constexpr double kQuiet = 3e-3, kRestAfter = 0.5;
constexpr uint64_t kSleepEvery = 16, kPublishEvery = 8;

bool same(const Pose& a, const Pose& b) {
    return a.rotation == b.rotation && a.position == b.position;
}

double fastest(const BodyMass& mass, const BodyState& state) {
    return glm::length(state.velocity) + mass.radius * glm::length(state.spin);
}

/// A body moves no farther than it was looked for contacts: what is faster than they are found waits, and
/// keeps its velocity.
double stepOf(const BodyMass& mass, BodyState& state, double dt) {
    const double way = dt * fastest(mass, state);
    const double step = way > state.room ? dt * (state.room / way) : dt;
    state.room = std::max(0.0, state.room - way);
    return step;
}

/// The rotation in a step that keeps the angular momentum: by the spin in the middle of the step.
void rotate(const BodyMass& mass, BodyState& state, double dt) {
    const glm::dvec3& i = mass.inertia;
    const double least = std::min({i.x, i.y, i.z}), most = std::max({i.x, i.y, i.z});
    if (!(least > 0.0) || most - least < 1e-9 * most || state.spin == glm::dvec3(0.0)) {
        state.pose.move(dt * state.velocity, dt * state.spin);
        return;
    }
    const glm::dquat& r = state.pose.rotation;
    const glm::dvec3 momentum = r * (i * (glm::conjugate(r) * state.spin));
    Pose middle = state.pose;
    middle.move(glm::dvec3(0.0), 0.5 * dt * state.spin);
    const glm::dvec3 spin = turned(mass, middle.rotation, momentum);
    state.pose.move(dt * state.velocity, dt * spin);
    state.spin = turned(mass, state.pose.rotation, momentum);
}

} // namespace

/// Everything that depends on the number of bodies. Once, by the builder.
void BodyWorld::finish() {
    const size_t count = states_.size();
    initial_ = states_;
    active_.assign(count, 0);
    island_.resize(count);
    awake_.reserve(kMaxAwake);
    settled_.reserve(count);
    pushes_.reserve(kMaxPushes);
    input_.bodies.resize(count);
    output_.found.resize(solver_->contactCapacity());
    output_.rooms.resize(count);
    outgoing_.workspaceFromBody.resize(count);
    for (size_t b = 0; b < count; ++b)
        outgoing_.workspaceFromBody[b] = states_[b].pose;
    publication_ = std::make_shared<BodyPublication>(outgoing_);
    kept_.resize(stateCapacity());
    for (BodyState& state : states_)
        state.awake = false;
    wakeAll();
}

void BodyWorld::wakeAll() noexcept {
    for (size_t b = 0; b < states_.size(); ++b)
        wake(static_cast<int>(b));
}

void BodyWorld::wake(int body) noexcept {
    const auto b = static_cast<size_t>(body);
    BodyState& state = states_[b];
    state.quiet = 0.0;
    if (state.awake || awake_.size() == kMaxAwake)
        return;
    const bool still = state.velocity == glm::dvec3(0.0) && state.spin == glm::dvec3(0.0);
    if (masses_[b].inverse == 0.0 && still)
        return; // nothing moves it
    state.awake = state.stirred = true;
    state.room = 0.0;
    stirs_ = true;
    active_[b] = 1;
    awake_.push_back(body);
    if (const auto at = std::ranges::find(settled_, body); at != settled_.end())
        settled_.erase(at);
}

void BodyWorld::sleep(int body) noexcept {
    const auto b = static_cast<size_t>(body);
    states_[b].awake = false;
    states_[b].velocity = states_[b].spin = glm::dvec3(0.0);
    active_[b] = 0;
    awake_.erase(std::ranges::find(awake_, body));
    settled_.push_back(body);
}

void BodyWorld::integrate(BodyIntegrator integrator, double gravity, double dt) noexcept {
    met_ = 0.0;
    if (awake_.empty())
        return;
    const bool euler = integrator == BodyIntegrator::Explicit;
    const double fall = -dt * gravity * scale_;
    for (const int body : awake_) {
        const auto b = static_cast<size_t>(body);
        const BodyMass& mass = masses_[b];
        BodyState& state = states_[b];
        if (euler) { // the paper's: the place follows from the velocity before
            Pose next = state.pose;
            const double step = stepOf(mass, state, dt);
            next.move(step * state.velocity, step * state.spin);
            const glm::dquat& r = state.pose.rotation;
            const glm::dvec3 momentum = r * (mass.inertia * (glm::conjugate(r) * state.spin));
            state.spin -= dt * turned(mass, r, glm::cross(state.spin, momentum));
            input_.bodies[b].pose = next;
        }
        if (mass.inverse == 0.0)
            continue;
        state.velocity.y += fall * mass.gravityFactor;
        if (mass.drag > 0.0) [[unlikely]] {
            const double left = 1.0 / (1.0 + dt * mass.drag);
            state.velocity *= left;
            state.spin *= left;
        }
    }
    applyPushes(integrator, dt);
    const SolverState s{states_, masses_, active_};
    solver_->applySprings(s, integrator, dt);
    solver_->solve(s, integrator, dt);
    met_ = solver_->impact();
    impact_ = std::max(impact_, met_);
    for (const int body : awake_) {
        const auto b = static_cast<size_t>(body);
        BodyState& state = states_[b];
        if (euler)
            state.pose = input_.bodies[b].pose;
        else
            rotate(masses_[b], state, stepOf(masses_[b], state, dt));
    }
    solver_->correct(s);
    keepSound();
    for (const int body : solver_->met())
        wake(body);
    sleepWhereQuiet(dt);
}

/// Sizes, masses and joints of a file may be such that a step leaves what numbers hold: then the body stands
/// still where the hands felt it last, and the impulses, which would do the same again, are dropped.
void BodyWorld::keepSound() noexcept {
    bool lost = false;
    for (const int body : awake_) {
        BodyState& state = states_[static_cast<size_t>(body)];
        if (isSound(state)) [[likely]]
            continue;
        state.pose = state.published;
        state.velocity = state.spin = glm::dvec3(0.0);
        lost = true;
    }
    if (!lost) [[likely]]
        return;
    solver_->setContactCount(0);
    for (BodyJoint& joint : solver_->joints()) {
        joint.impulse = {};
        for (std::array<double, 3>* angles : {&joint.turns, &joint.lastAngle})
            for (double& angle : *angles)
                angle = std::isfinite(angle) ? angle : 0.0;
    }
}

int BodyWorld::islandOf(int body) noexcept {
    while (island_[static_cast<size_t>(body)] != body) {
        int& above = island_[static_cast<size_t>(body)];
        above = island_[static_cast<size_t>(above)];
        body = above;
    }
    return body;
}

/// Bodies that touch each other fall asleep together.
void BodyWorld::sleepWhereQuiet(double dt) noexcept {
    for (const int body : awake_) {
        BodyState& state = states_[static_cast<size_t>(body)];
        state.quiet = fastest(masses_[static_cast<size_t>(body)], state) < kQuiet ? state.quiet + dt : 0.0;
    }
    if (tick_ % kSleepEvery != 0)
        return;
    for (const int body : awake_)
        island_[static_cast<size_t>(body)] = body;
    const auto join = [&](int a, int b) {
        if (a < 0 || b < 0 || active_[static_cast<size_t>(a)] == 0 || active_[static_cast<size_t>(b)] == 0)
            return;
        const int one = islandOf(a), other = islandOf(b);
        island_[static_cast<size_t>(std::max(one, other))] = std::min(one, other);
    };
    for (const BodyContact& contact : solver_->contacts())
        if (contact.impulse > 0.0)
            join(contact.a, contact.b);
    for (const BodyJoint& joint : solver_->joints())
        join(joint.a, joint.b);
    // An island is as quiet as its least quiet body.
    for (const int body : awake_) {
        BodyState& root = states_[static_cast<size_t>(islandOf(body))];
        root.quiet = std::min(root.quiet, states_[static_cast<size_t>(body)].quiet);
    }
    for (size_t i = awake_.size(); i-- > 0;) {
        const int body = awake_[i];
        if (states_[static_cast<size_t>(islandOf(body))].quiet >= kRestAfter &&
            masses_[static_cast<size_t>(body)].inverse > 0.0)
            sleep(body);
    }
}

void BodyWorld::setFinding(Finding finding) {
    finding_ = finding;
    thread_.reset();
    history_.clear();
    if (finding == Finding::Apart)
        thread_ = std::make_unique<FinderThread>(finder_, input_, output_);
    if (finding == Finding::Replayed)
        history_.assign(kHistory, input_);
    earliest_ = tick_;
}

void BodyWorld::fillInput(FinderInput& input) const noexcept {
    input.tick = tick_;
    for (size_t b = 0; b < states_.size(); ++b)
        input.bodies[b] = {states_[b].pose, states_[b].velocity,
                           masses_[b].radius * glm::length(states_[b].spin), states_[b].awake};
}

void BodyWorld::adopt(const FinderOutput& output) noexcept {
    solver_->adopt({output.found.data(), output.count}, finder_->forms(), states_, masses_);
    for (const int body : awake_) {
        const auto b = static_cast<size_t>(body);
        const FinderOutput::Room& room = output.rooms[b];
        if (room.reach > 0.0)
            states_[b].room =
                std::max(0.0, room.reach - glm::length(states_[b].pose.position - room.position));
    }
}

void BodyWorld::beginTick() noexcept {
    found_ = 0;
    const bool any = !awake_.empty();
    if (finding_ == Finding::InStep && any && (stirs_ || tick_ % kFindEvery == 0)) {
        stirs_ = false;
        fillInput(input_);
        finder_->find(input_, FinderThread::kAhead, output_);
        adopt(output_);
        found_ = 1;
    }
    if (finding_ == Finding::Apart) {
        if (thread_->take()) {
            const FinderOutput& output = thread_->output();
            const uint64_t age = tick_ - output.tick;
            if (output.tick >= earliest_ && age < kHistory) {
                adopt(output);
                found_ = 1 + static_cast<uint32_t>(age);
            }
        }
        if (any) {
            fillInput(input_);
            thread_->give(input_);
        }
    }
    if (finding_ == Finding::Replayed) {
        fillInput(history_[tick_ % kHistory]);
        if (repeat_ > 0 && repeat_ <= kHistory) {
            finder_->find(history_[(tick_ + 1 - repeat_) % kHistory], FinderThread::kAhead, output_);
            adopt(output_);
            found_ = repeat_;
        }
        repeat_ = 0;
    }
    ++tick_;
    publish();
}

void BodyWorld::publish() noexcept {
    if (!awake_.empty() || !settled_.empty())
        unpublished_ = 3; // of each slot of the buffer
    if (unpublished_ == 0 || tick_ % kPublishEvery != 0)
        return;
    --unpublished_;
    for (size_t b = 0; b < states_.size(); ++b)
        outgoing_.workspaceFromBody[b] = states_[b].pose;
    outgoing_.impact = impact_;
    impact_ = 0.0;
    publication_->write(outgoing_);
}

void BodyWorld::writeBody(int body, std::span<ObjectMotion> motions, bool first) noexcept {
    const auto b = static_cast<size_t>(body);
    BodyState& state = states_[b];
    if (first)
        state.published = state.pose;
    for (size_t k = firstObject_[b]; k < firstObject_[b + 1]; ++k) {
        ObjectMotion& motion = motions[objects_[k].object];
        motion.before = state.published.similarity() * objects_[k].bodyFromObject;
        motion.workspaceFromObject = state.pose.similarity() * objects_[k].bodyFromObject;
        motion.jumped = false;
    }
}

void BodyWorld::showPublished(std::span<ObjectMotion> motions) const noexcept {
    for (const BodyObject& of : objects_) {
        ObjectMotion& motion = motions[of.object];
        motion.workspaceFromObject =
            states_[static_cast<size_t>(of.body)].published.similarity() * of.bodyFromObject;
        motion.before = motion.workspaceFromObject;
    }
}

bool BodyWorld::writePoses(std::span<ObjectMotion> motions, bool first) noexcept {
    if (first)
        for (size_t b = 0; b < states_.size(); ++b)
            if (states_[b].stirred)
                writeBody(static_cast<int>(b), motions, true);
    const bool any = !awake_.empty() || !settled_.empty();
    if (!first)
        for (const auto* list : {&awake_, &settled_})
            for (const int body : *list)
                writeBody(body, motions, false);
    for (size_t i = settled_.size(); i-- > 0;)
        if (const BodyState& state = states_[static_cast<size_t>(settled_[i])];
            same(state.published, state.pose)) {
            settled_[i] = settled_.back();
            settled_.pop_back();
        }
    for (const auto* list : {&awake_, &settled_})
        for (const int body : *list)
            states_[static_cast<size_t>(body)].published = states_[static_cast<size_t>(body)].pose;
    return any;
}

void BodyWorld::followAnimation(std::span<const ObjectMotion> motions, std::span<const uint8_t> animated,
                                double time) noexcept {
    const double dt = time - followed_;
    followed_ = time;
    for (const int body : followers_) {
        const auto b = static_cast<size_t>(body);
        for (size_t k = firstObject_[b]; k < firstObject_[b + 1]; ++k) {
            if (animated[objects_[k].object] == 0)
                continue;
            const Similarity at =
                motions[objects_[k].object].workspaceFromObject * objects_[k].bodyFromObject.inverse();
            BodyState& state = states_[b];
            state.velocity =
                dt > 0.0 && dt < 0.1 ? (at.translation - state.pose.position) / dt : glm::dvec3(0.0);
            glm::dquat turn = at.rotation * glm::conjugate(state.pose.rotation);
            if (turn.w < 0.0)
                turn = -turn;
            state.spin =
                dt > 0.0 && dt < 0.1 ? glm::dvec3(turn.x, turn.y, turn.z) * (2.0 / dt) : glm::dvec3(0.0);
            state.pose = {at.rotation, at.translation};
            if (state.velocity != glm::dvec3(0.0) || state.spin != glm::dvec3(0.0))
                wake(body);
            break;
        }
    }
}

bool BodyWorld::keep(uint64_t tick) noexcept {
    const bool kept = kept_.keep(tick, [&](std::span<std::byte> bytes) { return save(bytes); });
    if (!kept)
        earliest_ = tick_; // as in a replay, whether it is recorded or not
    return kept;
}

double BodyWorld::energy(double gravity) const noexcept {
    double energy = solver_->springEnergy(states_);
    for (size_t b = 0; b < states_.size(); ++b)
        if (const BodyMass& mass = masses_[b]; mass.inverse > 0.0)
            energy += kineticEnergy(mass, states_[b]) +
                      mass.gravityFactor * gravity * scale_ * states_[b].pose.position.y / mass.inverse;
    return energy;
}

} // namespace touchstone::body
