#include "devices/simulated_hand.h"

namespace touchstone {

DeviceSample SimulatedHand::sample(double time) noexcept {
    DeviceSample sample;
    sample.position = path_->positionIn(time, time);
    sample.valid = true;
    return sample;
}

} // namespace touchstone
