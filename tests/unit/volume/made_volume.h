#pragma once
// Volumes in memory, without a file.

#include "assets/volumes.h"
#include "engine/volume/volume.h"

#include <memory>
#include <string>

namespace touchstone::test {

/// Of touchstone_assets, its centre at the origin; the axes are turned or sheared by `turned`.
inline std::shared_ptr<const Volume> madeVolume(const std::string& name, const glm::ivec3& voxels,
                                                const std::string& type,
                                                const glm::dmat3& turned = glm::dmat3(1.0)) {
    const assets::VolumeData made = assets::makeVolume(name, voxels, type);
    const auto bytes = std::make_shared<const std::vector<std::byte>>(assets::valuesOf(made));
    VolumeFacts facts;
    facts.size = made.voxels;
    facts.type = type == "uint8"   ? VolumeType::UInt8
                 : type == "int16" ? VolumeType::Int16
                                   : VolumeType::Float;
    for (int axis = 0; axis < 3; ++axis)
        facts.axes[axis] = 1e-3 * made.spacing[axis] * turned[axis];
    facts.origin = -0.5 * (facts.axes * glm::dvec3(made.voxels - 1));
    facts.format = "memory";
    facts.fileType = type;
    return std::make_shared<const Volume>(
        facts, std::span(reinterpret_cast<const uint8_t*>(bytes->data()), bytes->size()), bytes, name);
}

} // namespace touchstone::test
