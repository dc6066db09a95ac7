#pragma once
// Nodes by increasing distance; those at equal distances by increasing number.

#include <algorithm>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

namespace touchstone {

/// A heap for each eighth of a voxel, so that each is small: distances come and go at about the least one.
/// Keeps its memory.
class NodeQueue {
  public:
    struct Entry {
        float distance;
        uint32_t node;
    };
    [[nodiscard]] bool empty() const noexcept { return count_ == 0; }
    /// `distance`: not negative, and not -0.
    void push(const Entry& entry) {
        // The bits of such floats have the order of the floats.
        const uint64_t key = uint64_t{std::bit_cast<uint32_t>(entry.distance)} << 32 | entry.node;
        const size_t of = entry.distance < kMostVoxels
                              ? static_cast<size_t>(entry.distance * static_cast<float>(kHeapsInVoxel))
                              : kHeaps - 1;
        std::vector<uint64_t>& heap = heaps_[of];
        heap.push_back(key);
        std::push_heap(heap.begin(), heap.end(), std::greater());
        least_ = std::min(least_, of);
        ++count_;
    }
    /// Not of an empty queue.
    Entry pop() {
        while (heaps_[least_].empty())
            ++least_;
        std::vector<uint64_t>& heap = heaps_[least_];
        std::pop_heap(heap.begin(), heap.end(), std::greater());
        const uint64_t key = heap.back();
        heap.pop_back();
        --count_;
        return {std::bit_cast<float>(static_cast<uint32_t>(key >> 32)), static_cast<uint32_t>(key)};
    }
    void clear() noexcept {
        for (std::vector<uint64_t>& heap : heaps_)
            heap.clear();
        count_ = 0;
        least_ = kHeaps - 1;
    }

  private:
    static constexpr size_t kHeapsInVoxel = 8, kHeaps = 512;
    static constexpr float kMostVoxels = static_cast<float>((kHeaps - 1) / kHeapsInVoxel);
    std::vector<std::vector<uint64_t>> heaps_ = std::vector<std::vector<uint64_t>>(kHeaps);
    size_t least_ = kHeaps - 1; ///< those before are empty
    size_t count_ = 0;
};

} // namespace touchstone
