#include "haptics/recording/stage_hashes.h"

#include "engine/core/checksum.h"

namespace touchstone {

namespace {

/// Bits of TickFlag that stage 8 sets.
constexpr uint32_t kSafetyFlags = 0u | TickFlag::ForceLimited | TickFlag::ForceFault |
                                  TickFlag::ForceRamping | TickFlag::SafetyLatched | TickFlag::EnergyGiven |
                                  TickFlag::EnergyDamped;

template <class... Values>
uint32_t hashOf(const Values&... values) noexcept {
    Hash64 hash;
    const auto add = [&](const auto& value) {
        if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, glm::dvec3>) {
            hash.add(value.x);
            hash.add(value.y);
            hash.add(value.z);
        } else {
            hash.add(value);
        }
    };
    (add(values), ...);
    return hash.folded();
}

} // namespace

StageHashes stageHashes(const StageTrace& trace, const HapticOutput& output) noexcept {
    return {hashOf(output.hip, output.hipVelocity),
            hashOf(trace.proxy[0], trace.reference),
            hashOf(trace.proxy[1]),
            hashOf(trace.proxy[2]),
            hashOf(output.contacts, output.object, output.triangle, output.normal, output.height,
                   output.planeCount, output.planes[0], output.planes[1], output.planes[2]),
            hashOf(output.proxy, output.friction, output.stictionPoint),
            hashOf(output.force, output.penetration, output.iterations, output.flags & ~kSafetyFlags),
            hashOf(output.command.force(), output.command.torque(), output.commandInWorkspace,
                   output.energyBalance, output.flags)};
}

} // namespace touchstone
