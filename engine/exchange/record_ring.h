#pragma once

#include <atomic>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>
#include <type_traits>
#include <vector>

namespace touchstone {

/// Every tick's record from the servo to one reader. When the reader falls behind, records are dropped and
/// counted; the servo never waits. Capacity is allocated at construction.
///
/// Two free-running counters over a power of two of slots (Lamport 1983). A library queue would suffice, but
/// the available ones synchronise by fences, which g++'s thread sanitizer cannot follow: here every hand-over
/// is an acquire that reads a release, so the sanitizer proves it.
template <class Record>
class RecordRing {
    static_assert(std::is_nothrow_copy_assignable_v<Record>,
                  "a record that can throw has no place in the tick");

  public:
    /// `capacity` is rounded up to a power of two, at least 2.
    explicit RecordRing(size_t capacity)
        : slots_(std::bit_ceil(capacity < 2 ? size_t{2} : capacity)), mask_(slots_.size() - 1) {}
    RecordRing(const RecordRing&) = delete;
    RecordRing& operator=(const RecordRing&) = delete;

    /// Writer (servo) thread only.
    void push(const Record& record) noexcept { push(std::span(&record, 1)); }
    /// All of them or none; those that are dropped count as one.
    void push(std::span<const Record> records) noexcept {
        const size_t end = end_.load(std::memory_order_relaxed), count = records.size();
        if (end + count - knownBegin_ > slots_.size()) {
            knownBegin_ = begin_.load(std::memory_order_acquire);
            if (end + count - knownBegin_ > slots_.size()) {
                dropped_.fetch_add(1, std::memory_order_relaxed);
                return;
            }
        }
        for (size_t i = 0; i < count; ++i)
            slots_[(end + i) & mask_] = records[i];
        end_.store(end + count, std::memory_order_release);
    }

    /// Reader thread only.
    bool pop(Record& record) noexcept {
        const size_t begin = begin_.load(std::memory_order_relaxed);
        if (begin == knownEnd_) {
            knownEnd_ = end_.load(std::memory_order_acquire);
            if (begin == knownEnd_)
                return false;
        }
        record = slots_[begin & mask_];
        begin_.store(begin + 1, std::memory_order_release);
        return true;
    }

    /// Any thread.
    [[nodiscard]] uint64_t dropped() const noexcept { return dropped_.load(std::memory_order_relaxed); }
    [[nodiscard]] size_t capacity() const noexcept { return slots_.size(); }

  private:
    std::vector<Record> slots_;
    size_t mask_;
    alignas(64) std::atomic<size_t> end_{0}; // writer's line
    size_t knownBegin_ = 0;
    std::atomic<uint64_t> dropped_{0};
    alignas(64) std::atomic<size_t> begin_{0}; // reader's line
    size_t knownEnd_ = 0;
};

} // namespace touchstone
