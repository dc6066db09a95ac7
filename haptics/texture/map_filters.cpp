// The texture filters and gradients other than the default.

#include "haptics/texture/haptic_map.h"
#include "haptics/texture/map_stencil.h"
#include "haptics/texture/wrap_index.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

template <class Rule>
void fillPatch(const HapticMap::Layout& layout, const glm::dvec2& uv, HapticMap::Patch& at) {
    const auto across = Rule::at(boundedTexel(uv.x * layout.width)),
               down = Rule::at(boundedTexel(uv.y * layout.height));
    at.count = Rule::Type::kCount;
    for (int i = 0; i < Rule::Type::kCount; ++i) {
        const auto k = static_cast<size_t>(i);
        at.column[k] = wrapIndex(across.first + i, layout.width, layout.wrapS);
        at.row[k] = layout.width * wrapIndex(down.first + i, layout.height, layout.wrapT);
        at.across[k] = across.value[k];
        at.down[k] = down.value[k];
    }
}

/// Sum over the rows and columns of a patch of `count` texels a side, a compile-time constant.
template <int count, class Value, class Texel>
Value weighted(const HapticMap::Patch& at, const Texel& texel) {
    Value sum(0.0);
    for (size_t j = 0; j < count; ++j) {
        Value row(0.0);
        for (size_t i = 0; i < count; ++i)
            row += at.across[i] * texel(at.row[j] + at.column[i]);
        sum += at.down[j] * row;
    }
    return sum;
}

template <class Value, class Texel>
Value readPatch(const HapticMap::Patch& at, const Texel& texel) {
    switch (at.count) {
    case 4:
        return weighted<4, Value>(at, texel);
    case 2:
        return weighted<2, Value>(at, texel);
    default:
        return texel(at.row[0] + at.column[0]);
    }
}

} // namespace

void HapticMap::patch(const glm::dvec2& uv, TextureFilter filter, Patch& at) const {
    switch (filter) {
    case TextureFilter::Nearest:
        return fillPatch<NearestStencil>(*layout_, uv, at);
    case TextureFilter::Bicubic:
        return fillPatch<CubicStencil>(*layout_, uv, at);
    case TextureFilter::Bilinear:
    case TextureFilter::Mip:
        break;
    }
    fillPatch<LinearStencil>(*layout_, uv, at);
}

double HapticMap::scalar(const Patch& at) const {
    const float* const texels = levels_[0].texels.data();
    return readPatch<double>(at, [&](int32_t i) { return static_cast<double>(texels[i * channels_]); });
}

glm::dvec3 HapticMap::vector(const Patch& at) const {
    const float* const texels = levels_[0].texels.data();
    return readPatch<glm::dvec3>(at, [&](int32_t i) {
        const float* t = texels + i * channels_;
        return channels_ >= 3 ? glm::dvec3(t[0], t[1], t[2]) : glm::dvec3(t[0], 0.0, 0.0);
    });
}

/// Rounded to float whether stored or not, so that storing changes no bit.
std::array<float, 2> HapticMap::texelSlope(const Level& level, int column, int row) const {
    const auto texel = [&](int x, int y) {
        const int at = wrapIndex(y, level.height, layout_->wrapT) * level.width +
                       wrapIndex(x, level.width, layout_->wrapS);
        return static_cast<double>(level.texels[static_cast<size_t>(at * channels_)]);
    };
    return {static_cast<float>(0.5 * (texel(column + 1, row) - texel(column - 1, row))),
            static_cast<float>(0.5 * (texel(column, row + 1) - texel(column, row - 1)))};
}

HapticMap::Slopes HapticMap::texelSlopes() const {
    Slopes slopes;
    for (size_t l = 0; l < levels_.size(); ++l) {
        const Level& level = levels_[l];
        auto& of = slopes.emplace_back();
        of.reserve(static_cast<size_t>(level.width) * static_cast<size_t>(level.height));
        for (int y = 0; y < level.height; ++y)
            for (int x = 0; x < level.width; ++x)
                of.push_back(texelSlope(level, x, y));
    }
    return slopes;
}

/// (value, d/du, d/dv) by a rule that has both in one stencil per axis.
template <class Rule>
glm::dvec3 HapticMap::derived(const Level& level, const glm::dvec2& uv) const {
    constexpr auto kCount = static_cast<size_t>(Rule::Type::kCount);
    const auto across = Rule::at(boundedTexel(uv.x * level.width)),
               down = Rule::at(boundedTexel(uv.y * level.height));
    std::array<int, kCount> column;
    for (size_t i = 0; i < kCount; ++i)
        column[i] = wrapIndex(across.first + static_cast<int>(i), level.width, layout_->wrapS);
    glm::dvec3 sum(0.0);
    for (size_t j = 0; j < kCount; ++j) {
        const int row =
            level.width * wrapIndex(down.first + static_cast<int>(j), level.height, layout_->wrapT);
        double value = 0.0, slope = 0.0;
        for (size_t i = 0; i < kCount; ++i) {
            const auto texel =
                static_cast<double>(level.texels[static_cast<size_t>((row + column[i]) * channels_)]);
            value += across.value[i] * texel;
            slope += across.slope[i] * texel;
        }
        sum += glm::dvec3(down.value[j] * value, down.value[j] * slope, down.slope[j] * value);
    }
    return {sum.x, level.width * sum.y, level.height * sum.z};
}

/// (value, d/du, d/dv): the texels and their slopes by the same filter.
template <class Rule>
glm::dvec3 HapticMap::precomputed(size_t index, const glm::dvec2& uv, const Slopes* kept) const {
    const Level& level = levels_[index];
    const auto across = Rule::at(boundedTexel(uv.x * level.width)),
               down = Rule::at(boundedTexel(uv.y * level.height));
    glm::dvec3 sum(0.0);
    for (int j = 0; j < Rule::Type::kCount; ++j) {
        const int y = down.first + j, row = wrapIndex(y, level.height, layout_->wrapT);
        const double turnV = wrapSlope(y, level.height, layout_->wrapT);
        glm::dvec3 line(0.0);
        for (int i = 0; i < Rule::Type::kCount; ++i) {
            const int x = across.first + i, column = wrapIndex(x, level.width, layout_->wrapS);
            const auto at = static_cast<size_t>(row * level.width + column);
            const std::array<float, 2> slope =
                kept != nullptr ? (*kept)[index][at] : texelSlope(level, column, row);
            line += across.value[static_cast<size_t>(i)] *
                    glm::dvec3(level.texels[at * static_cast<size_t>(channels_)],
                               wrapSlope(x, level.width, layout_->wrapS) * static_cast<double>(slope[0]),
                               turnV * static_cast<double>(slope[1]));
        }
        sum += down.value[static_cast<size_t>(j)] * line;
    }
    return {sum.x, level.width * sum.y, level.height * sum.z};
}

glm::dvec3 HapticMap::slopeAt(size_t level, TextureFilter filter, TextureGradient gradient,
                              const glm::dvec2& uv, const Slopes* kept) const {
    const bool central = gradient == TextureGradient::Central;
    switch (filter) {
    case TextureFilter::Nearest:
        if (gradient == TextureGradient::Precomputed)
            return precomputed<NearestStencil>(level, uv, kept);
        return central ? derived<NearestCentralStencil>(levels_[level], uv)
                       : derived<NearestStencil>(levels_[level], uv);
    case TextureFilter::Bicubic:
        if (gradient == TextureGradient::Precomputed)
            return precomputed<CubicStencil>(level, uv, kept);
        return central ? derived<CubicCentralStencil>(levels_[level], uv)
                       : derived<CubicStencil>(levels_[level], uv);
    case TextureFilter::Bilinear:
    case TextureFilter::Mip:
        break;
    }
    if (gradient == TextureGradient::Precomputed)
        return precomputed<LinearStencil>(level, uv, kept);
    return central ? valueAndSlope(levels_[level], uv) : derived<LinearStencil>(levels_[level], uv);
}

HapticMap::Slope HapticMap::slopeBy(TextureFilter filter, TextureGradient gradient, const glm::dvec2& uv,
                                    double level, const Slopes* kept) const {
    const double bound =
        filter != TextureFilter::Mip ? 0.0 : std::clamp(level, 0.0, static_cast<double>(levels_.size() - 1));
    const auto fine = static_cast<size_t>(bound);
    const double share = bound - static_cast<double>(fine);
    glm::dvec3 s = slopeAt(fine, filter, gradient, uv, kept);
    if (share > 0.0)
        s = (1.0 - share) * s + share * slopeAt(fine + 1, filter, gradient, uv, kept);
    return {s.x, {s.y, s.z}};
}

} // namespace touchstone
