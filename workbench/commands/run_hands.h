#pragma once
// The hands of `run`: devices, and simulated hands that stroke the model.

#include "devices/device/mapped_device.h"
#include "devices/link/linked_device.h"
#include "devices/plant/hand_impedance.h"
#include "devices/simulated/simulated_hand.h"
#include "haptics/servo/servo_loop.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

#include <memory>
#include <string>
#include <vector>

namespace touchstone {

/// Main thread; the servo uses the hands through the ports of `connect`. They outlive the servo.
class RunHands {
  public:
    /// Opens the devices. Throws Error.
    explicit RunHands(const RunOptions& options);
    RunHands(const RunHands&) = delete;
    RunHands& operator=(const RunHands&) = delete;

    /// Connects all hands; a simulated one gets the stroke on the model. Of n simulated hands hand i
    /// (from 0) starts i/n of the period later. Throws Error where the stroke cannot be laid.
    [[nodiscard]] std::vector<DevicePort> connect(const Model& model);

    [[nodiscard]] size_t count() const { return hands_.size(); }
    [[nodiscard]] bool simulated(size_t hand) const { return hands_[hand].device == nullptr; }
    /// s, once round the stroke of a simulated hand.
    [[nodiscard]] double period(size_t hand) const { return hands_[hand].path->path().period(); }
    /// s after which it starts.
    [[nodiscard]] double wait(size_t hand) const { return hands_[hand].wait; }
    /// {device, link, stroke, workspace_scale, loop} of one hand.
    [[nodiscard]] nlohmann::ordered_json json(size_t hand) const;

  private:
    struct Hand {
        std::unique_ptr<LinkedDevice> device; // null: simulated
        std::unique_ptr<SimulatedHand> path;
        std::unique_ptr<HandImpedance> yielding;
        std::unique_ptr<MappedDevice> mapped;
        double wait = 0.0; // s
    };

    const RunOptions& options_;
    std::vector<Hand> hands_;
};

} // namespace touchstone
