#pragma once
// Volumes in closed form, at any size: a ball with a core, a gyroid, a head-like phantom. Tests and figures
// need no foreign scans.

#include <glm/glm.hpp>

#include <cstddef>
#include <filesystem>
#include <string>
#include <vector>

namespace touchstone::assets {

/// Values at a place in a cube from -1/2 to 1/2 (left, posterior, superior).
///
/// ball: 100 inside of the radius kBallRadius and 200 inside of kCoreRadius; the surfaces of 50 and 150 are
/// these spheres, and about them the value is linear in the distance within kBallRamp. gyroid: 100 + 100 g, g
/// = (sin x cos y + sin y cos z + sin z cos x) / 1.5 with three periods: the surface of 100. head: skin,
/// skull, brain, eyes, nose and neck as ellipsoids, in Hounsfield units: air -1000, tissue 40, bone 1000. The
/// neck goes through the lower border.
///
/// Throws std::invalid_argument for another name.
[[nodiscard]] double volumeValue(const std::string& name, const glm::dvec3& place);
inline constexpr double kBallRadius = 0.4, kCoreRadius = 0.2, kBallRamp = 0.08;

/// A volume as a file describes it.
struct VolumeData {
    glm::ivec3 voxels{0};
    glm::dvec3 spacing{1.0};   ///< mm
    std::string type;          ///< "uint8", "int16" or "float"
    std::vector<float> values; ///< the first axis fastest; whole numbers for the integers
};

/// A cube of 200 mm with `voxels` on each axis, which the spacings follow. uint8 values are clamped to
/// 0..255. Throws std::invalid_argument for another name or type, and less than 4 or more than 1024 voxels on
/// an axis.
[[nodiscard]] VolumeData makeVolume(const std::string& name, const glm::ivec3& voxels,
                                    const std::string& type);

/// NRRD, raw, little-endian, in left-posterior-superior coordinates with its centre at their origin.
[[nodiscard]] std::vector<std::byte> nrrdOf(const VolumeData& volume);
/// The values as a file's bytes, in its type.
[[nodiscard]] std::vector<std::byte> valuesOf(const VolumeData& volume, bool bigEndian = false);
/// OpenVDB, floats; world coordinates are metres. Throws std::runtime_error.
void writeVdb(const std::filesystem::path& path, const VolumeData& volume);

} // namespace touchstone::assets
