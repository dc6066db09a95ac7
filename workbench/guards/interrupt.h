#pragma once

namespace touchstone {

class ForceSwitch;

/// From now on an interrupt (Ctrl-C), a request to terminate or to quit, or a terminal that is closed ends
/// the main loop, so that what was asked for is still written and a device gets zero force. So does a second
/// one; only the third ends the program at once.
void catchInterrupts();

/// Whether one has come. Any thread.
[[nodiscard]] bool interrupted() noexcept;

/// For a main loop that may hang in what draws while a force is given. While it lives the first interrupt
/// takes the force away in its handler, whatever the main loop does. From its construction on, for the rest
/// of the process, the second gives the program kLastSeconds to come to its end, and ends it then: by that
/// time a device has had zero force for long. One at a time; after catchInterrupts.
class InterruptedForce {
  public:
    static constexpr unsigned kLastSeconds = 2;

    explicit InterruptedForce(ForceSwitch& force) noexcept;
    ~InterruptedForce();
    InterruptedForce(const InterruptedForce&) = delete;
    InterruptedForce& operator=(const InterruptedForce&) = delete;
};

} // namespace touchstone
