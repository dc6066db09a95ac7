#include "engine/volume/volume.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>
#include <utility>

namespace touchstone {

namespace {

template <class Stored>
void toFloats(const uint8_t* stored, const VolumeFacts& facts, std::span<float> values) {
    const bool plain = facts.scale == 1.0 && facts.offset == 0.0;
    for (size_t i = 0; i < values.size(); ++i) {
        Stored value;
        std::memcpy(&value, stored + i * sizeof value, sizeof value);
        values[i] = plain ? static_cast<float>(value)
                          : static_cast<float>(facts.scale * static_cast<double>(value) + facts.offset);
    }
}

std::string shown(double number) {
    char text[32];
    std::snprintf(text, sizeof text, "%.6g", number);
    return text;
}

} // namespace

Volume::Volume(VolumeFacts facts, std::span<const uint8_t> stored, std::shared_ptr<const void> owner,
               const std::string& shownAs, const Progress& progress)
    : facts_(std::move(facts)), stored_(stored), owner_(std::move(owner)) {
    blocks_ = (facts_.size + (kBlock - 1)) / kBlock;
    measure(shownAs, progress);
    count(progress);
    defaultIso_ = facts_.statedIso.value_or(otsuThreshold(histogram_, low_, high_));
}

void Volume::row(const glm::ivec3& first, std::span<float> values) const noexcept {
    const size_t at = static_cast<size_t>(first.x) +
                      static_cast<size_t>(facts_.size.x) *
                          (static_cast<size_t>(first.y) +
                           static_cast<size_t>(facts_.size.y) * static_cast<size_t>(first.z));
    const uint8_t* const stored = stored_.data() + at * bytesOf(facts_.type);
    switch (facts_.type) {
    case VolumeType::UInt8:
        return toFloats<uint8_t>(stored, facts_, values);
    case VolumeType::Int8:
        return toFloats<int8_t>(stored, facts_, values);
    case VolumeType::UInt16:
        return toFloats<uint16_t>(stored, facts_, values);
    case VolumeType::Int16:
        return toFloats<int16_t>(stored, facts_, values);
    case VolumeType::Float:
        return toFloats<float>(stored, facts_, values);
    }
}

void Volume::measure(const std::string& shownAs, const Progress& progress) {
    const glm::ivec3& n = facts_.size;
    ranges_.assign(static_cast<size_t>(blocks_.x) * static_cast<size_t>(blocks_.y) *
                       static_cast<size_t>(blocks_.z),
                   {INFINITY, -INFINITY});
    uint64_t broken = 0;
    glm::ivec3 first(0);
    std::vector<float> values(static_cast<size_t>(n.x));
    std::vector<ValueRange> parts(static_cast<size_t>(blocks_.x));
    for (int z = 0; z < n.z; ++z)
        for (int y = 0; y < n.y; ++y) {
            progress.stopIfCancelled();
            row({0, y, z}, values);
            float sum = 0.0f;
            for (const float value : values)
                sum += 0.0f * value; // not a number where one is not finite
            if (sum != sum)
                for (int x = 0; x < n.x; ++x)
                    if (!std::isfinite(values[static_cast<size_t>(x)]) && broken++ == 0)
                        first = {x, y, z};
            for (int bx = 0; bx < blocks_.x; ++bx) {
                const auto begin = values.begin() + bx * kBlock;
                const auto end = values.begin() + std::min(bx * kBlock + kBlock + 1, n.x);
                float least = *begin, most = *begin;
                for (auto at = begin; at != end; ++at) {
                    least = std::min(least, *at);
                    most = std::max(most, *at);
                }
                parts[static_cast<size_t>(bx)] = {least, most};
            }
            // A row on a border belongs to the block before, too.
            for (int bz = z / kBlock - (z % kBlock == 0 && z > 0); bz <= z / kBlock; ++bz)
                for (int by = y / kBlock - (y % kBlock == 0 && y > 0); by <= y / kBlock; ++by)
                    for (int bx = 0; bx < blocks_.x; ++bx) {
                        ValueRange& range = ranges_[indexOf({bx, by, bz})];
                        range.low = std::min(range.low, parts[static_cast<size_t>(bx)].low);
                        range.high = std::max(range.high, parts[static_cast<size_t>(bx)].high);
                    }
        }
    if (broken > 0)
        throw Error(shownAs, "",
                    std::to_string(broken) + " voxels are not finite numbers, the first at (" +
                        std::to_string(first.x) + ", " + std::to_string(first.y) + ", " +
                        std::to_string(first.z) + ")",
                    "replace them by a number below the surface's, such as the value of air");
    low_ = INFINITY;
    high_ = -INFINITY;
    for (const ValueRange& range : ranges_) {
        low_ = std::min(low_, static_cast<double>(range.low));
        high_ = std::max(high_, static_cast<double>(range.high));
    }
    if (!(low_ < high_))
        throw Error(shownAs, "", "every voxel has the value " + shown(low_) + ": there is no surface",
                    "check the file, or how it was exported");
    // Differences of values are floats, also of the lowest and the highest, a thousandth of theirs, and 256
    // equal steps between them.
    constexpr double kNarrowest = 1e-30,
                     kSteps = 8.0 * static_cast<double>(std::numeric_limits<float>::epsilon());
    const double range = high_ - low_;
    if (range > static_cast<double>(std::numeric_limits<float>::max()) || range < kNarrowest ||
        range < kSteps * std::max(std::abs(low_), std::abs(high_)))
        throw Error(shownAs, "",
                    "its values go from " + shown(low_) + " to " + shown(high_) +
                        ": numbers of 32 bits cannot divide that",
                    "store them with another scale or offset");
}

void Volume::count(const Progress& progress) {
    std::vector<float> values(static_cast<size_t>(facts_.size.x));
    const double factor = kBins / (high_ - low_);
    for (int z = 0; z < facts_.size.z; ++z)
        for (int y = 0; y < facts_.size.y; ++y) {
            progress.stopIfCancelled();
            row({0, y, z}, values);
            for (const float value : values)
                ++histogram_[static_cast<size_t>(
                    std::clamp((static_cast<double>(value) - low_) * factor, 0.0, kBins - 1.0))];
        }
}

void Volume::checkIso(double iso, const std::string& shownAs) const {
    if (!(iso > low_) || !(iso <= high_))
        throw Error(shownAs, "", "has no surface with the value " + shown(iso),
                    "its values go from " + shown(low_) + " to " + shown(high_) + ": give an --iso between");
}

Bounds Volume::bounds() const {
    Bounds bounds;
    for (int corner = 0; corner < 8; ++corner)
        bounds.include(
            scenePoint(glm::dvec3(facts_.size - 1) * glm::dvec3(corner & 1, corner >> 1 & 1, corner >> 2)));
    return bounds;
}

float highestOutside(double iso) {
    const auto rounded = static_cast<float>(iso);
    return static_cast<double>(rounded) < iso ? rounded : std::nextafter(rounded, -INFINITY);
}

double otsuThreshold(const Volume::Histogram& histogram, double low, double high) {
    double all = 0.0, sum = 0.0;
    for (size_t bin = 0; bin < histogram.size(); ++bin) {
        all += static_cast<double>(histogram[bin]);
        sum += static_cast<double>(bin) * static_cast<double>(histogram[bin]);
    }
    double below = 0.0, belowSum = 0.0, largest = -1.0, first = 0.0, last = 0.0;
    for (size_t bin = 0; bin + 1 < histogram.size(); ++bin) {
        below += static_cast<double>(histogram[bin]);
        belowSum += static_cast<double>(bin) * static_cast<double>(histogram[bin]);
        if (below == 0.0 || below == all)
            continue;
        const double apart = belowSum / below - (sum - belowSum) / (all - below);
        const double between = below * (all - below) * apart * apart;
        if (between > largest) {
            largest = between;
            first = static_cast<double>(bin + 1);
        }
        if (between >= largest)
            last = static_cast<double>(bin + 1); // empty bins between two peaks: the middle of them
    }
    return low + (high - low) * 0.5 * (first + last) / static_cast<double>(histogram.size());
}

} // namespace touchstone
