#include "workbench/guards/crash_note.h"

#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>

namespace touchstone {

namespace {

// Double buffer, so that a handler never reads a text being written.
std::array<std::array<char, 1024>, 2> texts;
std::atomic<const char*> current{nullptr};
std::atomic<size_t> length{0};

// Async-signal-safe calls only. The signal is raised again with its default action (SA_RESETHAND).
extern "C" void onCrash(int signal) {
    const char* text = current.load();
    if (text != nullptr) {
        [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, text, length.load());
    }
    raise(signal);
}

void catchCrashes() {
    struct sigaction action {};
    action.sa_handler = onCrash;
    action.sa_flags = static_cast<int>(SA_RESETHAND | SA_NODEFER);
    for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT})
        sigaction(signal, &action, nullptr);
}

} // namespace

void leaveCrashNote(const std::string& note) {
    if (note.empty()) {
        current.store(nullptr);
        return;
    }
    static size_t turn = 0;
    auto& text = texts[turn = 1 - turn];
    const std::string line = "touchstone: crashed; " + note + "\n";
    length.store(std::min(line.size(), text.size()));
    std::copy_n(line.begin(), length.load(), text.begin());
    if (current.exchange(text.data()) == nullptr)
        catchCrashes();
}

} // namespace touchstone
