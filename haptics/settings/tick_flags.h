#pragma once

#include <cstdint>

namespace touchstone {

/// Events and states of a tick, as bits.
enum class TickFlag : uint32_t {
    None = 0,
    InputInvalid = 1u << 0,  ///< no sample, stale or not finite: no force
    StartedInside = 1u << 1, ///< touch began inside, or where the hand must leave the model: nothing is felt
                             ///< until it is out
    BudgetReached = 1u << 2, ///< proxy solve stopped at the iteration budget: sticky, still safe
    CandidatesFull =
        1u << 3, ///< more triangles near the proxy than a tick can hold; the motion was cut short
    ShadingNotConverged = 1u << 4,
    TiltCompressed = 1u << 5, ///< the texture's normal was steeper than textureTiltLimit
    ForceLimited = 1u << 6,   ///< safety clamped magnitude or slew
    ForceFault = 1u << 7,     ///< a NaN or infinity reached safety in this tick: the command is zero
    Teleported = 1u << 8,     ///< the HIP jumped farther than a hand can move; swept nevertheless
    ForceRamping = 1u << 9,   ///< safety fades the force in (enabled, scene swapped) or out (input stale)
    NeighbourhoodMissing =
        1u << 11,             ///< the contact method lacks its data, or does not handle an object: swept
    SafetyLatched = 1u << 10, ///< after a fault or late ticks: no force until it is switched off and on again
    Jammed = 1u << 12, ///< moving objects left the proxy no room: it stays with one, the others are not felt
    EnergyGiven = 1u << 14,     ///< the device gave more energy than it took, by more than kNoticedEnergy
    EnergyDamped = 1u << 15,    ///< passivity=control: a damper took some of it back
    DeformationHeld = 1u << 16, ///< vertices were not published in time: the deforming objects stood still
    ProgramFailed = 1u << 17,   ///< a haptic program had no result within the budget: its surface was plain
    ObjectJumped = 1u << 13,    ///< an object was placed elsewhere (an animation restarted) and swept nothing
};
[[nodiscard]] constexpr uint32_t operator|(uint32_t flags, TickFlag flag) {
    return flags | static_cast<uint32_t>(flag);
}
[[nodiscard]] constexpr bool has(uint32_t flags, TickFlag flag) {
    return (flags & static_cast<uint32_t>(flag)) != 0;
}

} // namespace touchstone
