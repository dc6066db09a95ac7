#pragma once

#include "workbench/panels/widgets.h"
#include "workbench/readings/servo_view.h"

namespace touchstone {

/// What a tick costs by stage: a strip of medians above one of 99th percentiles on one scale of µs, the whole
/// budget of the period beneath, and a legend with both figures. Marks "budget" and "budgetLegend".
void drawBudget(const ServoView& servo, Widgets& widgets);

} // namespace touchstone
