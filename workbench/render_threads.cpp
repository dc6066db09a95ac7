#include "workbench/render_threads.h"

#include <sched.h>

#include <cstdlib>
#include <string>

namespace touchstone {

void leaveOneCoreToTheServo() {
    cpu_set_t allowed;
    if (sched_getaffinity(0, sizeof allowed, &allowed) != 0)
        return;
    const int cores = CPU_COUNT(&allowed);
    if (cores > 1)
        setenv("LP_NUM_THREADS", std::to_string(cores - 1).c_str(), 0);
}

} // namespace touchstone
