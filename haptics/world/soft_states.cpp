#include "haptics/world/soft_states.h"

#include "engine/core/float_mode.h"
#include "haptics/world/deformation_of.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <utility>

namespace touchstone {

namespace {

constexpr double kUnitsPerMetre = 100.0; // of SoftState
constexpr double kInterval = 1.0 / body::kSoftRate;
/// SoftState::calm of a body whose last states are all the same.
constexpr uint32_t kLongAsleep = body::kSoftCalm + 6;
constexpr auto kPause = std::chrono::microseconds(400);

const MeshDeformation* softOf(const Scene& scene, const HapticObject& object) {
    const MeshDeformation* const deformation = deformationOf(scene, object);
    return deformation != nullptr && deformation->soft != nullptr ? deformation : nullptr;
}

/// Normals are made whether a material shades with them or not: an edit may switch that.
size_t normalsOf(const HapticObject& object) {
    return size_t{std::ranges::max(object.sourceIndices)} + 1;
}

/// Without the spare ones.
size_t verticesOf(const HapticScene& haptic, const std::vector<size_t>& objects) {
    size_t vertices = 0;
    for (const size_t k : objects)
        vertices += haptic.objects[k]->vertices.size() - 1;
    return vertices;
}

/// Bytes after bytes.
class StateBytes {
  public:
    explicit StateBytes(std::byte* at) : at_(at) {}
    template <class T>
    void put(const T* values, size_t count) {
        std::memcpy(at_, values, count * sizeof(T));
        at_ += count * sizeof(T);
    }

  private:
    std::byte* at_;
};

class StateSource {
  public:
    explicit StateSource(const std::byte* at) : at_(at) {}
    template <class T>
    void get(T* values, size_t count) {
        std::memcpy(values, at_, count * sizeof(T));
        at_ += count * sizeof(T);
    }

  private:
    const std::byte* at_;
};

/// The numbers of a kept state before its pushes and vertices.
struct Clock {
    uint64_t interval = 0;
    double fraction = 0.0, pending = 0.0;
    uint64_t first = 0;
};

/// Of a state of one body beside its vertices.
struct Calm {
    uint32_t steps = 0;
    float gravity = 0.0f;
};

/// States that a moment and the next step depend on: the one before, in which hands felt, and both ends.
constexpr uint64_t kStates = 3;
uint64_t keptState(uint64_t interval, uint64_t i) {
    return std::max<uint64_t>(interval + i, 1) - 1;
}

} // namespace

std::vector<size_t> softObjects(const Scene* source, const HapticScene& haptic) {
    std::vector<size_t> objects;
    for (size_t k = 0; source != nullptr && k < haptic.objects.size(); ++k)
        if (softOf(*source, *haptic.objects[k]) != nullptr &&
            haptic.objects[k]->vertices.size() - 1 <= kMaxSoftVertices) // without the spare one
            objects.push_back(k);
    return objects;
}

SoftStates::SoftStates(const Scene& source, const HapticScene& haptic, const std::vector<size_t>& objects)
    : vertices_(verticesOf(haptic, objects)), publication_(std::vector<glm::vec3>(vertices_)) {
    for (const size_t k : objects)
        add(source, haptic, k);
    for (uint64_t state : {0, 1})
        for (size_t b = 0; b < bodies_.size(); ++b)
            publishState(state, b);
    for (size_t b = 0; b < bodies_.size(); ++b)
        publishInterval(0, b);
    made_.store(1, std::memory_order_relaxed);
    asked_.store(2, std::memory_order_relaxed);
    show(1);
    kept_.resize(stateSize());
}

SoftStates::~SoftStates() = default;

void SoftStates::add(const Scene& source, const HapticScene& haptic, size_t k) {
    const std::shared_ptr<const HapticObject>& mesh = haptic.objects[k];
    const std::shared_ptr<const SoftBody>& law = softOf(source, *mesh)->soft;
    const Similarity& workspaceFromObject = haptic.restMotions[k].workspaceFromObject;
    const Similarity sceneFromWorkspace = haptic.workspaceFromScene.inverse();
    body::SoftShape shape;
    shape.triangles = mesh->indices;
    for (size_t v = 0; v + 1 < mesh->vertices.size(); ++v) { // without the spare one
        const glm::dvec3 place = workspaceFromObject.point(glm::dvec3(mesh->vertices[v]));
        shape.vertices.push_back(place);
        const glm::dvec3 stated = sceneFromWorkspace.point(place);
        shape.fixed.push_back(law->fixedLow && glm::all(glm::greaterThanEqual(stated, *law->fixedLow)) &&
                                      glm::all(glm::lessThanEqual(stated, *law->fixedHigh))
                                  ? 1
                                  : 0);
    }
    for (const int instance : law->over) {
        const Instance& placed = source.instances[static_cast<size_t>(instance)];
        std::vector<glm::dvec3>& hull = shape.hulls.emplace_back();
        for (const glm::vec3& p : source.meshes[static_cast<size_t>(placed.mesh)].positions)
            hull.push_back(haptic.workspaceFromScene.point(
                glm::dvec3(placed.sceneFromMesh * glm::dvec4(glm::dvec3(p), 1.0))));
    }
    Soft soft;
    soft.object = k;
    soft.law = law;
    soft.mesh = mesh;
    soft.objectFromWorkspace = workspaceFromObject.inverse();
    soft.solver = std::make_unique<body::SoftSolver>(*law, shape, haptic.workspaceFromScene.scale);
    const size_t normals = normalsOf(*mesh);
    soft.source.assign(normals, 0);
    soft.normals.resize(shape.vertices.size());
    for (size_t i = 0; i < mesh->indices.size(); ++i)
        soft.source[mesh->sourceIndices[i]] = mesh->indices[i];
    for (std::vector<Part>& state : ring_)
        state.push_back({.state = soft.solver->rest(),
                         .vertices = std::vector<glm::vec3>(shape.vertices.size()),
                         .normals = std::vector<glm::vec3>(normals),
                         .interval = {.tree = mesh->tree}});
    shown_.push_back({k, shape.vertices.size()});
    bodies_.push_back(std::move(soft));
}

bool SoftStates::fit(const Scene& source, const HapticScene& haptic,
                     const std::vector<size_t>& objects) const {
    if (objects.size() != bodies_.size())
        return false;
    for (size_t b = 0; b < bodies_.size(); ++b) {
        const Soft& soft = bodies_[b];
        if (objects[b] != soft.object)
            return false;
        const HapticObject& mesh = *haptic.objects[soft.object];
        if (softOf(source, mesh)->soft != soft.law || mesh.indices != soft.mesh->indices ||
            mesh.vertices.size() != soft.mesh->vertices.size() ||
            mesh.sourceIndices != soft.mesh->sourceIndices)
            return false;
    }
    return true;
}

bool softGoOn(const SoftStates* states, const Scene* source, const HapticScene& haptic) {
    const std::vector<size_t> objects = softObjects(source, haptic);
    return states == nullptr ? objects.empty() : !objects.empty() && states->fit(*source, haptic, objects);
}

MeshMoment SoftStates::at(const Moment& moment, size_t body) const noexcept {
    const Part &from = part(moment.interval, body), &to = part(moment.interval + 1, body);
    return {&from.interval,
            {from.vertices.data(), to.vertices.data(), moment.fraction},
            {from.normals.data(), to.normals.data(), moment.fraction}};
}

double SoftStates::travel(size_t body) const noexcept {
    const double now = part(moment_.interval, body).interval.longest,
                 was = part(previous_.interval, body).interval.longest;
    return previous_.interval == moment_.interval ? std::abs(moment_.fraction - previous_.fraction) * now
                                                  : (1.0 - previous_.fraction) * was + moment_.fraction * now;
}

bool SoftStates::moves(size_t body) const noexcept {
    return part(moment_.interval, body).interval.longest > 0.0 ||
           part(previous_.interval, body).interval.longest > 0.0;
}

/// The vertices and normals of a state.
void SoftStates::publishState(uint64_t state, size_t b) noexcept {
    Soft& soft = bodies_[b];
    Part& at = part(state, b);
    for (size_t v = 0; v < at.vertices.size(); ++v)
        at.vertices[v] =
            glm::vec3(soft.objectFromWorkspace.point(glm::dvec3(at.state.places[v]) / kUnitsPerMetre));
    std::ranges::fill(soft.normals, glm::vec3(0.0f));
    const std::vector<uint32_t>& indices = soft.mesh->indices;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::vec3& a = at.vertices[indices[i]];
        const glm::vec3 twice = glm::cross(at.vertices[indices[i + 1]] - a, at.vertices[indices[i + 2]] - a);
        for (size_t corner = i; corner < i + 3; ++corner)
            soft.normals[indices[corner]] += twice;
    }
    for (size_t v = 0; v < at.normals.size(); ++v) {
        const glm::vec3& sum = soft.normals[soft.source[v]];
        const float length = glm::length(sum);
        at.normals[v] = length > 0.0f ? sum / length : glm::vec3(0.0f);
    }
}

/// The tree of the interval between a state and the next.
void SoftStates::publishInterval(uint64_t interval, size_t b) noexcept {
    part(interval, b)
        .interval.fit(part(interval, b).vertices, part(interval + 1, b).vertices, bodies_[b].mesh->indices);
}

void SoftStates::make(uint64_t state) noexcept {
    std::array<body::SoftPush, kPushes> pushes;
    bool moved = false;
    for (size_t b = 0; b < bodies_.size(); ++b) {
        size_t count = 0;
        for (uint64_t i = 0; i < given_.count; ++i)
            if (given_.pushes[i].body == b)
                pushes[count++] = given_.pushes[i].push;
        const uint64_t felt = std::max<uint64_t>(state, 3) - 3;
        body::SoftState& next = part(state, b).state;
        bodies_[b].solver->step(part(state - 1, b).state, part(felt, b).state, part(state - 2, b).state,
                                std::span(pushes).first(count), given_.gravity, state, next);
        // All states of the ring are the one in which it fell asleep.
        next.calm = std::min(next.calm + (body::SoftSolver::asleep(next) ? 1u : 0u), kLongAsleep);
        if (next.calm == kLongAsleep)
            continue;
        publishState(state, b);
        publishInterval(state - 1, b);
        moved = true;
    }
    if (moved)
        show(state);
    made_.store(state, std::memory_order_release);
}

/// For the eye.
void SoftStates::show(uint64_t state) noexcept {
    size_t at = 0;
    std::vector<glm::vec3>& back = publication_.back();
    for (size_t b = 0; b < bodies_.size(); ++b) {
        const std::vector<glm::vec3>& vertices = part(state, b).vertices;
        std::ranges::copy(vertices, back.begin() + static_cast<std::ptrdiff_t>(at));
        at += vertices.size();
    }
    publication_.publish();
}

bool SoftStates::advance(bool begins, bool hold) noexcept {
    const bool first = std::exchange(first_, false);
    previous_ = moment_;
    held_ = hold;
    if (begins)
        return first;
    Moment next{moment_.interval, moment_.fraction + pending_ * body::kSoftRate};
    pending_ = 0.0;
    if (!held_ && next.fraction >= 1.0) {
        const uint64_t wanted = moment_.interval + 2;
        if (!apart_ && made_.load(std::memory_order_relaxed) < wanted)
            make(wanted);
        held_ = made_.load(std::memory_order_acquire) < wanted;
    }
    if (held_)
        return first;
    if (next.fraction >= 1.0) {
        next = {next.interval + 1, std::min(next.fraction - 1.0, 1.0)};
        for (uint64_t i = 0; i < gathered_.count; ++i) // now four ticks, now five
            gathered_.pushes[i].push.share /= std::max(gathered_.steps, 1.0);
        given_ = gathered_;
        gathered_.count = 0;
        gathered_.steps = 0.0;
        asked_.store(next.interval + 2, std::memory_order_release);
    }
    moment_ = next;
    return first;
}

void SoftStates::push(int object, const body::HandPush& push) noexcept {
    for (uint64_t b = 0; b < bodies_.size(); ++b)
        if (bodies_[b].object == static_cast<size_t>(object) && gathered_.count < kPushes &&
            push.stiffness > 0.0)
            gathered_.pushes[gathered_.count++] = {
                b, {push.point, push.force, push.stiffness, push.most, moment_.fraction, 0.0}};
}

void SoftStates::integrate(double gravity, double dt) noexcept {
    pending_ = std::min(dt, kInterval);
    gathered_.gravity = gravity;
    gathered_.steps += pending_ * body::kSoftRate;
    for (uint64_t i = gathered_.count; i-- > 0 && gathered_.pushes[i].push.share == 0.0;)
        gathered_.pushes[i].push.share = pending_ * body::kSoftRate;
}

void SoftStates::addTo(Hash64& hash) const noexcept {
    hash.add(moment_.interval);
    hash.add(moment_.fraction);
    hash.add(held_);
    for (size_t b = 0; b < bodies_.size(); ++b) {
        hash.add(part(moment_.interval, b).interval.longest);
        hash.add(part(moment_.interval, b).interval.radius);
    }
}

size_t SoftStates::stateSize() const noexcept {
    return sizeof(Clock) + 2 * sizeof(Input) + shown_.size() * kStates * sizeof(Calm) +
           vertices_ * kStates * 3 * sizeof(glm::vec3);
}

void SoftStates::save(std::span<std::byte> bytes) const noexcept {
    StateBytes to(bytes.data());
    const Clock clock{moment_.interval, moment_.fraction, pending_, first_ ? 1u : 0u};
    to.put(&clock, 1);
    to.put(&gathered_, 1);
    to.put(&given_, 1);
    for (uint64_t i = 0; i < kStates; ++i)
        for (size_t b = 0; b < bodies_.size(); ++b) {
            const body::SoftState& at = part(keptState(moment_.interval, i), b).state;
            const Calm calm{at.calm, at.gravity};
            to.put(&calm, 1);
            to.put(at.places.data(), at.places.size());
            to.put(at.velocities.data(), at.velocities.size());
            to.put(at.anchor.data(), at.anchor.size());
        }
}

bool SoftStates::wellFormed(const Input& input) noexcept {
    bool sound =
        input.count <= kPushes && std::isfinite(input.gravity) && input.steps >= 0.0 && input.steps < 1e3;
    for (uint64_t i = 0; sound && i < input.count; ++i) {
        const body::SoftPush& push = input.pushes[i].push;
        sound = std::isfinite(glm::dot(push.point, push.point) + glm::dot(push.force, push.force) +
                              push.stiffness + push.most) &&
                push.fraction >= 0.0 && push.fraction <= 1.0 && push.share >= 0.0 && push.share <= 1.0;
    }
    return sound;
}

bool SoftStates::restore(std::span<const std::byte> bytes) noexcept {
    if (bytes.size() != stateSize() || apart_)
        return false;
    StateSource from(bytes.data());
    Clock clock;
    Input gathered, given;
    from.get(&clock, 1);
    from.get(&gathered, 1);
    from.get(&given, 1);
    if (!(clock.fraction >= 0.0 && clock.fraction <= 1.0 && clock.pending >= 0.0 &&
          clock.pending <= kInterval && clock.interval < UINT64_MAX - 8 && wellFormed(gathered) &&
          wellFormed(given)))
        return false;
    bool sound = true;
    for (uint64_t i = 0; i < kStates; ++i)
        for (size_t b = 0; b < bodies_.size(); ++b) {
            Calm calm;
            body::SoftState& at = part(keptState(clock.interval, i), b).state;
            from.get(&calm, 1);
            from.get(at.places.data(), at.places.size());
            from.get(at.velocities.data(), at.velocities.size());
            from.get(at.anchor.data(), at.anchor.size());
            // The other states of the ring are not those in which it fell asleep.
            at.calm = std::min(calm.steps, body::kSoftCalm);
            at.gravity = calm.gravity;
            bool finite = std::isfinite(at.gravity);
            for (size_t v = 0; v < at.places.size(); ++v)
                finite = finite && std::isfinite(glm::dot(at.places[v], at.places[v]) +
                                                 glm::dot(at.velocities[v], at.velocities[v]) +
                                                 glm::dot(at.anchor[v], at.anchor[v]));
            if (!finite)
                at = bodies_[b].solver->rest();
            sound = sound && finite;
            publishState(keptState(clock.interval, i), b);
        }
    gathered_ = sound ? gathered : Input{};
    given_ = sound ? given : Input{};
    for (size_t b = 0; b < bodies_.size(); ++b)
        publishInterval(clock.interval, b);
    moment_ = previous_ = {clock.interval, clock.fraction};
    pending_ = clock.pending;
    first_ = clock.first != 0;
    made_.store(clock.interval + 1, std::memory_order_relaxed);
    asked_.store(clock.interval + 2, std::memory_order_relaxed);
    return sound;
}

bool SoftStates::keep(uint64_t tick) noexcept {
    return kept_.keep(tick, [&](std::span<std::byte> bytes) {
        save(bytes);
        return stateSize();
    });
}

void SoftStates::run(const std::stop_token& stop) noexcept {
    enterFloatMode(); // the replay's is the same
    while (!stop.stop_requested()) {
        const uint64_t wanted = asked_.load(std::memory_order_acquire);
        if (made_.load(std::memory_order_relaxed) < wanted)
            make(wanted);
        else
            std::this_thread::sleep_for(kPause);
    }
}

void SoftStates::stepApart() {
    if (thread_.joinable())
        return;
    apart_ = true;
    thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
}

} // namespace touchstone
