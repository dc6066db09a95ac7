#pragma once
// Volumes in memory, without a file.

#include "assets/volumes.h"
#include "engine/volume/volume.h"

#include <memory>
#include <random>
#include <string>
#include <vector>

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

/// Of these floats, the first axis fastest, 1 mm apart; its first voxel is at the origin.
inline std::shared_ptr<const Volume> volumeOf(const glm::ivec3& size, const std::vector<float>& values) {
    const auto kept = std::make_shared<const std::vector<float>>(values);
    VolumeFacts facts;
    facts.size = size;
    facts.type = VolumeType::Float;
    facts.axes = glm::dmat3(1e-3);
    facts.format = "memory";
    facts.fileType = "float";
    return std::make_shared<const Volume>(
        facts, std::span(reinterpret_cast<const uint8_t*>(kept->data()), kept->size() * sizeof(float)), kept,
        "made");
}

/// Whole numbers in 0..255 that know nothing of each other.
inline std::shared_ptr<const Volume> noise(const glm::ivec3& size) {
    std::mt19937 random(3);
    std::vector<float> values(static_cast<size_t>(size.x) * static_cast<size_t>(size.y) *
                              static_cast<size_t>(size.z));
    for (float& value : values)
        value = static_cast<float>(random() % 256);
    return volumeOf(size, values);
}

} // namespace touchstone::test
