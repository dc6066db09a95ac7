#pragma once

#include <string>

namespace touchstone {

/// What a process that crashes (a signal that is nobody's wish: SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT)
/// says on stderr before it dies as it would have; empty: nothing any more. Main thread.
void leaveCrashNote(const std::string& note);

} // namespace touchstone
