#include "devices/plant/yielding_hand.h"

namespace touchstone {

YieldingHand::YieldingHand(Device& intention, const PlantParameters& parameters)
    : intention_(intention), plant_(parameters) {}

DeviceLimits YieldingHand::limits() const {
    DeviceLimits limits = intention_.limits();
    limits.maxForce = plant_.parameters().maxForce;
    limits.positionResolution = plant_.parameters().resolution;
    limits.apparentMass = plant_.parameters().mass;
    limits.coulombFriction = plant_.parameters().coulombFriction;
    limits.commandDelay = plant_.parameters().delay > 0;
    return limits;
}

DeviceSample YieldingHand::sample(double time) noexcept {
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

void YieldingHand::push(const glm::dvec3& force) noexcept {
    pending_ = force;
    if (plant_.parameters().delay == 0)
        held_ = force;
}

} // namespace touchstone
