#pragma once
// What a haptic program costs.

#include "haptics/program/register_program.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <string_view>

namespace touchstone {

/// instructions, registers; ns_per_tick of a call without gradients, ns_with_gradients (dual numbers) and
/// ns_with_differences (central), each of the fastest of 20 batches of 500 touches of a patch of 50 mm; cost
/// (the greatest met) beside budget; flagged_share (of touches without a result) and fault, why one of them
/// has none (program_fault.h), empty where all have. `source`: its text. Takes some 50 ms; no batch begins
/// after `longestNs` ns, but each kind of call has one. Not for the servo.
[[nodiscard]] nlohmann::ordered_json programFigures(const program::RegisterProgram& compiled,
                                                    std::string_view source,
                                                    int64_t longestNs = 2'000'000'000);

} // namespace touchstone
