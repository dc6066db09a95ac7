#pragma once
// `run --sculpt`: the simulated hand's stroke sculpts what it touches.

#include "session/session.h"
#include "workbench/figures/time_histogram.h"
#include "workbench/model/model.h"
#include "workbench/options/commands.h"

#include <nlohmann/json_fwd.hpp>

#include <cstdint>
#include <memory>
#include <vector>

namespace touchstone {

/// Main thread.
class RunSculpt final : public TickSubscriber {
  public:
    /// Throws Error: nothing of the model is felt as a field, or no object has the stamp's name.
    RunSculpt(const SculptOptions& options, const Model& model);

    /// The tool is in the hands from the next tick on.
    void start(Session& session);
    void sceneSculpted(const SculptedScene& scene) override { last_ = scene.haptic; }
    void take(const TickRecord& record, const HapticSettings&) override;
    /// After the servo has stopped: waits for what was made, and writes it.
    void finish(Session& session);

    [[nodiscard]] nlohmann::ordered_json json(const Session& session, double seconds) const;

  private:
    const SculptOptions& options_;
    LiveTool tool_;
    std::shared_ptr<const HapticScene> last_;
    std::vector<double> delays_; // s, of each scene that was taken up
};

} // namespace touchstone
