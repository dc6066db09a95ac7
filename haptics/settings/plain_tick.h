#pragma once

namespace touchstone {

/// True in a build with -DTOUCHSTONE_PLAIN_TICK=ON, whose tick has no shading, texture, friction, maps or
/// vertex attributes: the reference cost for scenes that use none of them (tools/plain-tick).
#ifdef TOUCHSTONE_PLAIN_TICK
inline constexpr bool kPlainTick = true;
#else
inline constexpr bool kPlainTick = false;
#endif

} // namespace touchstone
