#pragma once

#include <string>

namespace touchstone {

/// Sets the text that a crashing process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) prints on stderr before
/// the signal's default action; empty: none. Main thread.
void leaveCrashNote(const std::string& note);

} // namespace touchstone
