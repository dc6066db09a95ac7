#include "workbench/experiment/experiment_hand.h"

#include "devices/choice/device_choice.h"

namespace touchstone {

ExperimentHand::ExperimentHand(const std::string& choice) {
    if (choice.empty() || choice == "mouse")
        return;
    linked_ = openDevice(choice, "mouse");
    if (linked_)
        linked_->takeUp();
}

} // namespace touchstone
