#pragma once
// What the servo carries from tick to tick. Private to the servo's own files.

#include "haptics/servo/servo_loop.h"

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace touchstone {

struct ServoLoop::Touch {
    explicit Touch(size_t hands)
        : devices(hands), samples(hands), outputs(hands), traces(hands), felt(hands), records(hands),
          paths(hands), pads(hands), shown(hands), checkpoints(hands) {}

    const Offer* offer = nullptr;
    uint32_t geometry = 0, part = 0;          // of the offer; geometry 0: none
    uint32_t scene = 0, root = 0;             // numbers of the offer and of what it is an edit of
    const HapticSettings* settings = nullptr; // of this tick
    const LiveTool* tool = nullptr;           // of this tick; null: none is active
    // One per hand:
    std::vector<DeviceState> devices;
    std::vector<DeviceSample> samples;
    std::vector<HapticOutput> outputs;
    std::vector<StageTrace> traces;
    struct Felt {
        TouchFeedback feedback; // of the preceding tick
        std::array<glm::dvec3, 3> planes{};
    };
    std::vector<Felt> felt;
    std::vector<TickRecord> records; // of this tick, hand 0 the last
    std::vector<ToolPath> paths;
    std::vector<LocationLimiterState> pads;
    std::vector<PadTick> shown; // in this tick
    bool late = false;          // the previous tick ended after its next deadline
    uint64_t nextCheckpoint = 0;
    double previousTime = std::numeric_limits<double>::quiet_NaN(); // of the preceding tick in this scene
    std::vector<TouchCheckpoint> checkpoints;                       // of this tick, that of hand 0 the last

    /// Everything of the record that is not of one hand is in the record of hand 0.
    TickRecord& record() noexcept { return records.back(); }

    void feelFrom(size_t hand) noexcept {
        const HapticOutput& output = outputs[hand];
        felt[hand].planes = output.planes;
        felt[hand].feedback = {.touching = output.contacts > 0,
                               .hip = output.hip,
                               .proxy = output.proxy,
                               .force = output.force / output.borne,
                               .planes = {felt[hand].planes.data(), output.planeCount},
                               .object = output.object};
    }

    /// Offers of equal geometry (adopt_offers.cpp).
    [[nodiscard]] bool canTakeOver(const Offer& next, uint64_t longest, uint64_t& waited) const noexcept;
    uint64_t aside = 0, editAside = 0; // ticks for which the next offer, and the next edit, have waited
    [[nodiscard]] bool takeOver(const Offer& next, bool otherPart) noexcept;

    /// The command without contact: the force that the device still holds goes to zero within its limits.
    DeviceCommand restCommand(size_t hand, double dt) noexcept {
        uint32_t flags = 0;
        return ForceLimiter::limit(glm::dvec3(0.0), glm::dvec3(0.0),
                                   {.limits = samples[hand].limits, .dt = dt}, {}, devices[hand].limiter,
                                   flags);
    }
};

} // namespace touchstone
