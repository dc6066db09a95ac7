#include "haptics/texture/persistent_texture.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

PersistentTexture::PersistentTexture(std::shared_ptr<const TexelMap> map, const PersistentTextureSize& size,
                                     std::shared_ptr<const std::vector<float>> start)
    : map_(std::move(map)), size_(size), start_(std::move(start)),
      values_(start_ != nullptr ? *start_
                                : std::vector<float>(size_t{size.width} * size.height, size.initial)),
      tileRevisions_(tiles(), 0), mean_(static_cast<double>(size.initial)),
      reached_(std::make_unique<TexelMap::Reached>()) {
    if (start_ != nullptr)
        settle();
}

double PersistentTexture::at(const glm::dvec2& uv, glm::dvec2* gradient) const noexcept {
    const double width = size_.width, height = size_.height;
    const double u = (uv.x - std::floor(uv.x)) * width - 0.5, v = (uv.y - std::floor(uv.y)) * height - 0.5;
    const double left = std::floor(u), top = std::floor(v), fx = u - left, fy = v - top;
    if (!std::isfinite(fx + fy)) {
        if (gradient != nullptr)
            *gradient = glm::dvec2(0.0);
        return static_cast<double>(size_.initial);
    }
    const auto wrapped = [](double cell, uint32_t side) {
        const auto at = static_cast<int64_t>(cell), n = int64_t{side};
        return static_cast<size_t>((at % n + n) % n);
    };
    const size_t x0 = wrapped(left, size_.width), x1 = wrapped(left + 1.0, size_.width),
                 y0 = wrapped(top, size_.height), y1 = wrapped(top + 1.0, size_.height), row = size_.width;
    const auto value = [&](size_t x, size_t y) { return static_cast<double>(values_[y * row + x]); };
    const double a = value(x0, y0), b = value(x1, y0), c = value(x0, y1), d = value(x1, y1);
    const double upper = a + fx * (b - a), lower = c + fx * (d - c);
    if (gradient != nullptr)
        *gradient = {width * ((b - a) + fy * ((d - c) - (b - a))), height * (lower - upper)};
    return upper + fy * (lower - upper);
}

/// Fills reached_. False where no texel is near.
bool PersistentTexture::gather(const BrushStroke& stroke) noexcept {
    // A disc of this radius holds nine tenths of the texels that may change, where they are as dense as on
    // average.
    const double largest = map_->spacing() * std::sqrt(static_cast<double>(stroke.most) / 3.5);
    double radius = std::min(std::max(stroke.radius, 1.5 * map_->spacing()), largest);
    bool shrunk = false;
    for (int round = 0; round < 8; ++round) {
        map_->reach(stroke.point, stroke.normal, radius, stroke.most, *reached_);
        if (reached_->full) {
            radius *= 0.7;
            shrunk = true;
        } else if (reached_->count == 0 && !shrunk && round < 4) {
            radius *= 2.0;
        } else {
            break;
        }
    }
    return reached_->count > 0 && !reached_->full;
}

void PersistentTexture::apply(const BrushStroke& stroke) noexcept {
    if (stroke.change == 0.0 || !std::isfinite(stroke.change) || !(stroke.radius > 0.0) || !gather(stroke))
        return;
    const std::vector<float>& areas = map_->areas();
    const TexelMap::Reached& reached = *reached_;
    double sum = 0.0;
    for (uint32_t i = 0; i < reached.count; ++i)
        sum += static_cast<double>(reached.weight[i]) * static_cast<double>(areas[reached.texel[i]]);
    if (!(sum > 0.0))
        return;
    const double each = stroke.change / sum;
    double changed = 0.0;
    ++revision_;
    const uint32_t across = tilesAcross();
    for (uint32_t i = 0; i < reached.count; ++i) {
        const uint32_t texel = reached.texel[i];
        float& value = values_[texel];
        const float before = value;
        const double next = static_cast<double>(before) + each * static_cast<double>(reached.weight[i]);
        value = std::clamp(static_cast<float>(next), size_.minimum, size_.maximum);
        if (value == before)
            continue;
        changed +=
            static_cast<double>(areas[texel]) * (static_cast<double>(value) - static_cast<double>(before));
        const uint32_t y = texel / size_.width, x = texel - y * size_.width;
        tileRevisions_[y / kTile * across + x / kTile] = revision_;
    }
    mean_ += changed / map_->area();
}

PersistentTexture::Place PersistentTexture::placeOf(uint32_t tile) const {
    const uint32_t x = tile % tilesAcross() * kTile, y = tile / tilesAcross() * kTile;
    return {x, y, std::min(kTile, size_.width - x), std::min(kTile, size_.height - y)};
}

std::vector<float> PersistentTexture::tileValues(uint32_t tile) const {
    const Place place = placeOf(tile);
    std::vector<float> result;
    result.reserve(size_t{place.width} * place.height);
    for (uint32_t y = place.y; y < place.y + place.height; ++y) {
        const auto row = values_.begin() + static_cast<std::ptrdiff_t>(size_t{y} * size_.width + place.x);
        result.insert(result.end(), row, row + place.width);
    }
    return result;
}

bool PersistentTexture::setTile(uint32_t tile, std::span<const float> values) {
    if (tile >= tiles())
        return false;
    const Place place = placeOf(tile);
    if (values.size() != size_t{place.width} * place.height ||
        !std::ranges::all_of(values, [](float value) { return std::isfinite(value); }))
        return false;
    for (uint32_t y = 0; y < place.height; ++y)
        std::ranges::copy(values.subspan(size_t{y} * place.width, place.width),
                          values_.begin() +
                              static_cast<std::ptrdiff_t>(size_t{place.y + y} * size_.width + place.x));
    tileRevisions_[tile] = ++revision_;
    return true;
}

void PersistentTexture::reset() {
    std::ranges::fill(values_, size_.initial);
    std::ranges::fill(tileRevisions_, ++revision_);
    mean_ = static_cast<double>(size_.initial);
}

void PersistentTexture::settle() {
    double sum = 0.0;
    const std::vector<float>& areas = map_->areas();
    for (size_t i = 0; i < values_.size(); ++i)
        sum += static_cast<double>(areas[i]) * static_cast<double>(values_[i]);
    mean_ = map_->area() > 0.0 ? sum / map_->area() : static_cast<double>(size_.initial);
}

} // namespace touchstone
