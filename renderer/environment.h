#pragma once
// A panorama as the light instead of the closed-form surroundings: irradiance and prefiltered reflections,
// computed once by a worker. Pure; any thread.

#include <glm/glm.hpp>

#include <array>
#include <atomic>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <vector>

namespace touchstone {

/// Linear RGB radiance over all directions, twice as wide as high: the centre looks along -z, the top along
/// +y, and the right of the centre along +x. Rows from the top.
struct Panorama {
    int width = 0, height = 0;
    std::vector<glm::vec3> texels;
};

/// Input of the shaders. Scaled so that the mean radiance over the sphere is kMeanRadiance, whatever the
/// file's exposure.
struct Environment {
    static constexpr double kMeanRadiance =
        0.6;                          ///< luminance; that of the closed-form surroundings with their lamps
    static constexpr int kSide = 256; ///< texels per side of the sharpest level
    static constexpr int kLevels = 6; ///< level i holds GGX of roughness i / (kLevels - 1)

    /// For each level six faces +x, -x, +y, -y, +z, -z of (kSide >> level)² texels, RGBA as half floats.
    std::array<std::vector<uint16_t>, kLevels> levels;
    /// Irradiance / pi, as from irradiancePolynomial.
    std::array<glm::dvec3, 9> irradiance{};
};

/// Unit direction of a texel's centre; `s` and `t` 0..1 across a cube face (Vulkan's faces and orientation).
[[nodiscard]] glm::dvec3 cubeDirection(int face, double s, double t);

/// About half a second. `panorama` is at least 4 x 2, its values finite and non-negative. Null for a black
/// panorama or when `cancel` (may be null) was set.
[[nodiscard]] std::shared_ptr<const Environment> prefilter(const Panorama& panorama,
                                                           const std::atomic<bool>* cancel = nullptr);

/// Reads an OpenEXR or Radiance file of up to 16384 x 8192 texels, reduced to at most 1024 x 512 during
/// reading: some MB of memory. Non-finite and negative values become 0. Throws Error with the place and a
/// remedy.
[[nodiscard]] Panorama readPanorama(const std::filesystem::path& file);

/// readPanorama and prefilter. Throws Error also for a black panorama. Null when cancelled.
[[nodiscard]] std::shared_ptr<const Environment> loadEnvironment(const std::filesystem::path& file,
                                                                 const std::atomic<bool>* cancel = nullptr);

} // namespace touchstone
