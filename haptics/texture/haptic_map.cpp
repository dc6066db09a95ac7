#include "haptics/texture/haptic_map.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

int wrapIndex(int i, int size, Wrap wrap) {
    switch (wrap) {
    case Wrap::ClampToEdge:
        return std::clamp(i, 0, size - 1);
    case Wrap::MirroredRepeat: {
        const int period = 2 * size;
        const int m = ((i % period) + period) % period;
        return m < size ? m : period - 1 - m;
    }
    case Wrap::Repeat:
        break;
    }
    return ((i % size) + size) % size;
}

/// Far coordinates carry no fraction and would overflow an int; a texture there is meaningless but must not
/// harm.
double bounded(double x) {
    return std::isfinite(x) ? std::clamp(x, -1e9, 1e9) : 0.0;
}

} // namespace

HapticMap::HapticMap(const PixelData& pixels, const TextureRef& reference, int channels)
    : channels_(channels), texCoord_(reference.texCoord), wrapS_(reference.wrapS), wrapT_(reference.wrapT),
      offset_(reference.offset) {
    // The transform is affine: its columns are what it does to the unit vectors.
    const glm::dvec2 origin(reference.transform({0.0f, 0.0f}));
    jacobian_ = glm::dmat2(glm::dvec2(reference.transform({1.0f, 0.0f})) - origin,
                           glm::dvec2(reference.transform({0.0f, 1.0f})) - origin);

    Level level;
    level.width = pixels.width;
    level.height = pixels.height;
    level.texels.resize(static_cast<size_t>(level.width) * static_cast<size_t>(level.height) *
                        static_cast<size_t>(channels));
    size_t out = 0;
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            for (int k = 0; k < channels; ++k)
                level.texels[out++] = pixels.value(x, y, std::min(k, pixels.channels - 1));
    least_ = INFINITY;
    greatest_ = -INFINITY;
    for (size_t i = 0; i < level.texels.size(); i += static_cast<size_t>(channels)) {
        if (!std::isfinite(level.texels[i]))
            level.texels[i] = 0.0f;
        least_ = std::min(least_, level.texels[i]);
        greatest_ = std::max(greatest_, level.texels[i]);
    }
    levels_.push_back(std::move(level));
    // Box-filtered mips. An odd last row or column is folded into its neighbour.
    while (levels_.back().width > 1 || levels_.back().height > 1) {
        const Level& fine = levels_.back();
        Level coarse;
        coarse.width = std::max(1, fine.width / 2);
        coarse.height = std::max(1, fine.height / 2);
        coarse.texels.resize(static_cast<size_t>(coarse.width * coarse.height * channels));
        for (int y = 0; y < coarse.height; ++y)
            for (int x = 0; x < coarse.width; ++x)
                for (int k = 0; k < channels; ++k) {
                    const auto at = [&](int fx, int fy) {
                        fx = std::min(fx, fine.width - 1);
                        fy = std::min(fy, fine.height - 1);
                        return fine.texels[static_cast<size_t>((fy * fine.width + fx) * channels + k)];
                    };
                    coarse.texels[static_cast<size_t>((y * coarse.width + x) * channels + k)] =
                        0.25f * (at(2 * x, 2 * y) + at(2 * x + 1, 2 * y) + at(2 * x, 2 * y + 1) +
                                 at(2 * x + 1, 2 * y + 1));
                }
        levels_.push_back(std::move(coarse));
    }
}

uint64_t HapticMap::memoryBytes() const {
    uint64_t bytes = 0;
    for (const Level& level : levels_)
        bytes += level.texels.size() * sizeof(float);
    return bytes;
}

glm::dvec2 HapticMap::transform(const glm::dvec2& uv) const {
    return offset_ + jacobian_ * uv;
}

glm::dvec3 HapticMap::bilinear(const Level& level, const glm::dvec2& uv) const {
    // Texel centres lie at half-integers (glTF and every GPU agree).
    const double x = bounded(uv.x * level.width - 0.5), y = bounded(uv.y * level.height - 0.5);
    const double fx = std::floor(x), fy = std::floor(y);
    const double wx = x - fx, wy = y - fy;
    const int x0 = wrapIndex(static_cast<int>(fx), level.width, wrapS_);
    const int x1 = wrapIndex(static_cast<int>(fx) + 1, level.width, wrapS_);
    const int y0 = wrapIndex(static_cast<int>(fy), level.height, wrapT_);
    const int y1 = wrapIndex(static_cast<int>(fy) + 1, level.height, wrapT_);
    const auto texel = [&](int tx, int ty) {
        const float* t = &level.texels[static_cast<size_t>((ty * level.width + tx) * channels_)];
        return channels_ >= 3 ? glm::dvec3(t[0], t[1], t[2]) : glm::dvec3(t[0], 0.0, 0.0);
    };
    return (1.0 - wy) * ((1.0 - wx) * texel(x0, y0) + wx * texel(x1, y0)) +
           wy * ((1.0 - wx) * texel(x0, y1) + wx * texel(x1, y1));
}

glm::dvec3 HapticMap::sample(const glm::dvec2& uv, double level) const {
    const double last = static_cast<double>(levels_.size() - 1);
    const double bound = std::clamp(level, 0.0, last);
    const auto fine = static_cast<size_t>(bound);
    const double between = bound - static_cast<double>(fine);
    const glm::dvec3 a = bilinear(levels_[fine], uv);
    if (between <= 0.0)
        return a;
    return (1.0 - between) * a + between * bilinear(levels_[fine + 1], uv);
}

double HapticMap::scalar(const glm::dvec2& uv, double level) const {
    return sample(uv, level).x;
}

glm::dvec3 HapticMap::vector(const glm::dvec2& uv, double level) const {
    return sample(uv, level);
}

glm::dvec2 HapticMap::gradient(const glm::dvec2& uv, double level) const {
    const double bound = std::clamp(level, 0.0, static_cast<double>(levels_.size() - 1));
    const Level& at = levels_[static_cast<size_t>(bound)];
    const double du = 0.5 / at.width, dv = 0.5 / at.height;
    return {(scalar(uv + glm::dvec2(du, 0), level) - scalar(uv - glm::dvec2(du, 0), level)) / (2.0 * du),
            (scalar(uv + glm::dvec2(0, dv), level) - scalar(uv - glm::dvec2(0, dv), level)) / (2.0 * dv)};
}

} // namespace touchstone
