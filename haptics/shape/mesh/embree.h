#pragma once
// Embree 3 or 4, as CMake has found it.

#include "haptics/shape/mesh/embree_version.h"

#if TOUCHSTONE_EMBREE >= 4
#include <embree4/rtcore.h>
#else
#include <embree3/rtcore.h>
#endif

namespace touchstone {

/// rtcIntersect1 without filters.
inline void intersectRay(RTCScene scene, RTCRayHit& hit) noexcept {
#if TOUCHSTONE_EMBREE >= 4
    rtcIntersect1(scene, &hit);
#else
    RTCIntersectContext context;
    rtcInitIntersectContext(&context);
    rtcIntersect1(scene, &context, &hit);
#endif
}

} // namespace touchstone
