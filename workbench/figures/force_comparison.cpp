#include "workbench/figures/force_comparison.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace touchstone {

void ForceComparison::Sums::add(double force, bool contact) {
    contactTicks += contact ? 1 : 0;
    sum += force;
    max = std::max(max, force);
}

void ForceComparison::add(double seconds, const RecordedTick& recorded, const HapticOutput& now) {
    const bool then = recorded.contacts > 0, other = now.contacts > 0;
    if (!then && !other)
        return;
    ++ticks_;
    recorded_.add(glm::length(recorded.force), then);
    other_.add(glm::length(now.force), other);
    const double difference = glm::distance(recorded.force, now.force);
    differenceSum_ += difference;
    if (difference > maxDifference_) {
        maxDifference_ = difference;
        maxDifferenceAt_ = seconds;
    }
    if (then && other)
        maxProxyDistance_ = std::max(maxProxyDistance_, glm::distance(recorded.proxy, now.proxy));
}

std::string ForceComparison::text(const std::string& now) const {
    if (ticks_ == 0)
        return "nothing is touched, with the recorded settings or " + now;
    char text[160];
    std::snprintf(text, sizeof text, " %.3f N on average in contact; at most %.3f N apart, at %.3f s",
                  other().mean, maxDifference_, maxDifferenceAt_);
    char then[48];
    std::snprintf(then, sizeof then, "then %.3f N, ", recorded().mean);
    return then + now + text;
}

nlohmann::ordered_json ForceComparison::json() const {
    const auto side = [](const Side& of) {
        return nlohmann::ordered_json{
            {"contact_ticks", of.contactTicks}, {"mean_n", of.mean}, {"max_n", of.max}};
    };
    return {{"ticks", ticks_},
            {"recorded", side(recorded())},
            {"changed", side(other())},
            {"mean_difference_n", meanDifference()},
            {"max_difference_n", maxDifference_},
            {"max_difference_at_s", maxDifferenceAt_},
            {"max_proxy_distance_m", maxProxyDistance_}};
}

} // namespace touchstone
