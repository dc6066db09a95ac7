#include "devices/plant/hand_impedance.h"

namespace touchstone {

DeviceLimits limitsOf(const PlantParameters& parameters) {
    DeviceLimits limits;
    limits.maxForce = parameters.maxForce;
    limits.positionResolution = parameters.resolution;
    limits.apparentMass = parameters.mass;
    limits.coulombFriction = parameters.coulombFriction;
    limits.commandDelay = parameters.delay > 0;
    return limits;
}

HandImpedance::HandImpedance(Device& intention, const PlantParameters& parameters)
    : intention_(intention), plant_(parameters) {}

DeviceSample HandImpedance::sample(double time) noexcept {
    DeviceSample sample = intention_.sample(time);
    if (!sample.valid) {
        placed_ = false;
        return sample;
    }
    if (placed_ && time > time_ && time - time_ <= kLongestGap) {
        plant_.advance(time - time_, held_, intended_, sample.position);
    } else {
        plant_.place(sample.position, glm::dvec3(0.0));
        pending_ = glm::dvec3(0.0);
    }
    held_ = pending_;
    placed_ = true;
    time_ = time;
    intended_ = sample.position;
    sample.position = plant_.measured();
    return sample;
}

void HandImpedance::push(const glm::dvec3& force) noexcept {
    pending_ = force;
    if (plant_.parameters().delay == 0)
        held_ = force;
}

} // namespace touchstone
