#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <type_traits>

namespace touchstone {

/// Wait-free hand-over of the newest value from one writer thread to one reader thread. Older values that
/// were never read are lost, as intended for settings and snapshots. No allocation after construction.
template <class T>
class TripleBuffer {
  public:
    explicit TripleBuffer(const T& initial = T{}) : slots_{Slot{initial}, Slot{initial}, Slot{initial}} {}

    /// Writer thread only.
    void write(const T& value) noexcept {
        static_assert(std::is_nothrow_copy_assignable_v<T>,
                      "a value that can throw has no place in the tick");
        back() = value;
        publish();
    }
    /// Writer thread only: what `publish` hands over, for a value that is changed in place. It holds an older
    /// one.
    [[nodiscard]] T& back() noexcept { return slots_[writing_].value; }
    void publish() noexcept {
        const uint8_t previous =
            middle_.exchange(static_cast<uint8_t>(writing_ | kFresh), std::memory_order_acq_rel);
        writing_ = previous & kIndex;
    }

    /// Reader thread only. True if a newer value than at the last call has arrived.
    bool update() noexcept {
        if ((middle_.load(std::memory_order_relaxed) & kFresh) == 0)
            return false;
        const uint8_t previous = middle_.exchange(reading_, std::memory_order_acq_rel);
        reading_ = previous & kIndex;
        return true;
    }

    /// Reader thread only; valid until the next `update`.
    [[nodiscard]] const T& value() const noexcept { return slots_[reading_].value; }

  private:
    static constexpr uint8_t kIndex = 3, kFresh = 4;
    struct alignas(64) Slot {
        T value;
    };
    std::array<Slot, 3> slots_;
    alignas(64) std::atomic<uint8_t> middle_{1};
    alignas(64) uint8_t writing_ = 0;
    alignas(64) uint8_t reading_ = 2;
};

} // namespace touchstone
