#pragma once

#include "api/c/tick_arrays.h"
#include "api/c/touched_scene.h"
#include "haptics/tick/stepped_hands.h"

#include <memory>
#include <mutex>
#include <span>
#include <string>
#include <string_view>

namespace touchstone::api {

/// `hands`. Throws Refused where there are not 1..kMaxHands.
size_t checkedHands(size_t hands);

/// What a ts_hand names: hands in one world that are stepped along paths, one after the other.
class OfflineHand final : public Object {
  public:
    /// Throws Refused where there are not 1..kMaxHands.
    OfflineHand(std::shared_ptr<TouchedScene> scene, const HapticSettings& settings, size_t hands);

    /// Throws Refused.
    void set(std::string_view name, std::string_view value);
    /// Checks the whole paths, then touches. Returns the ticks made: fewer than their count where the first
    /// one's progress function stopped it. Throws Refused, and then no tick was made.
    size_t touch(std::span<const ts_path> paths, std::span<const TickArrays> ticks);

  private:
    /// Time and length of tick `i` of a path.
    struct Moment {
        double time, dt;
    };
    [[nodiscard]] Moment moment(const ts_path& path, size_t i) const noexcept;
    int64_t tick(std::span<const ts_path> paths, size_t i, double time, double dt, bool timed) noexcept;
    void check(const ts_path& path, const std::string& name) const;
    void check(std::span<const ts_path> paths) const;

    std::mutex mutex_;
    std::shared_ptr<TouchedScene> scene_;
    HapticSettings settings_;
    SteppedHands hands_;
    std::vector<StageTrace> traces_; ///< one a hand
    // Of the ticks made:
    bool begun_ = false;
    double last_ = 0.0; // s
    // Ticks of a path without times are at base_ + (number + i) / rate_.
    double base_ = 0.0, rate_ = 0.0;
    size_t number_ = 0;
};

} // namespace touchstone::api
