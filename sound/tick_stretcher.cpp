#include "sound/tick_stretcher.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone {

namespace {

/// Modified Bessel function of the first kind, order 0.
double besselI0(double x) {
    double sum = 1.0, term = 1.0;
    for (int k = 1; k < 40; ++k) {
        term *= (0.5 * x / k) * (0.5 * x / k);
        sum += term;
    }
    return sum;
}

double kaiser(double x, double beta) {
    return x * x >= 1.0 ? 0.0 : besselI0(beta * std::sqrt(1.0 - x * x)) / besselI0(beta);
}

double sinc(double x) {
    const double angle = std::numbers::pi * x;
    return std::abs(angle) < 1e-9 ? 1.0 : std::sin(angle) / angle;
}

} // namespace

TickStretcher::TickStretcher(double rate) : rate_(rate) {
    constexpr double kBeta = 6.0;
    for (size_t p = 0; p <= kPhases; ++p) {
        const double phase = static_cast<double>(p) / kPhases;
        std::array<double, kTaps> taps{};
        double sum = 0.0;
        for (size_t t = 0; t < kTaps; ++t) {
            const double distance = static_cast<double>(t) - (kReach - 1.0) - phase; // ticks
            taps[t] = sinc(distance) * kaiser(distance / kReach, kBeta);
            sum += taps[t];
        }
        for (size_t t = 0; t < kTaps; ++t) // constant input gives constant output, whatever the phase
            kernel_[p][t] = static_cast<float>(taps[t] / sum);
    }
}

bool TickStretcher::push(const ForceRates& rates, double dt) noexcept {
    if (end_ - begin_ >= kCapacity - kTaps)
        return false;
    ticks_[end_++ & (kCapacity - 1)] = {rates.press, rates.drag, static_cast<float>(dt * rate_)};
    return true;
}

bool TickStretcher::pop(StretchedFrame& frame, double speed) noexcept {
    if (end_ - begin_ <= kReach)
        return false;
    const double place = phase_ * kPhases;
    const auto row = std::min(static_cast<size_t>(place), kPhases - 1);
    const auto share = static_cast<float>(place - static_cast<double>(row));
    frame = {};
    for (size_t t = 0; t < kTaps; ++t) {
        const float weight = kernel_[row][t] + share * (kernel_[row + 1][t] - kernel_[row][t]);
        const Tick& tick = at(begin_ + t + 1 - kReach);
        frame.press += weight * tick.press;
        frame.drag += weight * tick.drag;
    }
    // A tick's value is at its end: the interval between two ticks has the dt of the second.
    phase_ += speed / static_cast<double>(at(begin_ + 1).frames);
    while (phase_ >= 1.0 && end_ - begin_ > kReach) {
        phase_ -= 1.0;
        ++begin_;
    }
    phase_ = std::min(phase_, 1.0);
    return true;
}

double TickStretcher::ahead() const noexcept {
    double frames = 0.0;
    for (size_t i = begin_ + 1; i + kReach <= end_; ++i)
        frames += static_cast<double>(at(i).frames);
    return std::max(0.0, frames - phase_ * static_cast<double>(at(begin_ + 1).frames));
}

void TickStretcher::skip(double frames) noexcept {
    while (end_ - begin_ > kReach && frames >= static_cast<double>(at(begin_ + 1).frames))
        frames -= static_cast<double>(at(++begin_).frames);
}

void TickStretcher::reset() noexcept {
    ticks_.fill({});
    end_ = kReach;
    begin_ = kReach - 1;
    phase_ = 0.0;
}

} // namespace touchstone
