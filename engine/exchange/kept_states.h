#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace touchstone {

/// States of many bytes before some ticks, from the servo to one reader, in order. The servo never waits:
/// where the reader falls behind by kCount, a state is dropped. `resize` before either thread begins.
class KeptStates {
  public:
    static constexpr size_t kCount = 8;

    /// Bytes of the largest state. Allocates.
    void resize(size_t capacity) {
        for (State& state : states_)
            state.bytes.resize(capacity);
    }
    /// Servo: `save(bytes)` writes the state before `tick` and returns its size. False where it is dropped.
    template <class Save>
    bool keep(uint64_t tick, const Save& save) noexcept {
        State& state = states_[next_];
        if (state.full.load(std::memory_order_acquire))
            return false;
        state.tick = tick;
        state.size = save(std::span<std::byte>(state.bytes));
        state.full.store(true, std::memory_order_release);
        next_ = (next_ + 1) % kCount;
        return true;
    }
    /// The reader: the next state; false where there is none.
    bool take(uint64_t& tick, std::vector<std::byte>& bytes) {
        State& state = states_[taken_];
        if (!state.full.load(std::memory_order_acquire))
            return false;
        tick = state.tick;
        bytes.assign(state.bytes.begin(), state.bytes.begin() + static_cast<ptrdiff_t>(state.size));
        state.full.store(false, std::memory_order_release);
        taken_ = (taken_ + 1) % kCount;
        return true;
    }

  private:
    struct State {
        std::atomic<bool> full{false};
        uint64_t tick = 0;
        size_t size = 0;
        std::vector<std::byte> bytes;
    };
    std::array<State, kCount> states_;
    size_t next_ = 0, taken_ = 0; // the servo's, the reader's
};

} // namespace touchstone
