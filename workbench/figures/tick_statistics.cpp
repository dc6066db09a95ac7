#include "workbench/figures/tick_statistics.h"

#include "haptics/query/surface_distance.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <string_view>
#include <utility>

namespace touchstone {

namespace {

constexpr std::array<std::pair<TickFlag, std::string_view>, 18> kFlagNames{{
    {TickFlag::InputInvalid, "input_invalid"},
    {TickFlag::StartedInside, "started_inside"},
    {TickFlag::BudgetReached, "budget_reached"},
    {TickFlag::Jammed, "pinched"},
    {TickFlag::ObjectJumped, "object_jumped"},
    {TickFlag::DeformationHeld, "deformation_held"},
    {TickFlag::CandidatesFull, "candidates_full"},
    {TickFlag::ShadingNotConverged, "shading_not_converged"},
    {TickFlag::TiltCompressed, "tilt_compressed"},
    {TickFlag::ForceLimited, "force_limited"},
    {TickFlag::ForceFault, "force_fault"},
    {TickFlag::Teleported, "teleported"},
    {TickFlag::ForceRamping, "force_ramping"},
    {TickFlag::SafetyLatched, "safety_latched"},
    {TickFlag::NeighbourhoodMissing, "neighbourhood_missing"},
    {TickFlag::EnergyGiven, "energy_given"},
    {TickFlag::EnergyDamped, "energy_damped"},
    {TickFlag::ProgramFailed, "program_failed"},
}};

nlohmann::ordered_json nanoseconds(const Samples& samples) {
    return {{"count", samples.count()},
            {"p50_ns", samples.percentile(0.5)},
            {"p99_ns", samples.percentile(0.99)},
            {"p999_ns", samples.percentile(0.999)},
            {"max_ns", samples.most()}};
}

} // namespace

std::vector<uint64_t> histogramOf(const Samples& samples) {
    std::array<int64_t, kHistogramEndsUs.size()> ends{};
    std::transform(kHistogramEndsUs.begin(), kHistogramEndsUs.end(), ends.begin(),
                   [](int64_t us) { return 1000 * us; });
    return samples.histogram(ends);
}

nlohmann::ordered_json histogramJson(const Samples& samples) {
    nlohmann::ordered_json to(kHistogramEndsUs);
    to.push_back(nullptr);
    return {{"to_us", std::move(to)}, {"ticks", histogramOf(samples)}};
}

void TickStatistics::addLive(const TickRecord& record) {
    // Records were dropped, or the loop stalled: the hand's motion in between is unknown.
    if (record.step != nextStep_ || record.tick == 0) {
        work_.gap();
        commandWork_.gap();
        lastWakeNs_ = -1;
    }
    nextStep_ = record.step + 1;
    wake_.add(record.wakeLatencyNs);
    const int64_t wokeNs = static_cast<int64_t>(std::llround(record.time * 1e9)) + record.wakeLatencyNs;
    if (lastWakeNs_ >= 0)
        period_.add(wokeNs - lastWakeNs_);
    lastWakeNs_ = wokeNs;
    if (record.output.contacts > 0)
        for (size_t i = 0; i < kStageCount; ++i)
            stages_[i].add(record.stageNs[i]);
    add(record.output, record.stepNs);
}

void TickStatistics::add(const HapticOutput& output, int64_t stepNs) {
    ++ticks_;
    step_.add(stepNs);
    work_.add(output.force, output.hip);
    balance_ = output.energyBalance;
    maxBalance_ = std::max(maxBalance_, balance_);
    commandWork_.add(output.commandInWorkspace, output.hip);
    for (size_t i = 0; i < kFlagCount; ++i)
        if (has(output.flags, kFlagNames[i].first))
            ++flags_[i];
    if (output.contacts == 0)
        return;
    ++contactTicks_;
    stepInContact_.add(stepNs);
    const double force = glm::length(output.force);
    forceSum_ += force;
    maxForce_ = std::max(maxForce_, force);
    maxPenetration_ = std::max(maxPenetration_, output.penetration);
}

void TickStatistics::addProxyGap(double gap) {
    constexpr double kOnMesh = 1e-6;
    ++gaps_;
    if (std::abs(gap) <= kOnMesh)
        ++gapsWithinMicrometre_;
    maxGap_ = std::max(maxGap_, std::abs(gap));
}

nlohmann::ordered_json TickStatistics::stepJson() const {
    const bool contact = !stepInContact_.empty();
    nlohmann::ordered_json json = nanoseconds(contact ? stepInContact_ : step_);
    json["over"] = contact ? "ticks in contact" : "all ticks: none was in contact";
    json["all"] = nanoseconds(step_);
    return json;
}

nlohmann::ordered_json TickStatistics::stagesJson() const {
    nlohmann::ordered_json json;
    for (size_t i = 0; i < kStageCount; ++i)
        json[std::string(kStageNames[i])] = {{"mean_ns", stages_[i].mean()},
                                             {"p50_ns", stages_[i].percentile(0.5)},
                                             {"p99_ns", stages_[i].percentile(0.99)}};
    return json;
}

nlohmann::ordered_json TickStatistics::wakeJson() const {
    const auto us = [&](double share) { return static_cast<double>(wake_.percentile(share)) * 1e-3; };
    return {{"p50_us", us(0.5)},
            {"p99_us", us(0.99)},
            {"p999_us", us(0.999)},
            {"max_us", static_cast<double>(wake_.most()) * 1e-3},
            {"period_p50_us", static_cast<double>(period_.percentile(0.5)) * 1e-3}};
}

nlohmann::ordered_json TickStatistics::contactJson() const {
    nlohmann::ordered_json json{
        {"ticks", contactTicks_},
        {"share", ticks_ > 0 ? static_cast<double>(contactTicks_) / static_cast<double>(ticks_) : 0.0},
        {"max_penetration_m", maxPenetration_},
        {"proxy_on_mesh_share", nullptr},
        {"max_proxy_gap_m", nullptr},
    };
    if (gaps_ > 0) {
        json["proxy_on_mesh_share"] = static_cast<double>(gapsWithinMicrometre_) / static_cast<double>(gaps_);
        json["max_proxy_gap_m"] = maxGap_;
    }
    return json;
}

nlohmann::ordered_json TickStatistics::forceJson() const {
    return {{"mean_n", contactTicks_ > 0 ? forceSum_ / static_cast<double>(contactTicks_) : 0.0},
            {"max_n", maxForce_}};
}

nlohmann::ordered_json TickStatistics::energyJson() const {
    return {{"given_j", work_.given()},
            {"law_j", work_.law()},
            {"sampling_j", work_.given() - work_.law()},
            {"command_given_j", commandWork_.given()},
            {"balance_j", balance_},
            {"most_balance_j", maxBalance_},
            {"gaps", work_.gaps()}};
}

nlohmann::ordered_json TickStatistics::flagsJson() const {
    nlohmann::ordered_json json;
    for (size_t i = 0; i < kFlagCount; ++i)
        json[std::string(kFlagNames[i].second)] = flags_[i];
    return json;
}

double proxyGap(const HapticScene& scene, ObjectMotions motions, const HapticOutput& output,
                const HapticSettings& settings) {
    constexpr double kLookedAt = 1e-3;
    return surfaceDistance(scene, motions, output.proxy, feltRadius(settings) + kLookedAt) -
           feltRadius(settings);
}

} // namespace touchstone
