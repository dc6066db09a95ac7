#pragma once

#include "api/c/tick_arrays.h"
#include "api/c/touched_scene.h"
#include "haptics/tick/stepped_hand.h"

#include <memory>
#include <mutex>
#include <string_view>

namespace touchstone::api {

/// What a ts_hand names: a hand that is stepped along paths, one after the other.
class OfflineHand final : public Object {
  public:
    OfflineHand(std::shared_ptr<TouchedScene> scene, const HapticSettings& settings);

    /// Throws Refused.
    void set(std::string_view name, std::string_view value);
    /// Checks the whole path, then touches. Returns the ticks made: fewer than path.count where its progress
    /// function stopped it. Throws Refused, and then no tick was made.
    size_t touch(const ts_path& path, const TickArrays& ticks);

  private:
    /// Time and length of tick `i` of a path.
    struct Moment {
        double time, dt;
    };
    [[nodiscard]] Moment moment(const ts_path& path, size_t i) const noexcept;
    void check(const ts_path& path) const;

    std::mutex mutex_;
    std::shared_ptr<TouchedScene> scene_;
    HapticSettings settings_;
    SteppedHand hand_;
    // Of the ticks made:
    bool begun_ = false;
    double last_ = 0.0; // s
    // Ticks of a path without times are at base_ + (number + i) / rate_.
    double base_ = 0.0, rate_ = 0.0;
    size_t number_ = 0;
};

} // namespace touchstone::api
