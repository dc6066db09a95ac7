#include "assets/picture.h"

#include "assets/lettering.h"

#include <OpenImageIO/filesystem.h>
#include <OpenImageIO/imageio.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace touchstone::assets {

namespace {

template <class T>
T quantised(double value) {
    constexpr double kWhite = std::numeric_limits<T>::max();
    return static_cast<T>(std::lround(std::clamp(value, 0.0, 1.0) * kWhite));
}

template <class T>
Picture<T> sampled(const HeightFunction& function, int size) {
    Picture<T> picture{size, size, 1, {}};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x)
            picture.values.push_back(quantised<T>(function((x + 0.5) / size, (y + 0.5) / size)));
    return picture;
}

template <class T>
std::vector<std::byte> encode(const Picture<T>& picture, OIIO::TypeDesc type) {
    std::vector<unsigned char> bytes;
    OIIO::Filesystem::IOVecOutput memory(bytes);
    OIIO::ImageSpec spec(picture.width, picture.height, picture.channels, type);
    spec.attribute("png:compressionLevel", 9);
    auto output = OIIO::ImageOutput::create("map.png", &memory);
    if (!output || !output->open("map.png", spec) || !output->write_image(type, picture.values.data()) ||
        !output->close())
        throw std::runtime_error("a PNG could not be encoded: " +
                                 (output ? output->geterror() : OIIO::geterror()));
    const auto* first = reinterpret_cast<const std::byte*>(bytes.data());
    return {first, first + bytes.size()};
}

/// Avalanche mixing of an integer (the finaliser of a multiplicative hash): neighbouring inputs, unrelated
/// outputs.
uint32_t scrambled(uint32_t x) {
    x ^= x >> 16;
    x *= 0x7feb352dU;
    x ^= x >> 15;
    x *= 0x846ca68bU;
    return x ^ (x >> 16);
}

double cellValue(int x, int y, int cells, uint32_t seed) {
    const auto wrapped = [cells](int i) { return static_cast<uint32_t>(((i % cells) + cells) % cells); };
    const uint32_t bits = scrambled(wrapped(x) + scrambled(wrapped(y) + scrambled(seed)));
    return bits / 4294967295.0;
}

} // namespace

Picture<uint16_t> heightMap(const HeightFunction& height, int size) {
    return sampled<uint16_t>(height, size);
}

Picture<uint8_t> factorMap(const HeightFunction& factor, int size) {
    return sampled<uint8_t>(factor, size);
}

Picture<uint8_t> normalMap(const HeightFunction& height, int size, double tileWidth, double scale) {
    Picture<uint8_t> picture{size, size, 3, {}};
    const double half = 0.5 / size;
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const double u = (x + 0.5) / size, v = (y + 0.5) / size;
            const double slopePerHeight = scale / (2.0 * half * tileWidth);
            const double alongU = slopePerHeight * (height(u + half, v) - height(u - half, v));
            const double alongV = slopePerHeight * (height(u, v + half) - height(u, v - half));
            // v grows downwards, green points up: the slope towards the top is -alongV.
            const glm::dvec3 normal = glm::normalize(glm::dvec3(-alongU, alongV, 1.0));
            for (int c = 0; c < 3; ++c)
                picture.values.push_back(quantised<uint8_t>(0.5 + 0.5 * normal[c]));
        }
    return picture;
}

Picture<uint8_t> label(std::string_view text, int size, glm::ivec3 ground, glm::ivec3 ink) {
    Picture<uint8_t> picture{size, size, 3, {}};
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            const glm::ivec3 colour = inked(text, (x + 0.5) / size, (y + 0.5) / size) ? ink : ground;
            for (int c = 0; c < 3; ++c)
                picture.values.push_back(static_cast<uint8_t>(colour[c]));
        }
    return picture;
}

double tilingNoise(double u, double v, int cells, uint32_t seed) {
    const double x = u * cells, y = v * cells;
    const int column = static_cast<int>(std::floor(x)), row = static_cast<int>(std::floor(y));
    const auto eased = [](double t) { return t * t * t * (t * (6.0 * t - 15.0) + 10.0); };
    const double a = eased(x - column), b = eased(y - row);
    const auto value = [&](int i, int j) { return cellValue(column + i, row + j, cells, seed); };
    return std::lerp(std::lerp(value(0, 0), value(1, 0), a), std::lerp(value(0, 1), value(1, 1), a), b);
}

std::vector<std::byte> png(const Picture<uint8_t>& picture) {
    return encode(picture, OIIO::TypeDesc::UINT8);
}
std::vector<std::byte> png(const Picture<uint16_t>& picture) {
    return encode(picture, OIIO::TypeDesc::UINT16);
}

} // namespace touchstone::assets
