#include "renderer/scene_renderer.h"
#include "renderer/scene_renderer_impl.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

double linearFromSrgb(double c) {
    return c <= 0.04045 ? c / 12.92 : std::pow((c + 0.055) / 1.055, 2.4);
}
double srgbFromLinear(double c) {
    return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
}

/// Means of n x n pixels in linear light.
PixelData averaged(const PixelData& large, int width, int height, int n) {
    std::array<double, 256> linear{};
    for (size_t i = 0; i < linear.size(); ++i)
        linear[i] = linearFromSrgb(static_cast<double>(i) / 255.0);
    PixelData small;
    small.width = width;
    small.height = height;
    small.channels = 4;
    small.bytes.reserve(size_t{4} * static_cast<size_t>(width) * static_cast<size_t>(height));
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width; ++x) {
            std::array<double, 3> sum{};
            for (int j = 0; j < n; ++j)
                for (int i = 0; i < n; ++i) {
                    const size_t at =
                        size_t{4} * (static_cast<size_t>(y * n + j) * static_cast<size_t>(large.width) +
                                     static_cast<size_t>(x * n + i));
                    for (size_t c = 0; c < 3; ++c)
                        sum[c] += linear[std::to_integer<size_t>(large.bytes[at + c])];
                }
            for (const double s : sum)
                small.bytes.push_back(
                    static_cast<std::byte>(std::lround(255.0 * srgbFromLinear(s / (n * n)))));
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
    const int n = std::clamp(std::min(supersampling, largest / std::max({width, height, 1})), 1, 4);
    Overlay scaled = overlay;
    for (Overlay::Line& line : scaled.lines)
        line.width *= static_cast<float>(n);
    View larger = view;
    larger.pixelScale *= static_cast<float>(n);
    renderer.render(larger, scaled, n * width, n * height);
    const PixelData pixels = renderer.readPixels();
    return n == 1 ? pixels : averaged(pixels, width, height, n);
}

} // namespace touchstone
