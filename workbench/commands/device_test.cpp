#include "workbench/commands/device_test.h"

#include "haptics/safety/force_limiter.h"
#include "haptics/servo/realtime_thread.h"
#include "workbench/guards/interrupt.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cmath>
#include <cstdarg>
#include <cstdio>

namespace touchstone {

namespace {

constexpr double kTick = 1e-3;     // s
constexpr double kPushTime = 0.5;  // s along each axis and back
constexpr double kForceRise = 0.1; // s, rise of the force

/// x, -x, y, -y, z, -z in turn.
glm::dvec3 pushAt(double time, double force) {
    const auto turn = static_cast<int>(time / kPushTime) % 6;
    glm::dvec3 push(0.0);
    push[turn / 2] = turn % 2 == 0 ? force : -force;
    return push;
}

double share(const std::vector<double>& sorted, double fraction) {
    return sorted.empty() ? 0.0
                          : sorted[static_cast<size_t>(fraction * static_cast<double>(sorted.size() - 1))];
}

[[gnu::format(printf, 2, 3)]] void add(std::string& text, const char* format, ...) {
    char line[256];
    va_list arguments;
    va_start(arguments, format);
    std::vsnprintf(line, sizeof line, format, arguments);
    va_end(arguments);
    text += line;
}

unsigned long long number(uint64_t value) {
    return value;
}

} // namespace

const char* stateName(LinkState state) {
    switch (state) {
    case LinkState::Searching:
        return "searching";
    case LinkState::Refused:
        return "refused";
    case LinkState::Connected:
        return "connected";
    }
    return "";
}

DeviceTestFigures testDevice(LinkedDevice& device, double seconds, double force) {
    DeviceTestFigures figures;
    SafetyInputs safety{.limits = device.limits(), .dt = kTick, .forceEnabled = force > 0.0};
    safety.limits.maxForce = std::min(safety.limits.maxForce, force);
    safety.limits.maxForceRate = safety.limits.maxForce / kForceRise;
    ForceLimiterState limiter;
    const auto period = static_cast<long long>(1e9 * kTick);
    const long long start = monotonicNs();
    const auto ticks = static_cast<uint64_t>(seconds / kTick);
    for (; figures.ticks < ticks && !interrupted(); ++figures.ticks) {
        sleepUntil(start + static_cast<long long>(figures.ticks) * period);
        const double time = kTick * static_cast<double>(figures.ticks);
        const DeviceSample sample = device.sample(time);
        safety.inputValid = sample.valid;
        safety.sampleAge = sample.age;
        uint32_t flags = 0;
        const DeviceCommand command =
            ForceLimiter::limit(pushAt(time, force), glm::dvec3(0.0), safety, {}, limiter, flags);
        if (force > 0.0) // without an order its I/O thread keeps the force at zero
            device.apply(command);
        figures.ordered = std::max(figures.ordered, glm::length(command.force()));
        if (!sample.valid)
            continue;
        const bool first = figures.validTicks++ == 0;
        figures.staleTicks += sample.age > safety.limits.staleAge ? 1 : 0;
        figures.ages.push_back(sample.age);
        figures.last = sample.position;
        figures.low = first ? sample.position : glm::min(figures.low, sample.position);
        figures.high = first ? sample.position : glm::max(figures.high, sample.position);
        figures.buttonsSeen |= sample.buttons;
    }
    device.apply(DeviceCommand{});
    figures.seconds = 1e-9 * static_cast<double>(monotonicNs() - start);
    std::sort(figures.ages.begin(), figures.ages.end());
    figures.report = device.report();
    return figures;
}

std::string describe(const DeviceTestFigures& figures, const LinkedDevice& device) {
    const LinkReport& report = figures.report;
    std::string text;
    add(text, "%s: %s%s%s\n", device.name().c_str(), stateName(report.state),
        report.where.empty() ? "" : " at ", report.where.c_str());
    if (!report.problem.empty())
        text += "  " + report.problem + "\n";
    add(text,
        "  reports    %llu in %.1f s (%.0f a second), %llu malformed, %llu repeated, %llu lost, %llu "
        "ignored\n",
        number(report.reports), figures.seconds, static_cast<double>(report.reports) / figures.seconds,
        number(report.malformed), number(report.repeated), number(report.lost), number(report.ignored));
    add(text, "  link       connected %llu times, I/O thread %s\n", number(report.connects),
        report.realtime ? "SCHED_FIFO" : "at normal priority (SCHED_FIFO was denied)");
    if (figures.validTicks > 0) {
        add(text,
            "  age        p50 %.2f ms, p99 %.2f ms, largest %.2f ms; stale (over %.0f ms) in %llu of %llu "
            "ticks\n",
            1e3 * share(figures.ages, 0.5), 1e3 * share(figures.ages, 0.99), 1e3 * figures.ages.back(),
            1e3 * device.limits().staleAge, number(figures.staleTicks), number(figures.validTicks));
        for (int axis = 0; axis < 3; ++axis)
            add(text, "  %c          %.2f mm to %.2f mm, now %.2f mm\n", "xyz"[axis], 1e3 * figures.low[axis],
                1e3 * figures.high[axis], 1e3 * figures.last[axis]);
        add(text, "  buttons    %08x\n", figures.buttonsSeen);
    }
    add(text, "  no sample  in %llu of %llu ticks\n", number(figures.ticks - figures.validTicks),
        number(figures.ticks));
    add(text, "  force      %.2f N at most; %llu commands, %llu failed\n", figures.ordered,
        number(report.sent), number(report.sendFailures));
    return text;
}

nlohmann::ordered_json toJson(const DeviceTestFigures& figures, const LinkedDevice& device) {
    const LinkReport& report = figures.report;
    const auto vector = [](const glm::dvec3& v) { return nlohmann::ordered_json{v.x, v.y, v.z}; };
    return {{"command", "devices"},
            {"device", device.name()},
            {"link", linkJson(report)},
            {"seconds", figures.seconds},
            {"ticks", figures.ticks},
            {"valid_ticks", figures.validTicks},
            {"stale_ticks", figures.staleTicks},
            {"age_p50_s", share(figures.ages, 0.5)},
            {"age_p99_s", share(figures.ages, 0.99)},
            {"age_max_s", share(figures.ages, 1.0)},
            {"low", vector(figures.low)},
            {"high", vector(figures.high)},
            {"last", vector(figures.last)},
            {"buttons_seen", figures.buttonsSeen},
            {"force_n", figures.ordered}};
}

nlohmann::ordered_json linkJson(const LinkReport& report) {
    return {{"state", stateName(report.state)},
            {"problem", report.problem},
            {"where", report.where},
            {"reports", report.reports},
            {"ignored", report.ignored},
            {"malformed", report.malformed},
            {"repeated", report.repeated},
            {"lost", report.lost},
            {"sent", report.sent},
            {"send_failures", report.sendFailures},
            {"connects", report.connects},
            {"realtime", report.realtime}};
}

} // namespace touchstone
