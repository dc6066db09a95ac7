#include "study/timing/clock_cost.h"

#include "engine/time/samples.h"
#include "haptics/servo/realtime_thread.h"

namespace touchstone {

int64_t clockCostNs() {
    Samples costs;
    for (int i = 0; i < 1000; ++i) {
        const long long begin = monotonicNs();
        costs.add(monotonicNs() - begin);
    }
    return costs.percentile(0.5);
}

} // namespace touchstone
