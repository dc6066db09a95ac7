#pragma once
// The place that a contact location display shows on the finger's pad [004].

#include <glm/glm.hpp>

namespace touchstone {

/// What a device says of its contact location display.
struct PadLimits {
    double reach = 0.0; ///< m from the middle of the pad; 0: it has no display
    double rate = 0.0;  ///< m/s
    bool operator==(const PadLimits&) const = default;
};

/// m along the pad (x of the hand's own frame) and across it (z), from its middle. Only the safety stage
/// makes one that is not the middle.
class PadCommand {
  public:
    PadCommand() = default;
    [[nodiscard]] const glm::dvec2& location() const { return location_; }

  private:
    friend class LocationLimiter;
    explicit PadCommand(const glm::dvec2& location) : location_(location) {}
    glm::dvec2 location_{0.0};
};

} // namespace touchstone
