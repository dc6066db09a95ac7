#include "workbench/interrupt.h"

#include <csignal>

namespace touchstone {

namespace {

volatile std::sig_atomic_t came = 0;

extern "C" void onInterrupt(int signal) {
    came = 1;
    std::signal(signal, SIG_DFL);
}

} // namespace

void catchInterrupts() {
    std::signal(SIGINT, onInterrupt);
    std::signal(SIGTERM, onInterrupt);
}

bool interrupted() noexcept {
    return came != 0;
}

} // namespace touchstone
