#include "workbench/figures/ui_scale.h"

#include <algorithm>
#include <charconv>
#include <cmath>

namespace touchstone {

namespace {

constexpr float kScaleStep = 0.25f;

/// In steps, so that the fonts are not rebuilt at every width of a window that is being resized.
float stepsBelow(float scale) {
    return kScaleStep * std::floor(scale / kScaleStep + 1e-3f);
}

} // namespace

float fittingScale(float wanted, float monitor, const glm::vec2& window) {
    const float scale = clampedUiScale(wanted) * std::max(1.0f, monitor);
    const float most = std::min(window.x / kMinLayout.x, window.y / kMinLayout.y);
    return scale <= most ? scale : std::clamp(stepsBelow(most), kMinUiScale, scale);
}

float steppedUiScale(float scale, int direction) {
    const float steps = scale / kScaleStep;
    const float next = direction > 0 ? std::floor(steps + 1e-3f) + 1.0f : std::ceil(steps - 1e-3f) - 1.0f;
    return clampedUiScale(next * kScaleStep);
}

float clampedUiScale(double scale) {
    return std::isnan(scale) ? 1.0f
                             : static_cast<float>(std::clamp(scale, static_cast<double>(kMinUiScale),
                                                             static_cast<double>(kMaxUiScale)));
}

std::string readUiScale(std::string_view text, float& scale) {
    double value = 0.0;
    const auto read = std::from_chars(text.data(), text.data() + text.size(), value);
    // Written so that NaN is refused, too.
    if (read.ec != std::errc{} || read.ptr != text.data() + text.size() ||
        !(value >= static_cast<double>(kMinUiScale) && value <= static_cast<double>(kMaxUiScale)))
        return "'" + std::string(text) + "' is not a UI scale; write a number from 0.75 to 4";
    scale = static_cast<float>(value);
    return {};
}

} // namespace touchstone
