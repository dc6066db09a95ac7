// contact_rate: the stiffest stable wall over the rate of contact, with control at that rate and with control
// at 4 kHz apart from it. One table on stdout; tools/figure_contact_rate draws it.
//
// Contact Hz, together, apart, planes, late, mended (N/m), drag of the proxy and of the planes (N).

#include "study/rate/apart_loop.h"

#include <cstdio>

int main() {
    for (const int ticks : {80, 40, 20, 16, 8, 4, 2, 1}) {
        const touchstone::study::ContactRateResult r = touchstone::study::studyContactRate(ticks);
        std::printf("%g %.6g %.6g %.6g %.6g %.6g %.4g %.4g\n", r.contactHz, r.together, r.apart, r.planes,
                    r.late, r.mended, r.drag, r.dragPlanes);
        (void)std::fflush(stdout);
    }
}
