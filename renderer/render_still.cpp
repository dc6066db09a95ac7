#include "engine/core/error.h"
#include "renderer/scene_renderer.h"
#include "renderer/scene_renderer_impl.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <string>
#include <vector>

namespace touchstone {

namespace {

/// Pixels of the image that is drawn: with its depth and two copies of it 1.1 GB.
constexpr double kMostPixels = 67'108'864.0;

double linearFromSrgb(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double srgbFromLinear(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

/// 16 bit linear light to the nearest byte of sRGB: no `pow` for each of eight million pixels.
const std::vector<std::byte>& byteOfLinear() {
    static const std::vector<std::byte> table = [] {
        std::vector<std::byte> bytes(size_t{1} << 16);
        for (size_t i = 0; i < bytes.size(); ++i)
            bytes[i] = static_cast<std::byte>(std::lround(
                255.0 * srgbFromLinear(static_cast<double>(i) / static_cast<double>(bytes.size() - 1))));
        return bytes;
    }();
    return table;
}

/// Means of n x n pixels in linear light.
PixelData averaged(const PixelData& large, int width, int height, int n) {
    std::array<float, 256> linear{};
    for (size_t i = 0; i < linear.size(); ++i)
        linear[i] = static_cast<float>(linearFromSrgb(static_cast<double>(i) / 255.0));
    const std::vector<std::byte>& encoded = byteOfLinear();
    const float toIndex = static_cast<float>(encoded.size() - 1) / static_cast<float>(n * n);
    PixelData small;
    small.width = width;
    small.height = height;
    small.channels = 4;
    small.bytes.reserve(size_t{4} * static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::array<float, 3> sum{};
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const size_t at =
                        size_t{4} * (static_cast<size_t>(y * n + j) * static_cast<size_t>(large.width) +
                                     static_cast<size_t>(x * n + i));
                    for (size_t c = 0; c < 3; ++c)
                        sum[c] += linear[std::to_integer<size_t>(large.bytes[at + c])];
                }
            for (const float s : sum)
                small.bytes.push_back(encoded[static_cast<size_t>(std::min(toIndex * s + 0.5f, 65535.0f))]);
            small.bytes.push_back(std::byte{255});
        }
    return small;
}

} // namespace

PixelData renderStill(SceneRenderer& renderer, const View& view, const Overlay& overlay, int width,
                      int height, int supersampling) {
    const vk::PhysicalDeviceLimits& limits = renderer.impl().gpu.limits;
    const auto largest = static_cast<int>(std::min(
        {limits.maxImageDimension2D, limits.maxFramebufferWidth, limits.maxFramebufferHeight, 16384u}));
    if (std::max(width, height) > largest)
        throw Error("Vulkan", "",
                    "the device draws no picture wider or higher than " + std::to_string(largest) + " pixels",
                    "ask for a smaller one");
    const double fitting = std::sqrt(kMostPixels / std::max(1.0, static_cast<double>(width) * height));
    const int n = std::clamp(
        std::min({supersampling, largest / std::max({width, height, 1}), static_cast<int>(fitting)}), 1, 4);
    Overlay scaled = overlay;
    for (Overlay::Line& line : scaled.lines)
        line.width *= static_cast<float>(n);
    View larger = view;
    larger.pixelScale *= static_cast<float>(n);
    renderer.render(larger, scaled, n * width, n * height);
    const PixelData pixels = renderer.readPixels();
    renderer.impl().forgetTime();
    return n == 1 ? pixels : averaged(pixels, width, height, n);
}

} // namespace touchstone
