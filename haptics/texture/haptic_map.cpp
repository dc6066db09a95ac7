#include "haptics/texture/haptic_map.h"

#include "haptics/texture/wrap_index.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <type_traits>

namespace touchstone {

namespace {

/// Float maps may hold any value; beyond this, sums of texels would overflow.
constexpr float kLargestTexel = 1e12f;

/// The texels that a coarser one covers, with their weights.
struct Cover {
    int first = 0, count = 0;
    float share[4] = {};
};

/// Coarse texel i of `coarse` over `fine` ones: two of them, or three where an odd size is halved.
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
    : channels_(channels) {
    Layout layout{.texCoord = reference.texCoord,
                  .width = pixels.width,
                  .height = pixels.height,
                  .wrapS = reference.wrapS,
                  .wrapT = reference.wrapT,
                  .offset = glm::dvec2(reference.offset)};
    // KHR_texture_transform: scale, then rotate counter-clockwise as seen in the image (v points down).
    const auto angle = static_cast<double>(reference.rotation);
    const double c = std::cos(angle), s = std::sin(angle);
    const glm::dvec2 scale(reference.scale);
    layout.jacobian = glm::dmat2(glm::dvec2(c, -s) * scale.x, glm::dvec2(s, c) * scale.y);
    layout_ = std::make_shared<const Layout>(layout);

    Level level;
    level.width = pixels.width;
    level.height = pixels.height;
    level.texels.resize(static_cast<size_t>(level.width) * static_cast<size_t>(level.height) *
                        static_cast<size_t>(channels));
    float* out = level.texels.data();
    for (int y = 0; y < level.height; ++y)
        for (int x = 0; x < level.width; ++x)
            for (int k = 0; k < channels; ++k)
                *out++ = pixels.value(x, y, std::min(k, pixels.channels - 1));
    for (float& texel : level.texels)
        texel = std::isfinite(texel) ? std::clamp(texel, -kLargestTexel, kLargestTexel) : 0.0f;
    least_ = INFINITY;
    greatest_ = -INFINITY;
    for (size_t i = 0; i < level.texels.size(); i += static_cast<size_t>(channels)) {
        least_ = std::min(least_, level.texels[i]);
        greatest_ = std::max(greatest_, level.texels[i]);
    }
    std::vector<Level> levels;
    levels.push_back(std::move(level));
    while (levels.back().width > 1 || levels.back().height > 1)
        levels.push_back(halved(levels.back()));
    levels_ = Levels(std::move(levels));
}

/// Box filter over the exact area of a coarse texel, so that odd sizes neither shift nor lose an edge.
HapticMap::Level HapticMap::halved(const Level& fine) const {
    Level coarse;
    coarse.width = std::max(1, fine.width / 2);
    coarse.height = std::max(1, fine.height / 2);
    const auto channels = static_cast<size_t>(channels_);
    coarse.texels.assign(static_cast<size_t>(coarse.width) * static_cast<size_t>(coarse.height) * channels,
                         0.0f);
    std::vector<Cover> columnsOf; // the same for each row
    for (int x = 0; x < coarse.width; ++x)
        columnsOf.push_back(coverOf(x, fine.width, coarse.width));
    float* out = coarse.texels.data();
    for (int y = 0; y < coarse.height; ++y) {
        const Cover rows = coverOf(y, fine.height, coarse.height);
        for (const Cover& columns : columnsOf) {
            for (int j = 0; j < rows.count; ++j)
                for (int i = 0; i < columns.count; ++i) {
                    const size_t at = static_cast<size_t>(rows.first + j) * static_cast<size_t>(fine.width) +
                                      static_cast<size_t>(columns.first + i);
                    for (size_t k = 0; k < channels; ++k)
                        out[k] += rows.share[j] * columns.share[i] * fine.texels[at * channels + k];
                }
            out += channels;
        }
    }
    return coarse;
}

uint64_t HapticMap::memoryBytes() const {
    uint64_t bytes = 0;
    for (size_t i = 0; i < levels_.size(); ++i)
        bytes += levels_[i].texels.size() * sizeof(float);
    return bytes;
}

void HapticMap::shareLayout(const HapticMap& other) {
    if (*layout_ == *other.layout_)
        layout_ = other.layout_;
}

void HapticMap::addTo(Hash64& hash) const {
    hash.add(channels_);
    hash.add(layout_->texCoord);
    hash.add(layout_->wrapS);
    hash.add(layout_->wrapT);
    for (const double number : {layout_->offset.x, layout_->offset.y, layout_->jacobian[0][0],
                                layout_->jacobian[0][1], layout_->jacobian[1][0], layout_->jacobian[1][1]})
        hash.add(number);
    if (empty())
        return;
    hash.add(levels_[0].width);
    hash.addBytes(levels_[0].texels); // the coarser levels are derived from it
}

glm::dvec2 HapticMap::transform(const glm::dvec2& uv) const {
    return layout_->offset + layout_->jacobian * uv;
}

void HapticMap::findCell(const Level& level, const glm::dvec2& uv, Footprint::Cell& cell) const {
    // Texel centres lie at half-integers (glTF and every GPU agree).
    const double x = boundedTexel(uv.x * level.width - 0.5), y = boundedTexel(uv.y * level.height - 0.5);
    const double fx = std::floor(x), fy = std::floor(y);
    const int x0 = wrapIndex(static_cast<int>(fx), level.width, layout_->wrapS);
    const int x1 = wrapIndex(static_cast<int>(fx) + 1, level.width, layout_->wrapS);
    const int y0 = wrapIndex(static_cast<int>(fy), level.height, layout_->wrapT);
    const int y1 = wrapIndex(static_cast<int>(fy) + 1, level.height, layout_->wrapT);
    const int upper = y0 * level.width, lower = y1 * level.width;
    cell.texel = {upper + x0, upper + x1, lower + x0, lower + x1};
    cell.right = x - fx;
    cell.down = y - fy;
}

void HapticMap::footprint(const glm::dvec2& uv, double level, Footprint& at) const {
    const double bound = std::clamp(level, 0.0, static_cast<double>(levels_.size() - 1));
    at.level = static_cast<size_t>(bound);
    at.share = bound - static_cast<double>(at.level);
    findCell(levels_[at.level], uv, at.fine);
    if (at.share > 0.0)
        findCell(levels_[at.level + 1], uv, at.coarse);
}

template <class Value>
Value HapticMap::bilinear(const Level& level, const Footprint::Cell& cell) const {
    const auto texel = [&](size_t i) {
        const float* t = &level.texels[static_cast<size_t>(cell.texel[i] * channels_)];
        if constexpr (std::is_same_v<Value, double>)
            return static_cast<double>(*t);
        else
            return channels_ >= 3 ? glm::dvec3(t[0], t[1], t[2]) : glm::dvec3(t[0], 0.0, 0.0);
    };
    return (1.0 - cell.down) * ((1.0 - cell.right) * texel(0) + cell.right * texel(1)) +
           cell.down * ((1.0 - cell.right) * texel(2) + cell.right * texel(3));
}

template <class Value>
Value HapticMap::read(const Footprint& at) const {
    const Value fine = bilinear<Value>(levels_[at.level], at.fine);
    if (!(at.share > 0.0))
        return fine;
    return (1.0 - at.share) * fine + at.share * bilinear<Value>(levels_[at.level + 1], at.coarse);
}

double HapticMap::scalar(const Footprint& at) const {
    return read<double>(at);
}

glm::dvec3 HapticMap::vector(const Footprint& at) const {
    return read<glm::dvec3>(at);
}

/// (value, d/du, d/dv). The points half a texel to the left and to the right of the place lie in two adjacent
/// cells, and the place itself in one of them, so three columns and three rows suffice. With w the fraction
/// from the first column to the second at the left point, the weights of the columns are (1/2 - w)+, 1 - |w -
/// 1/2|, (w - 1/2)+ for the value; the slope is 1 - w of the first difference and w of the second, exactly
/// zero where texels are equal.
glm::dvec3 HapticMap::valueAndSlope(const Level& level, const glm::dvec2& uv) const {
    const double x = boundedTexel(uv.x * level.width - 1.0), y = boundedTexel(uv.y * level.height - 1.0);
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
        column[static_cast<size_t>(i)] = wrapIndex(static_cast<int>(fx) + i, level.width, layout_->wrapS);
    const glm::dvec3 columns = weights(wx), rows = weights(wy);
    glm::dvec3 values, slopes; // of the rows
    for (int j = 0; j < 3; ++j) {
        const int row = level.width * wrapIndex(static_cast<int>(fy) + j, level.height, layout_->wrapT);
        const auto texel = [&](size_t i) {
            return static_cast<double>(level.texels[static_cast<size_t>((row + column[i]) * channels_)]);
        };
        const glm::dvec3 texels(texel(0), texel(1), texel(2));
        values[j] = glm::dot(columns, texels);
        slopes[j] = step(wx, texels);
    }
    return {glm::dot(rows, values), level.width * glm::dot(rows, slopes), level.height * step(wy, values)};
}

HapticMap::Slope HapticMap::slope(const glm::dvec2& uv, double level) const {
    const double bound = std::clamp(level, 0.0, static_cast<double>(levels_.size() - 1));
    const auto fine = static_cast<size_t>(bound);
    const double share = bound - static_cast<double>(fine);
    glm::dvec3 s = valueAndSlope(levels_[fine], uv);
    // Each level's slope is over its own texel, so that the gradient does not jump between levels.
    if (share > 0.0)
        s = (1.0 - share) * s + share * valueAndSlope(levels_[fine + 1], uv);
    return {s.x, {s.y, s.z}};
}

} // namespace touchstone
