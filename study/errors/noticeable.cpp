#include "study/errors/noticeable.h"

namespace touchstone::study {

std::vector<JustNoticeable> noticeableDifferences() {
    constexpr double kDegree = 0.017453292519943295;
    const std::string smooth = "[004 Table 2], angle between adjacent facets at which a curve feels smooth, ";
    const std::string arm = "Feyzabadi et al., IEEE Trans. Haptics 6(3), 2013, doi:10.1109/TOH.2013.4 "
                            "(abstract), moving arm: ";
    return {
        {"facet angle, no shading", "rad", smooth + "force only (C1)", 0.5 * kDegree},
        {"facet angle, force shading", "rad", smooth + "force shading (C2)", 3.4 * kDegree},
        {"facet angle, force and tactile feedback", "rad", smooth + "no shading, with a tactile display (C3)",
         0.2 * kDegree},
        {"facet angle, tactile shading", "rad", smooth + "with a tactile display (C4)", 3.5 * kDegree},
        {"facet angle, force and tactile shading", "rad", smooth + "pilot with two people (P1)",
         14.8 * kDegree},
        {"force direction", "rad",
         "Barbagli et al. 2006 as quoted in [004 section 7]: force vectors one after the other",
         28.4 * kDegree},
        {"force magnitude", "1",
         arm + "Weber fraction 0.08 at the shoulder, 0.11 wrist, 0.13 elbow; the least", 0.08},
        {"force", "N", arm + "least force that was felt at all, mean of three joints", 0.04},
        {"position", "m",
         "Ho and Srinivasan, MIT RLE Technical Report 608, 1996 (abstract): thickness of an unbendable plate "
         "between finger and thumb, 0.4 mm, give or take 0.1",
         0.4e-3},
        {"relief", "m",
         "Skedung et al., Scientific Reports 3, 2013, srep02617: amplitude of ridges that a bare finger told "
         "from "
         "a smooth surface",
         13e-9},
    };
}

} // namespace touchstone::study
