#include "devices/simulated/simulated_hand.h"

#include <algorithm>
#include <utility>

namespace touchstone {

DeviceSample SimulatedHand::sample(double time) noexcept {
    DeviceSample sample;
    sample.position = path_->positionIn(std::max(0.0, time - wait_), animation_.value_or(time));
    sample.valid = true;
    sample.begins = !std::exchange(begun_, true);
    sample.inSight = true; // its path is laid onto the model
    return sample;
}

} // namespace touchstone
