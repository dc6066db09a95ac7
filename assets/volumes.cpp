#include "assets/volumes.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <numbers>
#include <stdexcept>

namespace touchstone::assets {

namespace {

constexpr double kSide = 200.0; // mm

/// 1 well inside, 0 well outside, linear within `ramp` of the surface.
double filled(double distance, double ramp) {
    return std::clamp(0.5 - 0.5 * distance / ramp, 0.0, 1.0);
}

double ball(const glm::dvec3& place) {
    const double r = glm::length(place);
    return 100.0 * filled(r - kBallRadius, kBallRamp) + 100.0 * filled(r - kCoreRadius, kBallRamp);
}

double gyroid(const glm::dvec3& place) {
    const glm::dvec3 p = 6.0 * std::numbers::pi * place, s = glm::sin(p), c = glm::cos(p);
    return 100.0 + 100.0 / 1.5 * (s.x * c.y + s.y * c.z + s.z * c.x);
}

double ellipsoid(const glm::dvec3& place, const glm::dvec3& centre, const glm::dvec3& radii) {
    const glm::dvec3 q = (place - centre) / radii;
    return (glm::length(q) - 1.0) * std::min({radii.x, radii.y, radii.z});
}

/// (left, posterior, superior).
double head(const glm::dvec3& p) {
    constexpr double kRamp = 0.012;
    const glm::dvec3 skull(0.0, 0.02, 0.06);
    double skin = ellipsoid(p, skull, {0.30, 0.37, 0.36});
    skin = std::min(skin, ellipsoid(p, {0.0, -0.13, -0.14}, {0.20, 0.20, 0.19}));    // jaw
    skin = std::min(skin, ellipsoid(p, {0.0, -0.36, -0.03}, {0.045, 0.075, 0.085})); // nose
    for (const double side : {-1.0, 1.0})
        skin = std::min(skin, ellipsoid(p, {side * 0.30, 0.03, 0.0}, {0.035, 0.07, 0.10}));       // ears
    skin = std::min(skin, std::max(glm::length(glm::dvec2(p.x, p.y - 0.04)) - 0.16, p.z + 0.05)); // neck
    double eyes = 1.0;
    for (const double side : {-1.0, 1.0})
        eyes = std::min(eyes, ellipsoid(p, {side * 0.12, -0.335, 0.05}, {0.055, 0.05, 0.04}));
    skin = std::max(skin, -eyes); // sockets
    const double brain = ellipsoid(p, skull, {0.235, 0.305, 0.295});
    const double bone = std::max(ellipsoid(p, skull, {0.265, 0.335, 0.325}), -brain);
    const double inside = -1000.0 + 1040.0 * filled(skin, kRamp);
    return std::max(inside, -1000.0 + 2000.0 * filled(std::max(bone, skin), kRamp));
}

} // namespace

double volumeValue(const std::string& name, const glm::dvec3& place) {
    if (name == "ball")
        return ball(place);
    if (name == "gyroid")
        return gyroid(place);
    if (name == "head")
        return head(place);
    throw std::invalid_argument("unknown volume \"" + name + "\": ball, gyroid and head are known");
}

VolumeData makeVolume(const std::string& name, const glm::ivec3& voxels, const std::string& type) {
    if (type != "uint8" && type != "int16" && type != "float")
        throw std::invalid_argument("unknown type \"" + type + "\": uint8, int16 and float are known");
    if (glm::any(glm::lessThan(voxels, glm::ivec3(4))) ||
        glm::any(glm::greaterThan(voxels, glm::ivec3(1024))))
        throw std::invalid_argument("between 4 and 1024 voxels on an axis can be made");
    VolumeData volume{.voxels = voxels, .spacing = kSide / glm::dvec3(voxels), .type = type, .values = {}};
    volume.values.reserve(static_cast<size_t>(voxels.x) * static_cast<size_t>(voxels.y) *
                          static_cast<size_t>(voxels.z));
    for (int z = 0; z < voxels.z; ++z)
        for (int y = 0; y < voxels.y; ++y)
            for (int x = 0; x < voxels.x; ++x) {
                double value = volumeValue(name, (glm::dvec3(x, y, z) + 0.5) / glm::dvec3(voxels) - 0.5);
                if (type == "uint8")
                    value = std::clamp(std::round(value), 0.0, 255.0);
                else if (type == "int16")
                    value = std::round(value);
                volume.values.push_back(static_cast<float>(value));
            }
    return volume;
}

std::vector<std::byte> valuesOf(const VolumeData& volume, bool bigEndian) {
    const size_t each = volume.type == "uint8" ? 1 : volume.type == "int16" ? 2 : 4;
    std::vector<std::byte> bytes(each * volume.values.size());
    for (size_t i = 0; i < volume.values.size(); ++i) {
        std::byte* const at = bytes.data() + each * i;
        const uint32_t bits = each == 4 ? std::bit_cast<uint32_t>(volume.values[i])
                                        : static_cast<uint32_t>(static_cast<int32_t>(volume.values[i]));
        for (size_t k = 0; k < each; ++k)
            at[bigEndian ? each - 1 - k : k] = static_cast<std::byte>(bits >> (8 * k) & 0xff);
    }
    return bytes;
}

std::vector<std::byte> nrrdOf(const VolumeData& volume) {
    const auto text = [](const glm::dvec3& v) {
        char line[96];
        std::snprintf(line, sizeof line, "(%.17g,%.17g,%.17g)", v.x, v.y, v.z);
        return std::string(line);
    };
    const glm::dvec3 step = volume.spacing, first = -0.5 * step * glm::dvec3(volume.voxels - 1);
    std::string header =
        "NRRD0004\n# A volume of Touchstone's own\ntype: " + volume.type + "\ndimension: 3\n";
    header += "space: left-posterior-superior\nsizes: " + std::to_string(volume.voxels.x) + " " +
              std::to_string(volume.voxels.y) + " " + std::to_string(volume.voxels.z) + "\n";
    header += "space directions: " + text({step.x, 0, 0}) + " " + text({0, step.y, 0}) + " " +
              text({0, 0, step.z}) + "\nspace units: \"mm\" \"mm\" \"mm\"\nspace origin: " + text(first) +
              "\nendian: little\nencoding: raw\n\n";
    std::vector<std::byte> bytes(header.size());
    std::memcpy(bytes.data(), header.data(), header.size());
    const std::vector<std::byte> values = valuesOf(volume);
    bytes.insert(bytes.end(), values.begin(), values.end());
    return bytes;
}

} // namespace touchstone::assets
