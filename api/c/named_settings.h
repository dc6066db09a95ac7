#pragma once

#include "api/c/handles.h"
#include "haptics/settings/haptic_settings.h"

#include <mutex>
#include <string>
#include <string_view>

namespace touchstone::api {

/// What a ts_settings names.
class NamedSettings final : public Object {
  public:
    /// Throws Refused.
    void set(std::string_view name, std::string_view value);
    [[nodiscard]] HapticSettings get() const;

  private:
    mutable std::mutex mutex_;
    HapticSettings settings_;
};

/// Null: the start values.
[[nodiscard]] HapticSettings settingsOf(ts_settings settings);

} // namespace touchstone::api
