#include "experiment/statistics/distributions.h"

#include "engine/core/error.h"

#include <boost/math/distributions/binomial.hpp>
#include <boost/math/distributions/fisher_f.hpp>
#include <boost/math/distributions/students_t.hpp>
#include <boost/math/quadrature/gauss.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone::experiment {

namespace {

constexpr double kSqrtHalf = 0.70710678118654752;
using Quadrature = boost::math::quadrature::gauss<double, 30>;

double phi(double z) {
    return 0.3989422804014327 * std::exp(-0.5 * z * z);
}

/// Phi(b) - Phi(a), without cancellation where both lie in one tail.
double normalBetween(double a, double b) {
    return a > 0.0 ? 0.5 * (std::erfc(a * kSqrtHalf) - std::erfc(b * kSqrtHalf))
                   : 0.5 * (std::erfc(-b * kSqrtHalf) - std::erfc(-a * kSqrtHalf));
}

/// P(range of `groups` standard normal variables <= w): groups times the integral of phi(z) (Phi(z) - Phi(z -
/// w))^(groups - 1), z the largest.
double rangeWithin(double w, int groups) {
    if (w <= 0.0)
        return 0.0;
    constexpr double kFar = 8.5; // phi is 1e-16 there
    const auto density = [&](double z) { return phi(z) * std::pow(normalBetween(z - w, z), groups - 1); };
    double sum = 0.0;
    constexpr int kPanels = 3;
    for (int i = 0; i < kPanels; ++i)
        sum += Quadrature::integrate(density, -kFar + 2.0 * kFar * i / kPanels,
                                     -kFar + 2.0 * kFar * (i + 1) / kPanels);
    return std::min(1.0, groups * sum);
}

} // namespace

double fTail(double f, double between, double within) {
    if (!(between > 0.0) || !(within > 0.0))
        throw Error("F distribution", "", "its degrees of freedom are not positive",
                    "more people or conditions");
    if (std::isnan(f))
        return f;
    if (f <= 0.0)
        return 1.0;
    if (std::isinf(f))
        return 0.0;
    return boost::math::cdf(boost::math::complement(boost::math::fisher_f(between, within), f));
}

double tQuantile(double confidence, double degrees) {
    if (!(degrees > 0.0) || !(confidence > 0.0 && confidence < 1.0))
        throw Error("t distribution", "", "its degrees of freedom are not positive", "two people at least");
    return boost::math::quantile(
        boost::math::complement(boost::math::students_t(degrees), 0.5 * (1.0 - confidence)));
}

double studentizedRangeTail(double q, int groups, double degrees) {
    if (groups < 2 || !(degrees >= 1.0))
        throw Error("studentized range", "", "it needs two groups and one degree of freedom",
                    "more people or conditions");
    if (std::isnan(q))
        return q;
    if (q <= 0.0)
        return 1.0;
    if (degrees > 1e5)
        return std::max(0.0, 1.0 - rangeWithin(q, groups));
    // s: the error's scale, degrees s^2 ~ chi^2. log density: c + (degrees - 1) log s - degrees s^2 / 2.
    const double half = 0.5 * degrees;
    const double constant = std::log(2.0) + half * std::log(half) - std::lgamma(half);
    const auto tail = [&](double s) {
        const double density = std::exp(constant + (degrees - 1.0) * std::log(s) - half * s * s);
        return density > 0.0 ? density * (1.0 - rangeWithin(q * s, groups)) : 0.0;
    };
    const double width = 9.0 / std::sqrt(2.0 * degrees); // nine standard deviations of s, nearly
    const double low = std::max(1e-12, 1.0 - width), high = 1.0 + std::max(width, 1.0);
    double sum = 0.0;
    constexpr int kPanels = 3;
    for (int i = 0; i < kPanels; ++i)
        sum += Quadrature::integrate(tail, low + (high - low) * i / kPanels,
                                     low + (high - low) * (i + 1) / kPanels);
    return std::clamp(sum, 0.0, 1.0);
}

double studentizedRangeQuantile(double tail, int groups, double degrees) {
    double low = 0.0, high = 1.0;
    while (studentizedRangeTail(high, groups, degrees) > tail && high < 1e4)
        high *= 2.0;
    for (int i = 0; i < 45; ++i) {
        const double middle = 0.5 * (low + high);
        (studentizedRangeTail(middle, groups, degrees) > tail ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

double guessTail(int right, int trials) {
    if (right <= 0 || trials <= 0)
        return 1.0;
    if (right > trials)
        return 0.0;
    return boost::math::cdf(boost::math::complement(boost::math::binomial(trials, 0.5), right - 1));
}

} // namespace touchstone::experiment
