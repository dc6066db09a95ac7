#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>

#include <readerwriterqueue/readerwriterqueue.h>

namespace touchstone {

/// Every tick's record from the servo to one reader. When the reader falls behind, records are dropped and
/// counted, never waited for. Capacity is allocated up front.
template <class Record>
class RecordRing {
  public:
    explicit RecordRing(size_t capacity) : queue_(capacity) {}

    /// Servo thread only.
    void push(const Record& record) noexcept {
        if (!queue_.try_enqueue(record)) dropped_.fetch_add(1, std::memory_order_relaxed);
    }
    /// Reader thread only.
    bool pop(Record& record) noexcept { return queue_.try_dequeue(record); }
    /// Any thread.
    [[nodiscard]] uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }

  private:
    moodycamel::ReaderWriterQueue<Record> queue_;
    std::atomic<uint64_t> dropped_{0};
};

} // namespace touchstone
