#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace touchstone {

/// The stages of a tick in order (docs/architecture.md, One tick).
enum class Stage : uint8_t { Sample, Contact, Proxy, Shading, Texture, Friction, Force, Safety };
inline constexpr size_t kStageCount = 8;
inline constexpr std::array<std::string_view, kStageCount> kStageNames{
    "sample", "contact", "proxy", "shading", "texture", "friction", "force", "safety"};

/// Compiles to nothing.
struct NoStopwatch {
    void start() noexcept {}
    void hand(size_t) noexcept {}
    void lap(Stage) noexcept {}
};

/// Nanoseconds per stage of the last step, of all hands together, for studies and benchmarks. Reading the
/// clock costs 20..30 ns a lap.
struct StageStopwatch {
    std::array<int64_t, kStageCount> nanoseconds{};

    void start() noexcept {
        nanoseconds.fill(0);
        last_ = std::chrono::steady_clock::now();
    }
    void hand(size_t) noexcept {}
    void lap(Stage stage) noexcept {
        const auto now = std::chrono::steady_clock::now();
        nanoseconds[static_cast<size_t>(stage)] += (now - last_).count();
        last_ = now;
    }

  private:
    std::chrono::steady_clock::time_point last_;
};

/// Nanoseconds from the start of the last step to the end of one stage, of the last hand. Reading the clock
/// at every stage keeps the processor from overlapping consecutive stages, which costs some 10 ns each beside
/// the reading. A study therefore reads it at one stage a tick and obtains each stage as a difference between
/// ticks.
struct SplitStopwatch {
    Stage until = Stage::Safety;
    int64_t nanoseconds = 0;

    void start() noexcept { begin_ = std::chrono::steady_clock::now(); }
    void hand(size_t) noexcept {}
    void lap(Stage stage) noexcept {
        if (stage == until)
            nanoseconds = (std::chrono::steady_clock::now() - begin_).count();
    }

  private:
    std::chrono::steady_clock::time_point begin_;
};

} // namespace touchstone
