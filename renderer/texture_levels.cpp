#include "renderer/texture_levels.h"

#include <glm/gtc/packing.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

namespace touchstone {

namespace {

float linearFromSrgb(float c) {
    return c <= 0.04045f ? c / 12.92f : std::pow((c + 0.055f) / 1.055f, 2.4f);
}
float srgbFromLinear(float c) {
    return c <= 0.0031308f ? 12.92f * c : 1.055f * std::pow(c, 1.0f / 2.4f) - 0.055f;
}

/// 0..1 to 0..255, rounded; NaN becomes 0.
uint8_t toByte(float v) {
    return static_cast<uint8_t>(std::clamp(v > 0.0f ? v : 0.0f, 0.0f, 1.0f) * 255.0f + 0.5f);
}

/// sRGB bytes to linear 0..1 and back. 16384 steps: where sRGB is steepest one step is a fifth of a byte.
struct SrgbTables {
    std::array<float, 256> linear;
    std::array<uint8_t, 16385> encoded;
    SrgbTables() {
        for (size_t i = 0; i < linear.size(); ++i)
            linear[i] = linearFromSrgb(static_cast<float>(i) / 255.0f);
        for (size_t i = 0; i < encoded.size(); ++i)
            encoded[i] = toByte(srgbFromLinear(static_cast<float>(i) / 16384.0f));
    }
    [[nodiscard]] uint8_t encode(float v) const { return encoded[static_cast<size_t>(v * 16384.0f + 0.5f)]; }
};

const SrgbTables& srgbTables() {
    static const SrgbTables tables;
    return tables;
}

/// Channel of a file with `channels` channels for RGBA channel c, or -1 for opaque.
int sourceChannel(int channels, int c) {
    if (channels <= 2)
        return c < 3 ? 0 : (channels == 2 ? 1 : -1);
    return c < channels ? c : -1;
}

void fillFirstLevel(const PixelData& pixels, TextureLevels& result) {
    const size_t count = static_cast<size_t>(pixels.width) * static_cast<size_t>(pixels.height);
    result.bytes.resize(count * bytesPerTexel(result.format));
    if (pixels.type == ComponentType::U8 && pixels.channels == 4) {
        std::memcpy(result.bytes.data(), pixels.bytes.data(), result.bytes.size());
        return;
    }
    if (pixels.type == ComponentType::U8) {
        std::array<int, 4> from{};
        for (int c = 0; c < 4; ++c)
            from[static_cast<size_t>(c)] = sourceChannel(pixels.channels, c);
        const auto stride = static_cast<size_t>(pixels.channels);
        for (size_t i = 0; i < count; ++i)
            for (size_t c = 0; c < 4; ++c)
                result.bytes[4 * i + c] =
                    from[c] < 0 ? std::byte{255} : pixels.bytes[i * stride + static_cast<size_t>(from[c])];
        return;
    }
    size_t place = 0;
    for (int y = 0; y < pixels.height; ++y)
        for (int x = 0; x < pixels.width; ++x)
            for (int c = 0; c < 4; ++c) {
                const int from = sourceChannel(pixels.channels, c);
                const float v = from < 0 ? 1.0f : pixels.value(x, y, from);
                if (result.format == TexelFormat::Half16) {
                    const uint16_t half = glm::packHalf1x16(std::clamp(v, -65504.0f, 65504.0f));
                    std::memcpy(&result.bytes[place], &half, 2);
                    place += 2;
                } else {
                    result.bytes[place++] = static_cast<std::byte>(toByte(v));
                }
            }
}

/// Mean of the four texels of the level above, by plain bytes, halves or linear light.
struct ByteMean {
    static constexpr size_t kTexel = 4;
    void operator()(const std::array<const std::byte*, 4>& from, std::byte* to) const {
        for (size_t c = 0; c < 4; ++c) {
            unsigned sum = 2;
            for (const std::byte* texel : from)
                sum += std::to_integer<unsigned>(texel[c]);
            to[c] = static_cast<std::byte>(sum / 4);
        }
    }
};

struct HalfMean {
    static constexpr size_t kTexel = 8;
    void operator()(const std::array<const std::byte*, 4>& from, std::byte* to) const {
        for (size_t c = 0; c < 4; ++c) {
            float sum = 0.0f;
            for (const std::byte* texel : from) {
                uint16_t half = 0;
                std::memcpy(&half, texel + 2 * c, 2);
                sum += glm::unpackHalf1x16(half);
            }
            const uint16_t mean = glm::packHalf1x16(0.25f * sum);
            std::memcpy(to + 2 * c, &mean, 2);
        }
    }
};

/// Colours are weighted by alpha, so that transparent texels do not bleed into opaque edges.
struct SrgbMean {
    static constexpr size_t kTexel = 4;
    const SrgbTables& tables = srgbTables();
    void operator()(const std::array<const std::byte*, 4>& from, std::byte* to) const {
        unsigned alpha = 0;
        for (const std::byte* texel : from)
            alpha += std::to_integer<unsigned>(texel[3]);
        for (size_t c = 0; c < 3; ++c) {
            float sum = 0.0f;
            for (const std::byte* texel : from) {
                const float weight = alpha == 0 ? 0.25f
                                                : static_cast<float>(std::to_integer<unsigned>(texel[3])) /
                                                      static_cast<float>(alpha);
                sum += weight * tables.linear[std::to_integer<size_t>(texel[c])];
            }
            to[c] = static_cast<std::byte>(tables.encode(std::min(sum, 1.0f)));
        }
        to[3] = static_cast<std::byte>((alpha + 2) / 4);
    }
};

template <class Mean>
std::vector<std::byte> halved(const std::byte* source, int width, int height, const Mean& mean) {
    const int halfWidth = std::max(1, width / 2), halfHeight = std::max(1, height / 2);
    std::vector<std::byte> result(static_cast<size_t>(halfWidth) * static_cast<size_t>(halfHeight) *
                                  Mean::kTexel);
    std::byte* to = result.data();
    const auto texel = [&](int x, int y) {
        return source +
               (static_cast<size_t>(y) * static_cast<size_t>(width) + static_cast<size_t>(x)) * Mean::kTexel;
    };
    for (int y = 0; y < halfHeight; ++y) {
        const int y0 = std::min(2 * y, height - 1), y1 = std::min(2 * y + 1, height - 1);
        for (int x = 0; x < halfWidth; ++x, to += Mean::kTexel) {
            const int x0 = std::min(2 * x, width - 1), x1 = std::min(2 * x + 1, width - 1);
            mean({texel(x0, y0), texel(x1, y0), texel(x0, y1), texel(x1, y1)}, to);
        }
    }
    return result;
}

std::vector<std::byte> halved(const TextureLevels& texture, const std::byte* source, int width, int height) {
    switch (texture.format) {
    case TexelFormat::Srgb8:
        return halved(source, width, height, SrgbMean{});
    case TexelFormat::Half16:
        return halved(source, width, height, HalfMean{});
    case TexelFormat::Unorm8:
        break;
    }
    return halved(source, width, height, ByteMean{});
}

} // namespace

TextureLevels buildTextureLevels(const PixelData& pixels, TextureRole role, int largestSide) {
    TextureLevels result;
    if (role == TextureRole::Color)
        result.format = TexelFormat::Srgb8;
    else
        result.format = pixels.type == ComponentType::U8 ? TexelFormat::Unorm8 : TexelFormat::Half16;
    fillFirstLevel(pixels, result);
    int width = pixels.width, height = pixels.height;
    while (std::max(width, height) > largestSide) {
        result.bytes = halved(result, result.bytes.data(), width, height);
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
    }
    result.levels.push_back({width, height, 0});
    while (width > 1 || height > 1) {
        const std::vector<std::byte> next =
            halved(result, result.bytes.data() + result.levels.back().offset, width, height);
        width = std::max(1, width / 2);
        height = std::max(1, height / 2);
        result.levels.push_back({width, height, result.bytes.size()});
        result.bytes.insert(result.bytes.end(), next.begin(), next.end());
    }
    return result;
}

} // namespace touchstone
