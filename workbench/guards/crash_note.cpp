#include "workbench/guards/crash_note.h"

#include <execinfo.h>
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

constexpr int kFrames = 48;
constexpr unsigned kPatience = 2; // s

// Async-signal-safe calls only, but for the unwinder, which takes the loader's lock: where the crash holds it
// an alarm ends the process. The signal is raised again with its default action (SA_RESETHAND).
extern "C" void onCrash(int signal) {
    const char* text = current.load();
    if (text != nullptr) {
        [[maybe_unused]] const ssize_t ignored = write(STDERR_FILENO, text, length.load());
    }
    ::signal(SIGALRM, SIG_DFL);
    alarm(kPatience);
    std::array<void*, kFrames> frames{};
    const int found = backtrace(frames.data(), kFrames);
    backtrace_symbols_fd(frames.data(), found, STDERR_FILENO);
    raise(signal);
}

void catchCrashes() {
    void* frame = nullptr;
    backtrace(&frame, 1); // loads the unwinder, which a handler must not do
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
