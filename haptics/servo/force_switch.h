#pragma once
// Switches the force off from any thread, without a lock.

#include <atomic>
#include <cstdint>

namespace touchstone {

/// Whether the force is off, with counts of the requests. The owner switches it on again only in the state
/// that it has read, so that a key press in between is never overridden.
class ForceSwitch {
  public:
    /// A snapshot. Presses count modulo 2^31, all requests modulo 2^32.
    struct State {
        uint64_t word = 0;
        [[nodiscard]] bool off() const noexcept { return (word & 1) != 0; }
        [[nodiscard]] uint32_t presses() const noexcept {
            return static_cast<uint32_t>(word >> 1) & 0x7fffffffu;
        }
        [[nodiscard]] uint32_t asked() const noexcept { return static_cast<uint32_t>(word >> 32); }
        [[nodiscard]] State givenBack() const noexcept { return {word & ~uint64_t{1}}; }
        bool operator==(const State&) const = default;
    };

    /// Any thread: the target of the force is zero from the next tick on. `press`: the request comes from the
    /// key that also restores the force, and is counted as a press.
    void takeAway(bool press) noexcept {
        uint64_t old = word_.load(std::memory_order_relaxed);
        while (!word_.compare_exchange_weak(old, after(old, press), std::memory_order_release,
                                            std::memory_order_relaxed)) {
        }
    }
    /// Owner thread: false, and still off, where another request came after `seen`.
    bool giveBack(const State& seen) noexcept {
        uint64_t expected = seen.word;
        return word_.compare_exchange_strong(expected, seen.givenBack().word, std::memory_order_release,
                                             std::memory_order_relaxed);
    }
    [[nodiscard]] State state() const noexcept { return {word_.load(std::memory_order_acquire)}; }
    [[nodiscard]] bool off() const noexcept { return state().off(); }

  private:
    /// Bit 0: off; 1 to 31: presses; 32 to 63: all requests.
    static constexpr uint64_t after(uint64_t word, bool press) noexcept {
        const uint64_t presses = ((word >> 1) + (press ? 1 : 0)) & 0x7fffffffu;
        return ((word >> 32) + 1) << 32 | presses << 1 | 1;
    }
    std::atomic<uint64_t> word_{0};
};

} // namespace touchstone
