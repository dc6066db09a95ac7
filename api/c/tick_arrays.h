#pragma once

#include "haptics/tick/haptic_step.h"
#include "touchstone/touchstone.h"

#include <cstddef>
#include <cstdint>

namespace touchstone::api {

/// What a caller may learn of a tick.
struct TickRow {
    double time = 0.0;
    glm::dvec3 hip{0.0}, proxy{0.0}, normal{0.0}, force{0.0}, command{0.0};
    double penetration = 0.0;
    uint32_t contacts = 0, friction = 0, flags = 0;
    int32_t object = -1, triangle = -1;
    int64_t stepNs = 0;
};
[[nodiscard]] TickRow rowOf(double time, const HapticOutput& output, int64_t stepNs) noexcept;

/// The caller's arrays.
class TickArrays {
  public:
    /// Throws Refused where the struct is no ts_ticks, or its arrays have fewer than `needed` entries. Null:
    /// no arrays.
    TickArrays(const ts_ticks* ticks, size_t needed);

    /// `i` is below the capacity.
    void put(size_t i, const TickRow& row) const noexcept;
    [[nodiscard]] size_t capacity() const { return arrays_.capacity; }
    [[nodiscard]] bool timed() const { return arrays_.step_ns != nullptr; }
    [[nodiscard]] const ts_ticks& arrays() const { return arrays_; }

  private:
    ts_ticks arrays_;
};

} // namespace touchstone::api
