#pragma once
// The images of our scenes, computed and encoded as PNG.

#include <glm/glm.hpp>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string_view>
#include <vector>

namespace touchstone::assets {

/// Height of a tile at u, v in 0..1 (origin upper left), itself in 0..1; 1 is `scale` metres above 0. It must
/// be periodic with period 1 in both directions.
using HeightFunction = std::function<double(double u, double v)>;

/// Pixels of 8 or 16 bits, rows from the top.
template <class T>
struct Picture {
    int width = 0, height = 0, channels = 0;
    std::vector<T> values;
};

/// A grey 16-bit height map, 0..65535 for 0..1, sampled at texel centres.
[[nodiscard]] Picture<uint16_t> heightMap(const HeightFunction& height, int size);

/// The tangent-space normal map (8 bits, green towards the image's top as in glTF) of a tile `tileWidth` m
/// wide whose full height is `scale` m, by central differences over a texel.
[[nodiscard]] Picture<uint8_t> normalMap(const HeightFunction& height, int size, double tileWidth,
                                         double scale);

/// A factor map (grey, 8 bits): 0..255 for 0..1.
[[nodiscard]] Picture<uint8_t> factorMap(const HeightFunction& factor, int size);

/// A square of one colour with up to two lines of capitals in another, both sRGB 0..255.
[[nodiscard]] Picture<uint8_t> label(std::string_view text, int size, glm::ivec3 ground, glm::ivec3 ink);

/// The file image of a PNG; throws std::runtime_error if OpenImageIO cannot write it.
[[nodiscard]] std::vector<std::byte> png(const Picture<uint8_t>& picture);
[[nodiscard]] std::vector<std::byte> png(const Picture<uint16_t>& picture);

/// Smooth noise in 0..1 with period 1: `cells` random values per side, the same in every run.
[[nodiscard]] double tilingNoise(double u, double v, int cells, uint32_t seed);

} // namespace touchstone::assets
