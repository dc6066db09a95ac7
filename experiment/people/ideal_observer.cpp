#include "experiment/people/ideal_observer.h"

#include "engine/core/error.h"

#include <algorithm>
#include <cmath>

namespace touchstone::experiment {

double Draw::uniform() noexcept { // splitmix64
    state_ += 0x9e3779b97f4a7c15u;
    uint64_t x = state_;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return static_cast<double>((x ^ (x >> 31)) >> 11) * 0x1p-53;
}

double Draw::normal() noexcept {
    const double radius = std::sqrt(-2.0 * std::log(1.0 - uniform()));
    return radius * std::cos(6.283185307179586 * uniform());
}

double sensitivity(const Condition& condition, const StrokeDifference& difference, double force,
                   double acuity, const ObserverNoise& noise, Attention attention) {
    const auto* curve = std::get_if<PlanarStimulus>(&condition.comparison);
    const Stroke nominal;
    // The direction's error scales with the force; that of the depth, with the stiffness, does not.
    const double scale = force / nominal.force, ofForce = noise.force * force, ofPlace = noise.location;
    const bool moves = curve != nullptr && curve->rendering.location != PlanarLocation::Held;
    double sum = difference.normal / (ofForce * ofForce);
    if (!(attention == Attention::TactileFirst && moves))
        sum += difference.tangential * scale * scale / (ofForce * ofForce);
    if (moves)
        sum += difference.location / (ofPlace * ofPlace);
    return std::sqrt(sum * noise.exposure / noise.look) / acuity;
}

double shareRight(double dPrime) {
    constexpr double kLapses = 0.01;
    const double right = 0.5 * std::erfc(-0.5 * dPrime); // Phi(d' / sqrt 2)
    return 0.5 * kLapses + (1.0 - kLapses) * right;
}

DifferenceTable::DifferenceTable(const Condition& condition, const Stroke& stroke)
    : condition_(condition), stroke_(stroke) {}

const StrokeDifference& DifferenceTable::at(double level) {
    const long key = std::lround(level);
    const auto found = std::lower_bound(known_.begin(), known_.end(), key,
                                        [](const auto& entry, long wanted) { return entry.first < wanted; });
    if (found != known_.end() && found->first == key)
        return found->second;
    const auto* curve = std::get_if<PlanarStimulus>(&condition_.reference);
    const StrokeDifference made =
        curve != nullptr ? compare(*curve, std::get<PlanarStimulus>(condition_.comparison), level, stroke_)
                         : compareModels(condition_, level, models_, stroke_);
    rendered_ += 2 * made.ticks;
    return known_.insert(found, {key, made})->second;
}

SimulatedPerson personOf(uint64_t seed, size_t person, const PeopleSpread& spread, const Stroke& stroke) {
    Draw draw(seed ^ (0x632be59bd9b4e019u * (person + 1)));
    SimulatedPerson made;
    made.acuity = std::exp(spread.acuity * draw.normal());
    made.force = stroke.force * std::exp(spread.force * draw.normal());
    return made;
}

double thresholdOf(DifferenceTable& table, const SimulatedPerson& person, const ObserverNoise& noise,
                   Attention attention) {
    const StaircaseRule& rule = table.condition().rule;
    const auto right = [&](double level) {
        return shareRight(
            sensitivity(table.condition(), table.at(level), person.force, person.acuity, noise, attention));
    };
    double low = rule.lowest, high = rule.highest;
    if (right(low) < kStaircaseShare)
        return low;
    while (high - low > 1.0) {
        const double middle = std::floor(0.5 * (low + high));
        (right(middle) >= kStaircaseShare ? low : high) = middle;
    }
    const double atLow = right(low), atHigh = right(high);
    return atHigh >= kStaircaseShare ? high
                                     : low + (atLow - kStaircaseShare) / std::max(1e-12, atLow - atHigh);
}

} // namespace touchstone::experiment
