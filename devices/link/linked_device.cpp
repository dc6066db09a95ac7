#include "devices/link/linked_device.h"

#include <pthread.h>
#include <sched.h>

namespace touchstone {

void LinkMonitor::connected(const std::string& where) {
    const std::lock_guard lock(mutex_);
    state_ = LinkState::Connected;
    problem_.clear();
    where_ = where;
    count(connects);
}

void LinkMonitor::disconnected(LinkState state, const std::string& problem) {
    const std::lock_guard lock(mutex_);
    state_ = state;
    problem_ = problem;
}

LinkReport LinkMonitor::report() const {
    const std::lock_guard lock(mutex_);
    const auto value = [](const Counter& counter) { return counter.load(std::memory_order_relaxed); };
    return {.state = state_,
            .problem = problem_,
            .where = where_,
            .reports = value(reports),
            .ignored = value(ignored),
            .malformed = value(malformed),
            .repeated = value(repeated),
            .lost = value(lost),
            .sent = value(sent),
            .sendFailures = value(sendFailures),
            .connects = value(connects),
            .realtime = realtime.load(std::memory_order_relaxed)};
}

bool enterIoPriority() noexcept {
    constexpr int kBelowServo = 70; // the servo requests 80
    sched_param parameters{};
    parameters.sched_priority = kBelowServo;
    return pthread_setschedparam(pthread_self(), SCHED_FIFO, &parameters) == 0;
}

} // namespace touchstone
