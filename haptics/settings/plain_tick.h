#pragma once

namespace touchstone {

/// True in a build with -DTOUCHSTONE_PLAIN_TICK=ON, which has no shading, texture, friction, maps or vertex
/// attributes in its tick: what a tick of a scene that calls for none of them is measured against
/// (tools/plain-tick).
#ifdef TOUCHSTONE_PLAIN_TICK
inline constexpr bool kPlainTick = true;
#else
inline constexpr bool kPlainTick = false;
#endif

} // namespace touchstone
