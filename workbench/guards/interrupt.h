#pragma once

namespace touchstone {

class ForceSwitch;

/// From now on an interrupt (Ctrl-C), a request to terminate or to quit, or a closed terminal ends the main
/// loop, so that requested output is still written and a device receives zero force. So does a second one;
/// only the third ends the program at once.
void catchInterrupts();

/// True after an interrupt. Any thread.
[[nodiscard]] bool interrupted() noexcept;

/// For a main loop that may block in rendering while a force is active. During its lifetime the first
/// interrupt switches the force off in its handler, whatever the main loop does. From its construction on,
/// for the rest of the process, the second gives the program kLastSeconds to shut down and then ends it: by
/// that time a device has had zero force for long. One at a time; after catchInterrupts.
class InterruptedForce {
  public:
    static constexpr unsigned kLastSeconds = 2;

    explicit InterruptedForce(ForceSwitch& force) noexcept;
    ~InterruptedForce();
    InterruptedForce(const InterruptedForce&) = delete;
    InterruptedForce& operator=(const InterruptedForce&) = delete;
};

} // namespace touchstone
