#pragma once
// The cost of accuracy: runs the ablations on a scene and measures each configuration's error against the
// truth on one path and its time on stretches of the same path, the configurations interleaved.

#include "study/result/result.h"
#include "study/subject/subject.h"

#include <functional>
#include <string>
#include <vector>

namespace touchstone::study {

struct StudyOptions {
    std::vector<std::string> ablations; ///< empty: all
    size_t errorTicks = 4000;           ///< of the path, from the start of the descent
    /// Of the oracle over a path, for each radius (truth::oraclePath).
    size_t oracleWork = 100'000'000;
    int rounds = 150, ticksPerRound = 480;
    /// Of the tessellation ablation of a closed form: 2^9, 2^10, … up to this.
    size_t largestTriangles = 1'048'576;
};

/// The current activity and the completed fraction of this subject, 0..1.
using StudyProgress = std::function<void(const std::string& what, double fraction)>;

/// Appends the results of the subject's configurations, Pareto front marked, and notes. Calling thread; the
/// truth uses further threads.
void studySubject(const Subject& subject, const StudyOptions& options, StudyResult& result,
                  const StudyProgress& progress);

/// A shape at each tessellation, with the configurations of the ablation "tessellation".
void studyTessellation(const ShapeKind& kind, const StudyOptions& options, StudyResult& result,
                       const StudyProgress& progress);

} // namespace touchstone::study
