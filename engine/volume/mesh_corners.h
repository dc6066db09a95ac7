#pragma once
// OpenVDB's faces as triangles.

#include <openvdb/openvdb.h>

#include <cstdint>
#include <vector>

namespace touchstone {

/// Three indices a triangle; a quad is cut along its first diagonal.
[[nodiscard]] inline std::vector<uint32_t> triangleCorners(const std::vector<openvdb::Vec4I>& quads,
                                                           const std::vector<openvdb::Vec3I>& triangles) {
    std::vector<uint32_t> corners;
    corners.reserve(6 * quads.size() + 3 * triangles.size());
    for (const openvdb::Vec4I& quad : quads)
        corners.insert(corners.end(), {quad[0], quad[1], quad[2], quad[0], quad[2], quad[3]});
    for (const openvdb::Vec3I& triangle : triangles)
        corners.insert(corners.end(), {triangle[0], triangle[1], triangle[2]});
    return corners;
}

} // namespace touchstone
