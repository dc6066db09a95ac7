#include "workbench/guards/interrupt.h"

#include "haptics/servo/force_switch.h"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <initializer_list>
#include <thread>

namespace touchstone {

namespace {

constexpr int kMaxInterrupts = 3; // the last one kills, in case the shutdown hangs

// Handlers run on any thread, concurrently; they may use lock-free data only.
std::atomic<int> came{0}, handling{0};
std::atomic<ForceSwitch*> force{nullptr};
std::atomic<bool> mayHang{false};
static_assert(decltype(came)::is_always_lock_free && decltype(force)::is_always_lock_free &&
              decltype(mayHang)::is_always_lock_free);

extern "C" void onInterrupt(int signal) {
    handling.fetch_add(1);
    if (ForceSwitch* const given = force.load())
        given->takeAway(false);
    handling.fetch_sub(1);
    const int count = came.fetch_add(1) + 1;
    if (count + 1 == kMaxInterrupts && mayHang.load())
        alarm(InterruptedForce::kLastSeconds); // whose signal ends the process
    if (count + 1 >= kMaxInterrupts)
        std::signal(signal, SIG_DFL);
}

} // namespace

void catchInterrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
        if (std::signal(signal, onInterrupt) == SIG_IGN && signal == SIGHUP)
            std::signal(signal, SIG_IGN); // nohup
}

bool interrupted() noexcept {
    return came.load() != 0;
}

InterruptedForce::InterruptedForce(ForceSwitch& given) noexcept {
    mayHang.store(true);
    force.store(&given);
    if (interrupted())
        given.takeAway(false);
}

InterruptedForce::~InterruptedForce() {
    force.store(nullptr);
    while (handling.load() != 0) // on another thread, using the switch
        std::this_thread::yield();
}

} // namespace touchstone
