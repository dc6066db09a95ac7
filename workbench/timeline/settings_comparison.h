#pragma once

#include "haptics/settings/haptic_settings.h"
#include "workbench/figures/force_comparison.h"
#include "workbench/timeline/background_job.h"
#include "workbench/timeline/recorded_scenes.h"
#include "workbench/timeline/timeline.h"

#include <memory>
#include <optional>
#include <string>

namespace touchstone {

/// A recording touched again as a whole with other settings: the same path, tick by tick, without a servo.
struct ComparedTouch {
    HapticSettings settings;
    std::string change;  ///< "friction zilles to off", from the first recorded settings; empty: none
    MinMaxPyramid force; ///< N, as Timeline::force; the recorded one where a tick cannot be touched again
    ForceComparison figures;
    size_t missing = 0; ///< ticks that cannot be touched again, behind gaps

    /// "then 0.612 N, friction zilles to off 0.598 N on average in contact; …"
    [[nodiscard]] std::string text() const;
};

/// Worker; throws Error, JobCancelled.
[[nodiscard]] ComparedTouch compareTouch(const Timeline& timeline, RecordedSceneShelf& shelf,
                                         const HapticSettings& settings, JobProgress& progress);

/// Keeps a ComparedTouch of the open recording up to date with the chosen settings while it is wanted. Main
/// thread.
class SettingsComparison {
  public:
    using Recording = std::shared_ptr<const Timeline>;
    using Shelf = std::shared_ptr<RecordedSceneShelf>;

    void want(bool wanted);
    [[nodiscard]] bool wanted() const { return wanted_; }
    /// Every frame: touches again where the settings are others than those of the result.
    void update(const Recording& timeline, const Shelf& shelf, const HapticSettings& settings);

    /// Null: none yet, or not wanted. That of the settings before, while another one is made.
    [[nodiscard]] const ComparedTouch* result() const { return result_.get(); }
    [[nodiscard]] bool busy() const { return job_.wanted(); }
    [[nodiscard]] double fraction() const { return job_.fraction(); }     ///< 0..1
    [[nodiscard]] const std::string& problem() const { return problem_; } ///< why there is none; empty: none

  private:
    void take();

    BackgroundJob<std::shared_ptr<const ComparedTouch>> job_;
    std::optional<HapticSettings> asked_; ///< of the job, or of what it came to
    std::shared_ptr<const ComparedTouch> result_;
    std::string problem_;
    bool wanted_ = false;
};

} // namespace touchstone
