#pragma once
// The charts as files: every tick as CSV, and a figure as SVG.

#include "study/report/plots/figure.h"
#include "workbench/files/saved_file.h"
#include "workbench/readings/chart_quantities.h"

#include <future>
#include <string>

namespace touchstone {

/// The ticks, one per row: t,force,tangential,penetration,energy,step (s, N, N, m, J, s; tangential to the
/// felt normal), contact,recorded (0, 1), surface_normal,surface_tangential (N, along and across the normal
/// of the mesh), force_x,force_y,force_z (N, workspace). Throws Error.
void writeChart(const std::filesystem::path& file, const ForceHistory& history);

/// What a figure of the charts says about its conditions.
struct ChartConditions {
    std::string model; ///< "doughnut.glb"
    std::string hand;  ///< "mouse"
    HapticSettings settings;
};

/// A page of panels over one axis of time, in s before the last tick: the shown forces together, every other
/// quantity in a panel of its own, each with its unit and a legend. One data row per tick. `name`: of its
/// files. Throws Error where nothing is shown or there are fewer than two ticks.
[[nodiscard]] study::Figure chartFigure(const std::string& name, const ForceHistory& history,
                                        const ShownQuantities& shown, const ChartConditions& conditions,
                                        const study::Provenance& where);

/// Saves charts into the state folder; a figure is drawn by gnuplot on a worker. Main thread.
class ChartSaver {
  public:
    void saveCsv(const ForceHistory& history);
    /// Ignored while another one is being drawn.
    void saveFigure(const ForceHistory& history, const ShownQuantities& shown,
                    const ChartConditions& conditions);
    [[nodiscard]] bool busy() const { return drawing_.valid(); }
    /// The result of a figure that is done since the last call.
    void update();
    [[nodiscard]] const SavedNote& note() const { return note_; } ///< of the last one

  private:
    std::future<SavedNote> drawing_;
    SavedNote note_;
};

} // namespace touchstone
