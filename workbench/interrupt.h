#pragma once

namespace touchstone {

/// From now on an interrupt (Ctrl-C) or a request to terminate ends the main loop, so that what was asked for
/// is still written. A second one ends the program at once.
void catchInterrupts();

/// Whether one has come. Any thread.
[[nodiscard]] bool interrupted() noexcept;

} // namespace touchstone
