#include "study/live/reference_touch.h"

#include "engine/scene/mesh_deformation.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone::study {

namespace {

/// Exactly zero between equal vectors, which a cross product is not; neither vector is zero.
double exactAngle(const glm::dvec3& a, const glm::dvec3& b) {
    const glm::dvec3 u = a / glm::length(a), v = b / glm::length(b);
    return 2.0 * std::atan2(glm::length(u - v), glm::length(u + v));
}

/// Of the surface's own forces: a hand that gives way (DeviceLimits::press) bears the same part of any.
TickError errorOf(const HapticOutput& felt, const HapticOutput& exact) {
    using Contact = TickError::Contact;
    TickError error;
    const bool touches = felt.contacts > 0, should = exact.contacts > 0;
    if (!touches && !should)
        return error;
    const glm::dvec3 own = felt.force / felt.borne, ownExact = exact.force / exact.borne;
    error.forceDifference = glm::length(own - ownExact);
    error.contact = !should ? Contact::Invented : touches ? Contact::Both : Contact::Lost;
    if (error.contact != Contact::Both)
        return error;
    const double force = glm::length(own), right = glm::length(ownExact);
    error.position = glm::length(felt.proxy - exact.proxy);
    error.force = std::abs(force - right);
    error.forceShare = right > 0.0 ? error.force / right : 0.0;
    error.direction = force > 0.0 && right > 0.0 ? exactAngle(own, ownExact) : 0.0;
    return error;
}

} // namespace

HapticSettings referenceOf(const HapticSettings& settings) {
    constexpr int kToTheEnd = 1000; // the maximum that --set takes
    HapticSettings exact = settings;
    exact.contact = ContactMethod::Sweep;
    exact.proxyRadius = feltRadius(settings);
    exact.iterationBudget = kToTheEnd;
    exact.forceShading = ShadingMode::TwoPass;
    exact.textureFilter = TextureFilter::Bicubic;
    exact.textureGradient = TextureGradient::Central;
    return exact;
}

void ReferenceTouch::enter(std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    // Bodies, rigid or soft, are where they are by all ticks before: this one does not have them.
    scene_ = source != nullptr && (source->physics != nullptr || hasSoftBodies(*source)) ? nullptr
                                                                                         : std::move(scene);
    world_ = scene_ != nullptr ? WorldState(std::move(source), *scene_) : WorldState();
    state_.forgetTouch();
    state_.mustLeave = true;
    follows_ = false;
}

void ReferenceTouch::adopt(const TickRecord& record, const HapticSettings& settings, ObjectMotions motions) {
    const HapticOutput& felt = record.output;
    state_.forgetTouch();
    state_.mustLeave = has(felt.flags, TickFlag::StartedInside) && !record.sample.inSight;
    state_.sampled = !has(felt.flags, TickFlag::InputInvalid);
    state_.hip = felt.hip;
    state_.velocity = felt.hipVelocity;
    state_.travel = glm::dvec3(0.0);
    state_.unsampled = 0.0;
    // Where objects move, the proxy moves with the touched object from there on.
    const int reference = felt.object >= 0 && world_.moving() ? felt.object : record.trace.reference;
    if (!state_.sampled || has(felt.flags, TickFlag::StartedInside) || reference < 0 ||
        static_cast<size_t>(reference) >= motions.size())
        return; // the next tick places it at its HIP
    // A virtual point is no valid start of the sweep: the reference begins when the hand has left.
    if (felt.contacts > 0 &&
        (settings.contact == ContactMethod::VirtualPoint || settings.contact == ContactMethod::Potential))
        return;
    const Similarity& workspaceFromReference = motions[static_cast<size_t>(reference)].workspaceFromObject;
    state_.reference = reference;
    state_.placed = true;
    state_.clearance = feltRadius(settings);
    state_.proxy = workspaceFromReference.inversePoint(felt.proxy);
    if (settings.contact == ContactMethod::Neighbourhood) {
        // The proxy of a walk stands on the facet itself, where the sweep has no side: it is moved slightly
        // off, and the stiction point is released (neighbourhood_watch.cpp, leaveWatch).
        const HapticObject& object = *scene_->objects[static_cast<size_t>(reference)];
        for (uint32_t i = 0; i < felt.planeCount; ++i)
            state_.proxy += kWeldTolerance * object.diagonal *
                            (glm::conjugate(workspaceFromReference.rotation) * felt.planes[i]);
        return;
    }
    state_.friction = felt.friction;
    state_.frictionless = reference == record.trace.reference ? record.trace.proxy.back() : state_.proxy;
    if (felt.friction != FrictionState::Free)
        state_.stictionPoint = workspaceFromReference.inversePoint(felt.stictionPoint);
}

bool ReferenceTouch::compare(const TickRecord& record, const HapticSettings& settings, TickError& error) {
    if (scene_ == nullptr || scene_->objects.empty())
        return false;
    if (follows_ && record.step != nextStep_) {
        world_.forget();
        follows_ = false;
    }
    nextStep_ = record.step + 1;
    const ObjectMotions moved = world_.advance(animationTime(settings, record.time),
                                               has(record.output.flags, TickFlag::DeformationHeld));
    if (!std::exchange(follows_, true)) {
        adopt(record, settings, moved.empty() ? ObjectMotions(scene_->restMotions) : moved);
        return false;
    }
    TickInput input;
    input.tick = record.tick;
    input.time = record.time;
    input.dt = record.dt;
    input.late = record.late;
    input.hands = {&record.sample, 1};
    StageTrace trace;
    StageTracer tracer(state_,
                       trace); // the servo's instantiation: equal configurations give equal bits
    hapticStep(*scene_, referenceOf(settings), input, world_, {&state_, 1}, {&output_, 1}, tracer);
    if (has(output_.flags, TickFlag::StartedInside) && record.output.contacts > 0)
        return false; // it has not begun (adopt)
    error = errorOf(record.output, output_);
    return true;
}

} // namespace touchstone::study
