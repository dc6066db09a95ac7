#include "haptics/state/touch_checkpoint.h"

#include "engine/core/member_count.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace touchstone {

namespace {

/// Everything that one tick leaves to the next, in the order of the bytes: scalars, vectors and arrays of
/// them. Excluded: what a tick writes before it reads (rest, carried, obstacleCandidates,
/// limiter.passivity.way) and what can be gathered again (candidates). A field that is added to DeviceState
/// and outlives the tick must be added here and to docs/recording.md; tests/unit/recording checks the sizes.
template <class State, class Visit>
void eachField(State& s, const Visit& visit) {
    visit(s.sampled);
    visit(s.hip);
    visit(s.travel);
    visit(s.velocity);
    visit(s.unsampled);
    visit(s.placed);
    visit(s.mustLeave);
    visit(s.reference);
    visit(s.proxy);
    visit(s.clearance);
    visit(s.jammed.objects);
    visit(s.jammed.places);
    visit(s.jammed.count);
    visit(s.gatherMargin);
    visit(s.watch.side);
    visit(s.watch.touching);
    visit(s.shaded);
    visit(s.shadedNormal);
    visit(s.shadedTurn);
    visit(s.shadedObject);
    visit(s.shadedTriangle);
    visit(s.friction);
    visit(s.stictionPoint);
    visit(s.frictionless);
    visit(s.limiter.lastForce);
    visit(s.limiter.lastTorque);
    visit(s.limiter.heldForce);
    visit(s.limiter.heldTorque);
    visit(s.limiter.ramp);
    visit(s.limiter.lateInARow);
    visit(s.limiter.faults);
    visit(s.limiter.latched);
    visit(s.limiter.passivity.placed);
    visit(s.limiter.passivity.reading);
    visit(s.limiter.passivity.position);
    visit(s.limiter.passivity.delayed);
    visit(s.limiter.passivity.balance);
    // Since programs: checkpoints of before end here.
    visit(s.tool.known);
    visit(s.tool.velocity);
    visit(s.tool.acceleration);
    visit(s.tool.direction);
    visit(s.tool.time);
    // Since local deformation and grasping.
    visit(s.dents.object);
    visit(s.dents.centre);
    visit(s.dents.normal);
    visit(s.dents.depth);
    visit(s.grasp.object);
    visit(s.grasp.place);
    visit(s.grasp.rotation);
}

static_assert(memberCount<DeviceState>() == 29 && memberCount<ForceLimiterState>() == 9 &&
                  memberCount<PassivityState>() == 6 && memberCount<WatchState>() == 2 &&
                  memberCount<ToolMotion>() == 5 && memberCount<Dents>() == 4 && memberCount<Grasp>() == 3,
              "a member was added: does it outlive the tick? Then eachField visits it");

/// Only the fields that eachField visits; a copy of the whole DeviceState would be a megabyte.
struct CarriedFields {
    bool sampled = false;
    glm::dvec3 hip{0.0}, travel{0.0}, velocity{0.0};
    double unsampled = 0.0;
    bool placed = false, mustLeave = false;
    int reference = -1;
    glm::dvec3 proxy{0.0};
    double clearance = 0.0;
    JammedObjects jammed;
    double gatherMargin = 0.0;
    WatchState watch;
    bool shaded = false;
    glm::dvec3 shadedNormal{0.0}, shadedTurn{0.0};
    int shadedObject = -1;
    uint32_t shadedTriangle = 0;
    FrictionState friction = FrictionState::Free;
    glm::dvec3 stictionPoint{0.0}, frictionless{0.0};
    ForceLimiterState limiter;
    ToolMotion tool;
    Dents dents;
    Grasp grasp;
};

/// Bytes at the end that older versions do not write: without dents and grasp, and without ToolMotion, too.
constexpr size_t kDentBytes = sizeof(Dents::object) + sizeof(Dents::centre) + sizeof(Dents::normal) +
                              sizeof(Dents::depth) + sizeof(Grasp::object) + sizeof(Grasp::place) +
                              sizeof(Grasp::rotation);
constexpr size_t kToolBytes = sizeof(bool) + 3 * sizeof(glm::dvec3) + sizeof(double);

/// Upper bound of every number that a touch produces, in any unit; Embree takes none above 1.8e18.
constexpr double kLargest = 1e15;

bool reasonable(const CarriedFields& fields) {
    bool all = fields.gatherMargin > 0.0;
    const auto look = [&](double number) { all &= std::abs(number) < kLargest; };
    const auto lookAt = [&](const glm::dvec3& v) {
        look(v.x);
        look(v.y);
        look(v.z);
    };
    eachField(fields, [&](const auto& field) {
        using Field = std::remove_cvref_t<decltype(field)>;
        if constexpr (std::is_same_v<Field, double>)
            look(field);
        else if constexpr (std::is_same_v<Field, glm::dvec3>)
            lookAt(field);
        else if constexpr (std::is_same_v<Field, decltype(JammedObjects::places)> ||
                           std::is_same_v<Field, decltype(Dents::centre)>)
            std::for_each(field.begin(), field.end(), lookAt);
        else if constexpr (std::is_same_v<Field, decltype(Dents::depth)>)
            std::for_each(field.begin(), field.end(), look);
        else if constexpr (std::is_same_v<Field, glm::dquat>)
            look(glm::length(field));
    });
    return all;
}

bool possible(const CarriedFields& fields, const HapticScene* scene) {
    if (!reasonable(fields))
        return false;
    const int objects = scene != nullptr ? static_cast<int>(scene->objects.size()) : 0;
    if (fields.reference >= objects || fields.jammed.count > JammedObjects::kMax ||
        fields.friction > FrictionState::Sliding)
        return false;
    for (size_t i = 0; i < fields.jammed.count; ++i)
        if (fields.jammed.objects[i] < 0 || fields.jammed.objects[i] >= objects)
            return false;
    for (size_t i = 0; i < Dents::kMax; ++i)
        if (fields.dents.depth[i] < 0.0 ||
            (fields.dents.depth[i] > 0.0 &&
             (fields.dents.object[i] < 0 || fields.dents.object[i] >= objects)))
            return false;
    if (fields.grasp.object >= objects)
        return false;
    const auto inObject = [&](int object, uint32_t triangle) {
        return object >= 0 && object < objects &&
               triangle < scene->objects[static_cast<size_t>(object)]->triangleCount();
    };
    const auto isFeature = [&](int object, uint32_t feature) {
        return inObject(object, feature) || (object >= 0 && object < objects &&
                                             scene->objects[static_cast<size_t>(object)]->shape != nullptr);
    };
    // After a scene swap it names a facet of the previous scene, which is never used.
    if (fields.shaded && fields.shadedObject != -1 && !isFeature(fields.shadedObject, fields.shadedTriangle))
        return false;
    // A virtual point (comparison/virtual_point.h) has no side.
    return !fields.watch.touching || isFeature(fields.reference, triangleOf(fields.watch.side));
}

/// Decodes the bytes into fields. A bool is read as a number: any byte but 0 and 1 would be no bool.
template <class State>
void readFields(std::span<const std::byte> bytes, State& state) {
    size_t at = 0;
    eachField(state, [&](auto& field) {
        if (at == bytes.size()) // of a version without it: as in a new state
            return;
        if constexpr (std::is_same_v<std::remove_reference_t<decltype(field)>, bool>)
            field = bytes[at] != std::byte{0};
        else
            std::memcpy(&field, bytes.data() + at, sizeof field);
        at += sizeof field;
    });
}

} // namespace

void takeCheckpoint(DeviceState& state, TouchCheckpoint& checkpoint) noexcept {
    state.candidates.invalidate();
    size_t at = 0;
    eachField(state, [&](const auto& field) {
        static_assert(std::is_trivially_copyable_v<std::remove_reference_t<decltype(field)>>);
        std::memcpy(checkpoint.bytes.data() + at, &field, sizeof field);
        at += sizeof field;
    });
    checkpoint.size = static_cast<uint32_t>(at);
}

bool restoreCheckpoint(std::span<const std::byte> bytes, const HapticScene* scene,
                       DeviceState& state) noexcept {
    const size_t older = checkpointSize() - kDentBytes;
    if (bytes.size() != checkpointSize() && bytes.size() != older && bytes.size() != older - kToolBytes)
        return false;
    CarriedFields fields;
    readFields(bytes, fields);
    if (!possible(fields, scene))
        return false;
    state.tool = {};
    state.dents = {};
    state.grasp = {};
    readFields(bytes, state);
    state.candidates.invalidate();
    state.candidates.ignore(state.jammed.ignored());
    return true;
}

size_t checkpointSize() noexcept {
    size_t size = 0;
    CarriedFields fields;
    eachField(fields, [&](const auto& field) { size += sizeof field; });
    return size;
}

} // namespace touchstone
