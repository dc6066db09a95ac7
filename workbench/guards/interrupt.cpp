#include "workbench/guards/interrupt.h"

#include <csignal>
#include <initializer_list>

namespace touchstone {

namespace {

constexpr int kMostInterrupts = 3; // the last one kills, should the end hang

volatile std::sig_atomic_t came = 0;

extern "C" void onInterrupt(int signal) {
    came = came + 1;
    if (came + 1 >= kMostInterrupts)
        std::signal(signal, SIG_DFL);
}

} // namespace

void catchInterrupts() {
    for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGQUIT})
        if (std::signal(signal, onInterrupt) == SIG_IGN && signal == SIGHUP)
            std::signal(signal, SIG_IGN); // nohup
}

bool interrupted() noexcept {
    return came != 0;
}

} // namespace touchstone
