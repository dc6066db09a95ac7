#include "devices/simulated/simulated_hand.h"

#include <utility>

namespace touchstone {

DeviceSample SimulatedHand::sample(double time) noexcept {
    DeviceSample sample;
    sample.position = path_->positionIn(time, time);
    sample.valid = true;
    sample.begins = !std::exchange(begun_, true);
    sample.inSight = true; // its path is laid onto the model
    return sample;
}

} // namespace touchstone
