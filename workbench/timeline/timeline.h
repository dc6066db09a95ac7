#pragma once
// A recording for display: its curves over time and its events.

#include "haptics/recording/recording_reader.h"
#include "workbench/timeline/background_job.h"
#include "workbench/timeline/min_max_pyramid.h"

#include <cstdint>
#include <filesystem>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace touchstone {

/// An event before a tick.
struct TimelineMark {
    enum class Kind : uint8_t { Settings, Scene, Gap, Note };
    size_t index = 0; ///< of the next tick; the number of ticks where there is none
    Kind kind = Kind::Note;
    std::string text;
};

/// A unit of reading.
struct TimelineSegment {
    size_t first = 0;        ///< tick
    uint64_t offset = 0;     ///< byte of the first chunk
    bool checkpoint = false; ///< starts with a checkpoint: its ticks can be recomputed
    RecordedTool tool{};     ///< before its first tick
};

/// A chunk with the state of the persistent textures, or a change of it.
struct TimelineTextures {
    uint64_t offset = 0; ///< byte
    bool whole = false;  ///< begins a whole state
};

/// 17 bytes per tick, 61 MB per hour at 1 kHz; the ticks themselves stay in the file. Immutable once loaded;
/// any thread.
class Timeline {
  public:
    /// Reads the whole file. Worker; throws Error where nothing can be shown, JobCancelled.
    [[nodiscard]] static Timeline load(const std::filesystem::path& file, JobProgress& progress);

    [[nodiscard]] const std::filesystem::path& file() const { return file_; }
    [[nodiscard]] const RecordingOrigin& origin() const { return origin_; }
    [[nodiscard]] size_t size() const { return seconds_.size(); } ///< ticks, at least one

    /// s since the first tick. Increases from tick to tick, also where a restarted servo reset its count.
    [[nodiscard]] double seconds(size_t index) const { return seconds_[index]; }
    [[nodiscard]] double length() const { return seconds_.back(); } ///< s
    /// The last tick not after `seconds`; the first where there is none.
    [[nodiscard]] size_t indexAt(double seconds) const;

    [[nodiscard]] const MinMaxPyramid& force() const { return force_; } ///< N, magnitude of stage 7
    [[nodiscard]] const MinMaxPyramid& depth() const { return depth_; } ///< m, |proxy - HIP|
    /// True if a tick of [first, last) is in contact.
    [[nodiscard]] bool touches(size_t first, size_t last) const;

    [[nodiscard]] const std::vector<TimelineMark>& marks() const { return marks_; }
    [[nodiscard]] const std::map<uint32_t, RecordedScene>& scenes() const { return scenes_; }
    [[nodiscard]] const std::map<uint32_t, HapticSettings>& settings() const { return settings_; }
    /// What sculpted the scenes, in order.
    [[nodiscard]] const std::vector<RecordedSculpt>& sculpts() const { return sculpts_; }
    /// What makes the textures before the segment, in order.
    [[nodiscard]] std::span<const TimelineTextures> texturesBefore(size_t segment) const;
    /// The scene that a tick's scene is an edit of, or itself.
    [[nodiscard]] uint32_t rootOf(uint32_t scene) const {
        const auto found = roots_.find(scene);
        return found != roots_.end() ? found->second : scene;
    }
    /// Of the tick, before it was sculpted; 0: no scene.
    [[nodiscard]] uint32_t sceneOf(size_t index) const;
    [[nodiscard]] const HapticSettings& settingsOf(size_t index) const;

    [[nodiscard]] size_t segmentOf(size_t index) const;
    [[nodiscard]] const std::vector<TimelineSegment>& segments() const { return segments_; }
    /// One past the segment's last tick.
    [[nodiscard]] size_t endOf(size_t segment) const {
        return segment + 1 < segments_.size() ? segments_[segment + 1].first : size();
    }

    /// Warnings about the file: truncated, damaged, written by another build. One sentence each.
    [[nodiscard]] const std::vector<std::string>& warnings() const { return warnings_; }
    [[nodiscard]] uint64_t lost() const { return lost_; } ///< ticks that were not recorded

  private:
    friend class TimelineMaker;
    Timeline() = default;

    using Runs = std::vector<std::pair<size_t, uint32_t>>; // scene number from this tick on
    std::filesystem::path file_;
    RecordingOrigin origin_;
    std::vector<double> seconds_;
    MinMaxPyramid force_, depth_;
    std::vector<size_t> contactEdges_; // ticks at which contact starts and ends, alternating
    std::vector<TimelineMark> marks_;
    std::map<uint32_t, RecordedScene> scenes_;
    std::map<uint32_t, HapticSettings> settings_;
    std::map<uint32_t, uint32_t> roots_; // of sculpted scenes
    std::vector<RecordedSculpt> sculpts_;
    std::vector<TimelineTextures> textures_;
    RecordedTool tool_; // the last
    Runs sceneRuns_, settingsRuns_;
    std::vector<TimelineSegment> segments_;
    std::vector<std::string> warnings_;
    uint64_t lost_ = 0;
};

/// "friction zilles to off, stiffness 0 to 800": the changes from the first to the second. Empty: none.
[[nodiscard]] std::string settingsDifference(const HapticSettings& before, const HapticSettings& after);

/// True if the file starts as a recording, or at least has the extension of one. False where it cannot be
/// read.
[[nodiscard]] bool isRecording(const std::filesystem::path& file);

} // namespace touchstone
