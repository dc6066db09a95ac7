#include "workbench/timeline/replay_cache.h"

#include "engine/core/error.h"
#include "haptics/body/body_world.h"

#include <algorithm>
#include <exception>

namespace touchstone {

namespace {

using Scenes = std::map<uint32_t, FoundScene>;

/// Passes the chunks of a segment to `take`: the definitions that its ticks refer to, and the ticks.
template <class Take>
void readSegment(const Timeline& timeline, size_t number, const JobProgress& progress, const Take& take) {
    const TimelineSegment& segment = timeline.segments()[number];
    const size_t count = timeline.endOf(number) - segment.first;
    RecordingReader reader(timeline.file());
    reader.goTo(segment.offset);
    for (size_t ticks = 0; ticks < count && !progress.cancelled();) {
        std::optional<RecordingReader::Item> item = reader.next();
        if (!item)
            throw Error(timeline.file().string(), "byte " + std::to_string(segment.offset),
                        "is no longer what it was when it was opened", "open it again");
        if (const auto* block = std::get_if<RecordedTicks>(&item->item))
            ticks += block->ticks.size();
        take(*item);
    }
}

class SegmentReader {
  public:
    SegmentReader(const Timeline& timeline, size_t number, const Scenes& scenes)
        : timeline_(timeline), scenes_(scenes), result_(std::make_shared<LensSegment>()) {
        result_->number = number;
        result_->first = timeline.segments()[number].first;
    }

    std::shared_ptr<const LensSegment> read(const JobProgress& progress) {
        readSegment(timeline_, result_->number, progress, [&](const RecordingReader::Item& item) {
            items_.push_back(item);
            if (const auto* block = std::get_if<RecordedTicks>(&item.item))
                result_->ticks.insert(result_->ticks.end(), block->ticks.begin(), block->ticks.end());
        });
        result_->tried = timeline_.segments()[result_->number].checkpoint &&
                         std::ranges::all_of(result_->ticks, [&](auto& t) {
                             return t.scene == 0 || scenes_.contains(timeline_.rootOf(t.scene));
                         });
        if (result_->tried)
            touchAgain(progress);
        return result_;
    }

  private:
    void touchAgain(const JobProgress& progress) {
        result_->outputs.resize(result_->ticks.size());
        result_->equal.resize(result_->ticks.size());
        size_t begin = 0; // of the block being recomputed
        const RecordedTicks* block = nullptr;
        Replayer replayer([&](const RecordedScene& scene) { return scenes_.at(scene.number).scene; });
        const Replayer::Each each = [&](const RecordedTick& tick, const HapticOutput& output, int64_t,
                                        bool equal) {
            const size_t at = begin + static_cast<size_t>(&tick - block->ticks.data());
            result_->outputs[at] = output;
            result_->equal[at] = equal ? 1 : 0;
            if (const std::span<const DrivenPose> moved = replayer.moved(); !moved.empty()) {
                result_->moved.resize(result_->ticks.size());
                result_->moved[at].assign(moved.begin(), moved.end());
            }
            const body::BodyWorld* const bodies = replayer.bodies();
            if (bodies == nullptr)
                return;
            result_->bodies.resize(result_->ticks.size());
            for (const body::BodyState& state : bodies->states())
                result_->bodies[at].push_back(state.pose);
        };
        replayer.begin(each);
        for (const auto& [number, scene] : timeline_.scenes())
            replayer.take(RecordingReader::Item{.item = scene});
        for (const auto& [number, settings] : timeline_.settings())
            replayer.take(RecordingReader::Item{.item = RecordedSettings{number, settings}});
        for (const RecordedSculpt& sculpt : timeline_.sculpts())
            replayer.take(RecordingReader::Item{.item = sculpt});
        replayer.take(RecordingReader::Item{.item = timeline_.segments()[result_->number].tool});
        RecordingReader before(timeline_.file());
        for (const TimelineTextures& chunk : timeline_.texturesBefore(result_->number)) {
            before.goTo(chunk.offset);
            if (const std::optional<RecordingReader::Item> item = before.next())
                replayer.take(RecordingReader::Item{.item = item->item});
        }
        for (const RecordingReader::Item& item : items_) {
            if (std::holds_alternative<RecordedSculpt>(item.item))
                continue; // the replay has all of them
            block = std::get_if<RecordedTicks>(&item.item);
            if (progress.cancelled())
                return;
            replayer.take(item);
            begin += block != nullptr ? block->ticks.size() : 0;
        }
    }

    const Timeline& timeline_;
    const Scenes& scenes_;
    std::shared_ptr<LensSegment> result_;
    std::vector<RecordingReader::Item> items_;
};

TickRecord recordOf(const RecordedTick& tick) {
    TickRecord record;
    record.tick = tick.tick;
    record.time = tick.time;
    record.dt = tick.dt;
    record.wakeLatencyNs = tick.wakeLatencyNs;
    record.stepNs = tick.stepNs;
    record.missed = tick.missed;
    record.late = tick.late;
    record.checkpoint = tick.checkpoint;
    record.settings = tick.settings;
    record.scene = record.root = tick.scene;
    record.sample = tick.sample;
    record.output.hip = tick.sample.inWorkspace();
    record.output.proxy = tick.proxy;
    record.output.force = tick.force;
    record.output.contacts = tick.contacts;
    record.output.flags = tick.flags;
    if (tick.contacts > 0)
        record.output.penetration = glm::distance(tick.proxy, tick.sample.inWorkspace());
    return record;
}

} // namespace

const LensSegment* ReplayCache::segmentWith(size_t index) const {
    const size_t number = timeline_->segmentOf(index);
    const auto found = std::ranges::find_if(kept_, [&](const auto& s) { return s->number == number; });
    return found != kept_.end() && index - (*found)->first < (*found)->ticks.size() ? found->get() : nullptr;
}

bool ReplayCache::wants(size_t segment) const {
    if (failedSegments_.contains(segment))
        return false;
    const auto found = std::ranges::find_if(kept_, [&](const auto& s) { return s->number == segment; });
    if (found == kept_.end())
        return true;
    // Read before its model was loaded.
    return !(*found)->tried && timeline_->segments()[segment].checkpoint &&
           std::ranges::all_of((*found)->ticks, [&](const auto& t) {
               return t.scene == 0 || scenes_.contains(timeline_->rootOf(t.scene));
           });
}

void ReplayCache::look(size_t cursor) {
    try {
        if (std::optional<std::shared_ptr<const LensSegment>> segment = segmentJob_.take()) {
            std::erase_if(kept_, [&](const auto& s) { return s->number == (*segment)->number; });
            kept_.push_back(std::move(*segment));
            if (kept_.size() > kKept)
                kept_.erase(kept_.begin());
        }
    } catch (...) {
        failedSegments_.insert(readingSegment_);
        throw;
    }
    loadSceneOf(cursor);
    if (segmentJob_.busy())
        return;
    const size_t number = timeline_->segmentOf(cursor);
    if (wants(number))
        read(number);
    else if (number + 1 < timeline_->segments().size() && wants(number + 1)) // playback reaches it next
        read(number + 1);
}

void ReplayCache::read(size_t segment) {
    readingSegment_ = segment;
    segmentJob_.start([timeline = timeline_, segment, scenes = scenes_](const JobProgress& progress) {
        return SegmentReader(*timeline, segment, scenes).read(progress);
    });
}

void ReplayCache::loadSceneOf(size_t cursor) {
    try {
        if (std::optional<FoundScene> found = sceneJob_.take())
            scenes_.emplace(loadingScene_, std::move(*found));
    } catch (const std::exception& error) {
        failed_.insert(loadingScene_);
        problem_ = error.what();
    }
    const uint32_t number = timeline_->sceneOf(cursor);
    const auto recorded = timeline_->scenes().find(number);
    if (sceneJob_.busy() || recorded == timeline_->scenes().end() || scenes_.contains(number) ||
        failed_.contains(number))
        return;
    loadingScene_ = number;
    sceneJob_.start(
        [shelf = shelf_, scene = recorded->second](const JobProgress&) { return shelf->get(scene); });
}

bool ReplayCache::show(size_t index, TickRecord& record) const {
    const LensSegment* const segment = segmentWith(index);
    if (segment == nullptr)
        return false;
    const size_t at = index - segment->first;
    record = recordOf(segment->ticks[at]);
    if (complete(index))
        record.output = segment->outputs[at];
    return true;
}

const std::vector<body::Pose>* ReplayCache::bodies(size_t index) const {
    const LensSegment* const segment = segmentWith(index);
    if (segment == nullptr || segment->bodies.empty())
        return nullptr;
    const std::vector<body::Pose>& bodies = segment->bodies[index - segment->first];
    return bodies.empty() ? nullptr : &bodies;
}

std::span<const DrivenPose> ReplayCache::moved(size_t index) const {
    const LensSegment* const segment = segmentWith(index);
    return segment != nullptr && !segment->moved.empty() ? segment->moved[index - segment->first]
                                                         : std::span<const DrivenPose>();
}

bool ReplayCache::complete(size_t index) const {
    const LensSegment* const segment = segmentWith(index);
    return segment != nullptr && !segment->equal.empty() && segment->equal[index - segment->first] != 0;
}

} // namespace touchstone
