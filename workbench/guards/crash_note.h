#pragma once

#include <string>

namespace touchstone {

/// Sets the text that a crashing process (SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT) prints on stderr before
/// the signal's default action, with the calls that led there (module and offset, for addr2line); empty: the
/// calls alone. Main thread.
void leaveCrashNote(const std::string& note);

} // namespace touchstone
