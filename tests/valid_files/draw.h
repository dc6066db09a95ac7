#pragma once
// Random numbers that are the same on every machine and with every library.

#include <cstddef>
#include <cstdint>
#include <vector>

namespace touchstone::test {

/// SplitMix64 (Steele, Lea, Flood: "Fast Splittable Pseudorandom Number Generators", 2014).
class Draw {
  public:
    explicit Draw(uint64_t seed) : state_(seed) {}

    uint64_t bits() {
        uint64_t z = (state_ += 0x9E3779B97F4A7C15ull);
        z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ull;
        z = (z ^ (z >> 27)) * 0x94D049BB133111EBull;
        return z ^ (z >> 31);
    }
    /// In [0, end); `end` > 0.
    size_t below(size_t end) { return static_cast<size_t>(bits() % end); }
    /// In [low, high].
    int between(int low, int high) {
        return low + static_cast<int>(below(static_cast<size_t>(high - low + 1)));
    }
    /// In [low, high).
    double real(double low, double high) {
        return low + (high - low) * (static_cast<double>(bits() >> 11) * 0x1p-53);
    }
    bool chance(double probability) { return real(0.0, 1.0) < probability; }
    template <class T>
    const T& pick(const std::vector<T>& from) {
        return from[below(from.size())];
    }

  private:
    uint64_t state_;
};

} // namespace touchstone::test
