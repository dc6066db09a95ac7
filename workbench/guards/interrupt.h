#pragma once

namespace touchstone {

/// From now on an interrupt (Ctrl-C), a request to terminate or to quit, or a terminal that is closed ends
/// the main loop, so that what was asked for is still written and a device gets zero force. So does a second
/// one; only the third ends the program at once.
void catchInterrupts();

/// Whether one has come. Any thread.
[[nodiscard]] bool interrupted() noexcept;

} // namespace touchstone
