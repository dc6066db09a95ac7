#include "engine/time/samples.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

void Samples::add(int64_t value) {
    if (window_ == 0 || values_.size() < window_) {
        values_.push_back(value);
    } else {
        values_[oldest_] = value;
        oldest_ = (oldest_ + 1) % window_;
    }
}

int64_t Samples::percentile(double share) const {
    if (values_.empty())
        return 0;
    scratch_ = values_;
    const double rank = std::ceil(share * static_cast<double>(values_.size()));
    const size_t index = rank <= 1.0 ? 0 : std::min(values_.size(), static_cast<size_t>(rank)) - 1;
    const auto nth = scratch_.begin() + static_cast<std::ptrdiff_t>(index);
    std::nth_element(scratch_.begin(), nth, scratch_.end());
    return *nth;
}

std::vector<uint64_t> Samples::histogram(std::span<const int64_t> ends) const {
    std::vector<uint64_t> bins(ends.size() + 1, 0);
    for (const int64_t value : values_)
        ++bins[static_cast<size_t>(std::lower_bound(ends.begin(), ends.end(), value) - ends.begin())];
    return bins;
}

double Samples::mean() const {
    if (values_.empty())
        return 0.0;
    double sum = 0.0;
    for (const int64_t value : values_)
        sum += static_cast<double>(value);
    return sum / static_cast<double>(values_.size());
}

int64_t Samples::most() const {
    return values_.empty() ? 0 : *std::max_element(values_.begin(), values_.end());
}

} // namespace touchstone
