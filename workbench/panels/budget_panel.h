#pragma once

#include "workbench/panels/widgets.h"
#include "workbench/readings/servo_view.h"

namespace touchstone {

/// Time of a tick by stage: a strip of medians above one of 99th percentiles on a common scale in µs, the
/// budget of the period beneath, and a legend with both figures. Marks "budget" and "budgetLegend".
void drawBudget(const ServoView& servo, Widgets& widgets);

} // namespace touchstone
