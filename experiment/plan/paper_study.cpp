#include "experiment/plan/study_plan.h"

namespace touchstone::experiment {

/// Steps and first levels: the paper calibrated its own by pilots and does not print them. Large steps are
/// about half of the spread of its people, small ones a quarter.
std::string_view paperStudy() {
    return R"json({
  "touchstoneStudy": 1,
  "name": "Polygon against smooth cylinder [004]",
  "question": "Which of the two was the smooth object?",
  "order": "latinSquare",
  "finger": {"stiffness": 600, "step": "published"},
  "staircase": {"largeReversals": 3, "reversals": 11, "averaged": 6, "mostTrials": 400},
  "conditions": [
    {"name": "C1", "title": "force only",
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "held"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "held"},
     "vary": "segments", "start": 20, "largeStep": 16, "smallStep": 8, "lowest": 2, "highest": 1000},
    {"name": "C2", "title": "force only, force shading",
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "held"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "shaded", "location": "held"},
     "vary": "segments", "start": 4, "largeStep": 2, "smallStep": 1, "lowest": 2, "highest": 1000},
    {"name": "C3", "title": "force and location",
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"},
     "vary": "segments", "start": 40, "largeStep": 40, "smallStep": 20, "lowest": 2, "highest": 1000},
    {"name": "C4", "title": "force and location, tactile shading",
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "bezier"},
     "vary": "segments", "start": 4, "largeStep": 2, "smallStep": 1, "lowest": 2, "highest": 1000},
    {"name": "P1", "title": "force and location, both shaded", "pilot": true,
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "bezier", "location": "bezier"},
     "vary": "segments", "start": 2, "largeStep": 1, "smallStep": 1, "lowest": 2, "highest": 1000},
    {"name": "P2", "title": "force and location, force shading", "pilot": true,
     "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "shaded", "location": "facets"},
     "vary": "segments", "start": 40, "largeStep": 40, "smallStep": 20, "lowest": 2, "highest": 1000}
  ]
}
)json";
}

} // namespace touchstone::experiment
