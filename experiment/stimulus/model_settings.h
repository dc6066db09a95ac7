#pragma once

#include "experiment/plan/study_plan.h"
#include "haptics/settings/haptic_settings.h"

namespace touchstone::experiment {

/// The settings with which a condition's reference or comparison, a model, is touched; `level` is of the
/// comparison's varied setting. Throws Error for a value that the setting does not take.
[[nodiscard]] HapticSettings settingsOf(const Condition& condition, bool reference, double level);

} // namespace touchstone::experiment
