#pragma once

#include "workbench/timeline/background_job.h"
#include "workbench/timeline/recorded_scenes.h"
#include "workbench/timeline/timeline.h"

#include <string>
#include <vector>

namespace touchstone {

/// The result of `touchstone replay` for a recording.
struct Verdict {
    ReplayReport report;
    std::vector<std::string> changes; ///< of the scenes' files, one sentence each

    [[nodiscard]] bool equal() const { return report.replayed > 0 && !report.first; }
    /// "equal to the last bit in 4000 ticks", or the first tick and stage that differ.
    [[nodiscard]] std::string text() const;
};

/// Recomputes the whole recording. Worker; throws Error, JobCancelled.
[[nodiscard]] Verdict verify(const Timeline& timeline, RecordedSceneShelf& shelf, JobProgress& progress);

} // namespace touchstone
