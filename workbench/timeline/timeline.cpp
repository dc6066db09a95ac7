#include "workbench/timeline/timeline.h"

#include "engine/core/error.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fstream>
#include <iterator>
#include <optional>
#include <system_error>
#include <utility>

namespace touchstone {

namespace {

constexpr size_t kSculptedSegment = 1000; // ticks, at least
constexpr size_t kLongestSegment = 4096;  // ticks, without a checkpoint
constexpr double kLongestStep = 3600.0;   // s between two ticks; a longer step is a clock change
constexpr float kMaxShown = 1e6f;         // N and m: non-finite and larger values are drawn there
constexpr size_t kMaxMarks = 20000;       // for a recording whose settings change in every tick

std::string fileName(const SceneIdentity& scene) {
    return std::filesystem::path(scene.path).filename().string();
}

float shown(double value) {
    return std::isfinite(value) ? std::min(static_cast<float>(value), kMaxShown) : kMaxShown;
}

} // namespace

/// Processes the items in file order.
class TimelineMaker {
  public:
    void take(const RecordingReader::Item& item) {
        if (item.damageBefore)
            mark(TimelineMark::Kind::Gap, "damaged: what was here cannot be read");
        offset_ = item.offset;
        std::visit([this](const auto& value) { take(value); }, item.item);
    }
    Timeline make(const RecordingReader& reader, const std::filesystem::path& file);

  private:
    void mark(TimelineMark::Kind kind, std::string text) {
        if (line_.marks_.size() < kMaxMarks)
            line_.marks_.push_back({line_.size(), kind, std::move(text)});
    }
    void take(const RecordingOrigin& origin) {
        if (line_.origin_.version.empty())
            line_.origin_ = origin;
    }
    void take(const RecordedScene& scene) {
        bodies_ = false; // until its own are read
        line_.scenes_[scene.number] = scene;
    }
    void take(const RecordedSettings& settings) { line_.settings_[settings.number] = settings.settings; }
    void take(const TouchCheckpoint& checkpoint) {
        // Each edit of a sculpted scene begins with one.
        if (line_.roots_.contains(checkpoint.scene) && !line_.segments_.empty() &&
            line_.segments_.back().checkpoint &&
            line_.size() - line_.segments_.back().first < kSculptedSegment)
            return;
        waiting_ = offset_;
        if (!bodies_ || !line_.roots_.contains(checkpoint.scene))
            begin();
    }
    /// A segment, at the checkpoint that waits.
    void begin() {
        line_.segments_.push_back({.first = line_.size(),
                                   .offset = *std::exchange(waiting_, std::nullopt),
                                   .checkpoint = true,
                                   .tool = line_.tool_});
    }
    void take(const RecordedLoss& loss) {
        line_.lost_ += loss.ticks;
        mark(TimelineMark::Kind::Gap, std::to_string(loss.ticks) + " ticks were not recorded");
    }
    void take(const RecordedNote& note) { mark(TimelineMark::Kind::Note, note.text); }
    void take(const RecordedEnd&) {}
    // The window shows hand 0.
    void take(const RecordedHandTicks&) {}
    void take(const RecordedHandState&) {}
    void take(const RecordedTool& tool) { line_.tool_ = tool; }
    void take(const RecordedSculpt& sculpt) {
        line_.roots_[sculpt.scene] = sculpt.root;
        line_.sculpts_.push_back(sculpt);
    }
    void take(const RecordedContacts&) {}
    void take(const RecordedLocations&) {}
    // Beside bodies an edit's checkpoint is one to begin at where their state follows.
    void take(const RecordedBodies&) {
        bodies_ = true;
        if (waiting_)
            begin();
    }
    void take(const RecordedDriven&) {}
    void take(const RecordedTextures& textures) { line_.textures_.push_back({offset_, textures.part == 0}); }
    void take(const RecordedStrokes&) { line_.textures_.push_back({offset_, false}); }
    void take(const RecordedTicks& ticks);
    void take(const RecordedTick& tick);
    void changeScene(uint32_t scene);
    void changeSettings(uint32_t settings);

    Timeline line_;
    std::vector<float> force_, depth_;
    uint64_t offset_ = 0;
    std::optional<uint64_t> waiting_; // offset of a checkpoint at which no segment has begun
    bool bodies_ = false;             // the scene has some
    double time_ = 0.0;               // of the previous tick
    bool touching_ = false;
};

std::span<const TimelineTextures> Timeline::texturesBefore(size_t segment) const {
    const auto end =
        std::ranges::lower_bound(textures_, segments_[segment].offset, {}, &TimelineTextures::offset);
    auto begin = end;
    while (begin != textures_.begin() && !(--begin)->whole) {
    }
    return {begin, end};
}

void TimelineMaker::take(const RecordedTicks& ticks) {
    waiting_.reset();
    if (line_.segments_.empty() || line_.size() - line_.segments_.back().first >= kLongestSegment)
        line_.segments_.push_back({.first = line_.size(), .offset = offset_, .tool = line_.tool_});
    for (const RecordedTick& tick : ticks.ticks)
        take(tick);
}

void TimelineMaker::take(const RecordedTick& tick) {
    if (const uint32_t scene = line_.rootOf(tick.scene);
        line_.sceneRuns_.empty() || line_.sceneRuns_.back().second != scene)
        changeScene(scene);
    if (line_.settingsRuns_.empty() || line_.settingsRuns_.back().second != tick.settings)
        changeSettings(tick.settings);
    const double step = tick.time - time_;
    const bool goesOn = step > 0.0 && step < kLongestStep;
    const double own = std::isfinite(tick.dt) ? std::clamp(tick.dt, 0.0, 1.0) : 0.0;
    line_.seconds_.push_back(line_.seconds_.empty() ? 0.0 : line_.seconds_.back() + (goesOn ? step : own));
    time_ = tick.time;
    force_.push_back(shown(glm::length(tick.force)));
    // Without a valid sample there is no HIP and no penetration.
    depth_.push_back(tick.contacts > 0 ? shown(glm::distance(tick.proxy, tick.sample.inWorkspace())) : 0.0f);
    if ((tick.contacts > 0) != touching_) {
        line_.contactEdges_.push_back(line_.size() - 1);
        touching_ = !touching_;
    }
}

void TimelineMaker::changeScene(uint32_t scene) {
    const auto& scenes = line_.scenes_;
    if (!line_.sceneRuns_.empty()) {
        const auto before = scenes.find(line_.sceneRuns_.back().second), now = scenes.find(scene);
        if (now == scenes.end())
            mark(TimelineMark::Kind::Scene, "nothing to touch");
        else if (before != scenes.end() && before->second.identity.path == now->second.identity.path)
            mark(TimelineMark::Kind::Scene, fileName(now->second.identity) + " with other materials");
        else
            mark(TimelineMark::Kind::Scene, fileName(now->second.identity));
    }
    line_.sceneRuns_.emplace_back(line_.size(), scene);
}

void TimelineMaker::changeSettings(uint32_t settings) {
    const auto now = line_.settings_.find(settings);
    if (now == line_.settings_.end())
        throw Error("", "tick " + std::to_string(line_.size()), "has settings that are not there",
                    "the file is damaged: use another copy");
    if (!line_.settingsRuns_.empty()) {
        const HapticSettings& before = line_.settings_.at(line_.settingsRuns_.back().second);
        if (std::string difference = settingsDifference(before, now->second); !difference.empty())
            mark(TimelineMark::Kind::Settings, std::move(difference));
    }
    line_.settingsRuns_.emplace_back(line_.size(), settings);
}

Timeline TimelineMaker::make(const RecordingReader& reader, const std::filesystem::path& file) {
    if (line_.seconds_.empty())
        throw Error(file.string(), "", "there are no ticks in it", "use another copy of the file");
    line_.file_ = file;
    line_.force_ = MinMaxPyramid(std::move(force_));
    line_.depth_ = MinMaxPyramid(std::move(depth_));
    for (const std::string& damage : reader.damage())
        line_.warnings_.push_back(damage);
    if (reader.cutOff())
        line_.warnings_.emplace_back(
            "it is cut off (the program that wrote it was killed, or the disk was full)");
    if (line_.lost_ > 0)
        line_.warnings_.push_back(std::to_string(line_.lost_) + " ticks were not recorded");
    const RecordingOrigin now = recordingOrigin("", 0.0);
    if (line_.origin_.build != now.build)
        line_.warnings_.emplace_back("another build recorded it: last bits may differ");
    else if (line_.origin_.processor != now.processor)
        line_.warnings_.emplace_back("another processor recorded it: last bits may differ");
    return std::move(line_);
}

Timeline Timeline::load(const std::filesystem::path& file, JobProgress& progress) {
    RecordingReader reader(file);
    TimelineMaker maker;
    try {
        while (const std::optional<RecordingReader::Item> item = reader.next()) {
            progress.at(static_cast<double>(item->offset) / static_cast<double>(reader.size()));
            maker.take(*item);
        }
    } catch (const Error& error) {
        if (!error.file().empty())
            throw;
        throw Error(file.string(), error.place(), error.problem(), error.remedy());
    }
    return maker.make(reader, file);
}

size_t Timeline::indexAt(double seconds) const {
    const auto after = std::upper_bound(seconds_.begin(), seconds_.end(), seconds);
    return after == seconds_.begin() ? 0 : static_cast<size_t>(after - seconds_.begin()) - 1;
}

bool Timeline::touches(size_t first, size_t last) const {
    // The edge after `first` ends a contact that started before it, or starts one.
    const auto next = std::upper_bound(contactEdges_.begin(), contactEdges_.end(), first);
    const bool within = (next - contactEdges_.begin()) % 2 != 0;
    return first < last && (within || (next != contactEdges_.end() && *next < last));
}

namespace {

uint32_t numberAt(const std::vector<std::pair<size_t, uint32_t>>& runs, size_t index) {
    const auto after = std::upper_bound(runs.begin(), runs.end(), index,
                                        [](size_t i, const auto& run) { return i < run.first; });
    return after == runs.begin() ? 0 : std::prev(after)->second;
}

} // namespace

uint32_t Timeline::sceneOf(size_t index) const {
    return numberAt(sceneRuns_, index);
}

const HapticSettings& Timeline::settingsOf(size_t index) const {
    return settings_.at(numberAt(settingsRuns_, index));
}

size_t Timeline::segmentOf(size_t index) const {
    const auto after =
        std::upper_bound(segments_.begin(), segments_.end(), index,
                         [](size_t i, const TimelineSegment& segment) { return i < segment.first; });
    return after == segments_.begin() ? 0 : static_cast<size_t>(after - segments_.begin()) - 1;
}

std::string settingsDifference(const HapticSettings& before, const HapticSettings& after) {
    std::string text;
    for (const auto& info : settingFields()) {
        const std::string was = settingValue(before, info.name), is = settingValue(after, info.name);
        if (was != is)
            text += (text.empty() ? "" : ", ") + std::string(info.name) + " " + was + " to " + is;
    }
    return text;
}

bool isRecording(const std::filesystem::path& file) {
    std::array<char, kRecordingMagic.size()> begin{};
    std::error_code error;
    if (!std::filesystem::is_regular_file(file, error)) // reading a pipe would wait for its writer
        return false;
    std::ifstream in(file, std::ios::binary);
    if (!in)
        return false;
    in.read(begin.data(), begin.size());
    return std::string_view(begin.data(), static_cast<size_t>(in.gcount())) == kRecordingMagic ||
           file.extension() == kRecordingEnding;
}

} // namespace touchstone
