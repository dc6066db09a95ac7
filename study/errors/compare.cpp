#include "study/errors/compare.h"

#include <algorithm>
#include <cmath>

namespace touchstone::study {

namespace {

using truth::FeltTick;

/// By nearest rank, as in Samples.
Spread spreadOf(std::vector<double>& values) {
    if (values.empty())
        return {};
    std::sort(values.begin(), values.end());
    const auto rank = [&](double share) {
        const auto at = static_cast<size_t>(std::ceil(share * static_cast<double>(values.size())));
        return values[std::max<size_t>(at, 1) - 1];
    };
    return {rank(0.5), rank(0.99), values.back()};
}

/// rad; exact for small angles too.
double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double largestJump(std::span<const FeltTick> ticks, std::span<const FeltTick> truth) {
    double largest = 0.0;
    for (size_t i = 1; i < ticks.size(); ++i)
        if (!truth[i].failed && !truth[i - 1].failed)
            largest = std::max(largest, glm::length(ticks[i].force - ticks[i - 1].force));
    return largest;
}

} // namespace

Errors compareWithTruth(std::span<const glm::dvec3> hips, std::span<const FeltTick> truth,
                        std::span<const FeltTick> ours) {
    Errors errors;
    errors.ticks = hips.size();
    std::vector<double> position, magnitude, direction, force;
    uint64_t inTruth = 0, free = 0, lost = 0, invented = 0;
    for (size_t i = 0; i < hips.size(); ++i) {
        const FeltTick &right = truth[i], &felt = ours[i];
        if (right.failed) {
            ++errors.truthFailed;
            continue;
        }
        (right.contact ? inTruth : free) += 1;
        lost += right.contact && !felt.contact ? 1 : 0;
        invented += felt.contact && !right.contact ? 1 : 0;
        if (i + 1 < hips.size())
            errors.energyCreated += glm::dot(felt.force - right.force, hips[i + 1] - hips[i]);
        if (right.contact || felt.contact)
            force.push_back(glm::length(felt.force - right.force));
        if (!right.contact || !felt.contact)
            continue;
        ++errors.compared;
        position.push_back(glm::length(felt.proxy - right.proxy));
        magnitude.push_back(std::fabs(glm::length(felt.force) - glm::length(right.force)));
        if (felt.force != glm::dvec3(0.0) && right.force != glm::dvec3(0.0))
            direction.push_back(angleBetween(felt.force, right.force));
    }
    errors.position = spreadOf(position);
    errors.forceMagnitude = spreadOf(magnitude);
    errors.forceDirection = spreadOf(direction);
    errors.force = spreadOf(force);
    errors.largestJump = largestJump(ours, truth);
    errors.truthJump = largestJump(truth, truth);
    const auto share = [](uint64_t part, uint64_t whole) {
        return whole > 0 ? static_cast<double>(part) / static_cast<double>(whole) : 0.0;
    };
    errors.contactLost = share(lost, inTruth);
    errors.contactInvented = share(invented, free);
    return errors;
}

} // namespace touchstone::study
