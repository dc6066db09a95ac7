#include "haptics/texture/haptic_map.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace touchstone {

namespace {

int wrapIndex(int i, int size, Wrap wrap) {
    if (i >= 0 && i < size)
        return i; // in most ticks, and a division is a quarter of a texel's cost
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

/// Float maps may hold anything; beyond this sums of texels would overflow.
constexpr float kLargestTexel = 1e12f;

/// The texels that a coarser one covers, and how much of each.
struct Cover {
    int first = 0, count = 0;
    float share[4] = {};
};

/// Coarse texel i of `coarse` over `fine` ones, which is two, or three where an odd size is halved.
Cover coverOf(int i, int fine, int coarse) {
    const double width = static_cast<double>(fine) / coarse, from = i * width, to = from + width;
    Cover cover;
    cover.first = static_cast<int>(from);
    for (int k = cover.first; k < fine && k < to - 1e-9 && cover.count < 4; ++k)
        cover.share[cover.count++] =
            static_cast<float>((std::min<double>(k + 1, to) - std::max<double>(k, from)) / width);
    return cover;
}

} // namespace

HapticMap::HapticMap(const PixelData& pixels, const TextureRef& reference, int channels)
    : channels_(channels), texCoord_(reference.texCoord), wrapS_(reference.wrapS), wrapT_(reference.wrapT),
      offset_(reference.offset) {
    // KHR_texture_transform: scale, then rotate counter-clockwise as seen in the image (v points down).
    const auto angle = static_cast<double>(reference.rotation);
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dvec2 scale(reference.scale);
    jacobian_ = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);

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
    for (float& texel : level.texels)
        texel = std::isfinite(texel) ? std::clamp(texel, -kLargestTexel, kLargestTexel) : 0.0f;
    least_ = INFINITY;
    greatest_ = -INFINITY;
    for (size_t i = 0; i < level.texels.size(); i += static_cast<size_t>(channels)) {
        least_ = std::min(least_, level.texels[i]);
        greatest_ = std::max(greatest_, level.texels[i]);
    }
    levels_.push_back(std::move(level));
    while (levels_.back().width > 1 || levels_.back().height > 1)
        levels_.push_back(halved(levels_.back()));
}

/// Box filter over the very area that a coarse texel covers, so that odd sizes neither shift nor lose an
/// edge.
HapticMap::Level HapticMap::halved(const Level& fine) const {
    Level coarse;
    coarse.width = std::max(1, fine.width / 2);
    coarse.height = std::max(1, fine.height / 2);
    const auto channels = static_cast<size_t>(channels_);
    coarse.texels.assign(static_cast<size_t>(coarse.width) * static_cast<size_t>(coarse.height) * channels,
                         0.0f);
    float* out = coarse.texels.data();
    for (int y = 0; y < coarse.height; ++y) {
        const Cover rows = coverOf(y, fine.height, coarse.height);
        for (int x = 0; x < coarse.width; ++x, out += channels) {
            const Cover columns = coverOf(x, fine.width, coarse.width);
            for (int j = 0; j < rows.count; ++j)
                for (int i = 0; i < columns.count; ++i) {
                    const size_t at = static_cast<size_t>(rows.first + j) * static_cast<size_t>(fine.width) +
                                      static_cast<size_t>(columns.first + i);
                    for (size_t k = 0; k < channels; ++k)
                        out[k] += rows.share[j] * columns.share[i] * fine.texels[at * channels + k];
                }
        }
    }
    return coarse;
}

uint64_t HapticMap::memoryBytes() const {
    uint64_t bytes = 0;
    for (const Level& level : levels_)
        bytes += level.texels.size() * sizeof(float);
    return bytes;
}

void HapticMap::addTo(Hash64& hash) const {
    hash.add(channels_);
    hash.add(texCoord_);
    hash.add(wrapS_);
    hash.add(wrapT_);
    for (const double number :
         {offset_.x, offset_.y, jacobian_[0][0], jacobian_[0][1], jacobian_[1][0], jacobian_[1][1]})
        hash.add(number);
    if (empty())
        return;
    hash.add(levels_[0].width);
    hash.addBytes(levels_[0].texels); // the coarser ones follow from them
}

glm::dvec2 HapticMap::transform(const glm::dvec2& uv) const {
    return offset_ + jacobian_ * uv;
}

template <class Value>
Value HapticMap::texel(const Level& level, int x, int y) const {
    const float* t = &level.texels[static_cast<size_t>((y * level.width + x) * channels_)];
    if constexpr (std::is_same_v<Value, double>)
        return static_cast<double>(*t);
    else
        return channels_ >= 3 ? glm::dvec3(t[0], t[1], t[2]) : glm::dvec3(t[0], 0.0, 0.0);
}

template <class Value>
Value HapticMap::bilinear(const Level& level, const glm::dvec2& uv) const {
    // Texel centres lie at half-integers (glTF and every GPU agree).
    const double x = bounded(uv.x * level.width - 0.5), y = bounded(uv.y * level.height - 0.5);
    const double fx = std::floor(x), fy = std::floor(y);
    const double wx = x - fx, wy = y - fy;
    const int x0 = wrapIndex(static_cast<int>(fx), level.width, wrapS_);
    const int x1 = wrapIndex(static_cast<int>(fx) + 1, level.width, wrapS_);
    const int y0 = wrapIndex(static_cast<int>(fy), level.height, wrapT_);
    const int y1 = wrapIndex(static_cast<int>(fy) + 1, level.height, wrapT_);
    return (1.0 - wy) * ((1.0 - wx) * texel<Value>(level, x0, y0) + wx * texel<Value>(level, x1, y0)) +
           wy * ((1.0 - wx) * texel<Value>(level, x0, y1) + wx * texel<Value>(level, x1, y1));
}

/// Linear between the levels on both sides of `level`: `read(level)` gives what one says.
template <class Read>
auto HapticMap::between(double level, const Read& read) const {
    const double bound = std::clamp(level, 0.0, static_cast<double>(levels_.size() - 1));
    const auto fine = static_cast<size_t>(bound);
    const double share = bound - static_cast<double>(fine);
    auto value = read(levels_[fine]);
    if (share > 0.0)
        value = (1.0 - share) * value + share * read(levels_[fine + 1]);
    return value;
}

double HapticMap::scalar(const glm::dvec2& uv, double level) const {
    return between(level, [&](const Level& at) { return bilinear<double>(at, uv); });
}

glm::dvec3 HapticMap::vector(const glm::dvec2& uv, double level) const {
    return between(level, [&](const Level& at) { return bilinear<glm::dvec3>(at, uv); });
}

/// (value, d/du, d/dv). Half a texel to the left of the place and half a texel to the right lie in two cells
/// side by side, and the place itself in one of them: three columns say it all, and three rows. With w the
/// share of the way from the first column to the second at the left end, the weights of the columns are
///   (1/2 - w)+, 1 - |w - 1/2|, (w - 1/2)+
/// for the value; the slope is 1 - w of the first step and w of the second, exactly zero where texels are
/// equal.
glm::dvec3 HapticMap::valueAndSlope(const Level& level, const glm::dvec2& uv) const {
    const double x = bounded(uv.x * level.width - 1.0), y = bounded(uv.y * level.height - 1.0);
    const double fx = std::floor(x), fy = std::floor(y);
    const double wx = x - fx, wy = y - fy;
    const auto weights = [](double w) {
        return glm::dvec3(std::max(0.5 - w, 0.0), 1.0 - std::abs(w - 0.5), std::max(w - 0.5, 0.0));
    };
    const auto step = [](double w, const glm::dvec3& at) {
        return (1.0 - w) * (at.y - at.x) + w * (at.z - at.y);
    };
    std::array<int, 3> column;
    for (int i = 0; i < 3; ++i)
        column[static_cast<size_t>(i)] = wrapIndex(static_cast<int>(fx) + i, level.width, wrapS_);
    const glm::dvec3 columns = weights(wx), rows = weights(wy);
    glm::dvec3 values, slopes; // of the rows
    for (int j = 0; j < 3; ++j) {
        const int row = wrapIndex(static_cast<int>(fy) + j, level.height, wrapT_);
        const glm::dvec3 texels(texel<double>(level, column[0], row), texel<double>(level, column[1], row),
                                texel<double>(level, column[2], row));
        values[j] = glm::dot(columns, texels);
        slopes[j] = step(wx, texels);
    }
    return {glm::dot(rows, values), level.width * glm::dot(rows, slopes), level.height * step(wy, values)};
}

HapticMap::Slope HapticMap::slope(const glm::dvec2& uv, double level) const {
    // Each level by its own texel, so that the gradient does not jump where one level gives way to the next.
    const glm::dvec3 s = between(level, [&](const Level& at) { return valueAndSlope(at, uv); });
    return {s.x, {s.y, s.z}};
}

} // namespace touchstone
