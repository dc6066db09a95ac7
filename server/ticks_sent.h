#pragma once
// Ticks and states as clients get them.

#include "server/messages.h"
#include "touchstone/touchstone.hpp"

#include <cstdint>
#include <span>
#include <string>

namespace touchstone::server {

inline constexpr int kProtocol = 1;

/// A binary frame: "TSTK", the protocol, the number of ticks, `answers` (0: of the servo; else the `id` of a
/// message `touch`); then of each tick time, hip, proxy, force, command (double), contacts, flags (uint32).
[[nodiscard]] std::string ticksFrame(const ts::Ticks& ticks, size_t first, size_t count, uint32_t answers);

/// What a tick came to, for an event.
[[nodiscard]] Json stateEvent(const ts_state& state);

} // namespace touchstone::server
