#pragma once

#include "haptics/scene/scene_sculptor.h"

#include <nlohmann/json_fwd.hpp>

#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

namespace touchstone {

/// `touch --sculpt`: a journal that is applied to what is touched. Deterministic. Throws Error.
class TouchSculpt {
  public:
    /// Applies the steps without a time.
    TouchSculpt(const std::filesystem::path& journal, std::shared_ptr<const HapticScene> scene);

    /// Steps with times are left.
    [[nodiscard]] bool waits() const { return next_ < steps_.size(); }
    /// Applies those of times up to `time`, s. True where the scene is another one now.
    bool applyUntil(double time);
    [[nodiscard]] const std::shared_ptr<const HapticScene>& scene() const { return sculptor_.scene(); }
    /// The objects that were sculpted so far.
    [[nodiscard]] std::vector<int> sculpted() const { return sculptor_.sculpted(); }

    /// The journal's entries since the last call, and the hash of the fields after them: for a recording.
    [[nodiscard]] std::vector<SculptEntry> takeEntries() { return sculptor_.takeEntries(); }
    [[nodiscard]] uint64_t hash() const { return sculptor_.hash(); }

    [[nodiscard]] nlohmann::ordered_json json() const;
    /// Prints what was sculpted and the hash of the field, and writes the object that was sculpted first:
    /// .glb (mesh, with normals) or .vdb (level set).
    void finish(const std::vector<std::filesystem::path>& files) const;

  private:
    void apply();
    [[nodiscard]] std::string hashText() const;

    std::vector<SculptStep> steps_;
    SceneSculptor sculptor_;
    /// Scenes that the touch may still read.
    std::shared_ptr<const HapticScene> before_;
    size_t next_ = 0;
    SculptReport all_;
};

} // namespace touchstone
