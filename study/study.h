#pragma once
// Shows what accuracy costs in time: runs the ablations on a scene, measures each configuration's errors
// against the truth on one path and its time on stretches of the same path, all configurations in turn.

#include "study/result/result.h"
#include "study/subject/subject.h"

#include <functional>
#include <string>
#include <vector>

namespace touchstone::study {

struct StudyOptions {
    std::vector<std::string> ablations; ///< empty: all
    size_t errorTicks = 4000;           ///< of the path, from where the hand comes down
    /// Of the oracle over a path, for each radius (truth::oraclePath).
    size_t oracleWork = 100'000'000;
    int rounds = 150, ticksPerRound = 480;
    /// Of a closed form's tessellation ablation: 2^9, 2^10, … up to this.
    size_t largestTriangles = 1'048'576;
};

/// What is being done and how much of this subject is done, 0..1.
using StudyProgress = std::function<void(const std::string& what, double fraction)>;

/// Appends what the subject's configurations show, Pareto front marked, and notes. Calling thread and, for
/// the truth, others.
void studySubject(const Subject& subject, const StudyOptions& options, StudyResult& result,
                  const StudyProgress& progress);

/// A shape at each tessellation, the configurations of the ablation "tessellation" on each.
void studyTessellation(const ShapeKind& kind, const StudyOptions& options, StudyResult& result,
                       const StudyProgress& progress);

} // namespace touchstone::study
