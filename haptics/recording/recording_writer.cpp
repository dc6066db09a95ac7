#include "haptics/recording/recording_writer.h"

#include "engine/core/member_count.h"
#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

static_assert(memberCount<DeviceSample>() == 9 && memberCount<TickRecord>() == 24 &&
                  memberCount<HapticOutput>() == 22,
              "a member was added: a replay needs it, compares it (stage_hashes.cpp), or is it for people?");

/// Of the ticks with a display; none: there are none.
RecordedLocations locationsOf(uint32_t hand, const std::vector<RecordedTick>& ticks) {
    RecordedLocations locations{.hand = hand, .before = {}, .shown = {}};
    for (const RecordedTick& tick : ticks) {
        if (!(tick.pad.limits.reach > 0.0))
            continue;
        if (locations.shown.empty())
            locations.before = tick.pad.before;
        locations.shown.push_back({tick.tick, tick.pad.limits, tick.pad.location});
    }
    return locations;
}

} // namespace

RecordedTick recordedTick(const TickRecord& record) {
    const HapticOutput& output = record.output;
    return {.tick = record.tick,
            .time = record.time,
            .dt = record.dt,
            .sample = record.sample,
            .settings = record.settings,
            .scene = record.scene,
            .poses = record.poses,
            .found = record.found,
            .late = record.late,
            .missed = record.missed,
            .checkpoint = record.checkpoint,
            .wakeLatencyNs = record.wakeLatencyNs,
            .stepNs = record.stepNs,
            .hashes = stageHashes(record.trace, output),
            .proxy = output.proxy,
            .force = output.force,
            .command = output.command.force(),
            .contacts = output.contacts,
            .flags = output.flags,
            .pad = record.pad};
}

RecordingWriter::RecordingWriter(std::filesystem::path path, RecordingOrigin origin, uint32_t sequence)
    : file_(std::move(path), sequence), origin_(std::move(origin)) {
    file_.append(origin_);
}

void RecordingWriter::add(const TickToRecord& tick) {
    if (!begun_ && (tick.checkpoint == nullptr || !tick.whole))
        return;
    const bool lost = begun_ && tick.lostBefore > 0;
    const uint32_t root = tick.sculpt != nullptr ? tick.sculpt->root : tick.tick.scene;
    const bool newScene = tick.scene != nullptr && !scenes_.contains(root);
    const bool newSettings = !begun_ || tick.tick.settings != settings_;
    const bool newSculpt = tick.sculpt != nullptr && tick.tick.scene != sculpted_;
    const bool newTool = tick.toolNumber != tool_;
    if (lost || newScene || newSettings || newSculpt || newTool || tick.checkpoint != nullptr ||
        block_.ticks.size() == kBlock)
        flush();
    if (lost)
        file_.append(RecordedLoss{tick.lostBefore});
    if (newScene)
        file_.append(RecordedScene{root, *tick.scene});
    if (newSculpt)
        addSculpt(tick.tick.scene, *tick.sculpt);
    if (newTool)
        file_.append(RecordedTool{tick.tool});
    if (newSettings)
        file_.append(RecordedSettings{tick.tick.settings, tick.settings});
    if (tick.textures == nullptr)
        texturesAge_ = kTexturesEvery; // where strokes were lost they are written whole as soon as there are
    if (tick.checkpoint != nullptr) {
        file_.append(*tick.checkpoint);
        for (const HandToRecord& other : tick.others)
            if (other.checkpoint)
                file_.append(RecordedHandState{*other.checkpoint});
        if (tick.bodies != nullptr)
            file_.append(RecordedBodies{tick.tick.tick, *tick.bodies});
        if (tick.textures != nullptr)
            addTextures(tick, root);
    }
    if (tick.driven != nullptr)
        file_.append(RecordedDriven{*tick.driven});
    if (newScene)
        scenes_[root] = true;
    settings_ = tick.tick.settings;
    tool_ = tick.toolNumber;
    begun_ = true;
    block_.ticks.push_back(tick.tick);
    strokes_.strokes.insert(strokes_.strokes.end(), tick.strokes.begin(), tick.strokes.end());
    for (const HandToRecord& other : tick.others)
        otherBlocks_[other.hand].ticks.push_back(other.tick);
}

/// The entries that this file does not have yet, in chunks that a reader's memory holds.
void RecordingWriter::addSculpt(uint32_t scene, const SculptToRecord& sculpt) {
    constexpr size_t kMost = 8192;
    size_t& written = journals_[sculpt.root];
    do {
        const size_t count = std::min(kMost, sculpt.journal.size() - written);
        const auto part = sculpt.journal.subspan(written, count);
        const bool last = written + count == sculpt.journal.size();
        file_.append(RecordedSculpt{scene,
                                    sculpt.root,
                                    last ? sculpt.hash : 0,
                                    static_cast<uint32_t>(written),
                                    {part.begin(), part.end()}});
        written += count;
    } while (written < sculpt.journal.size());
    sculpted_ = scene;
}

/// The state before the tick, where one is due: behind it the strokes alone make the state of any tick.
void RecordingWriter::addTextures(const TickToRecord& tick, uint32_t root) {
    if (texturesOf_ == root && ++texturesAge_ < kTexturesEvery)
        return;
    texturesOf_ = root;
    texturesAge_ = 0;
    constexpr size_t kMost = 200; // tiles of a chunk, which a reader's memory holds
    RecordedTextures state;
    state.tick = tick.tick.tick;
    for (size_t object = 0; object < tick.textures->objects(); ++object) {
        const PersistentTexture* const texture = tick.textures->at(static_cast<int>(object));
        for (uint32_t tile = 0; texture != nullptr && tile < texture->tiles(); ++tile) {
            std::vector<float> values = texture->tileValues(tile);
            const bool even = std::ranges::all_of(values, [&](float value) { return value == values[0]; });
            if (even && values[0] == texture->size().initial)
                continue;
            if (even)
                values.resize(1);
            if (state.tiles.size() == kMost) {
                file_.append(state);
                ++state.part;
                state.tiles.clear();
            }
            state.tiles.push_back({static_cast<uint32_t>(object), tile, std::move(values)});
        }
    }
    file_.append(state);
}

void RecordingWriter::addLocations(uint32_t hand, const RecordedTicks& block) {
    if (const RecordedLocations locations = locationsOf(hand, block.ticks); !locations.shown.empty())
        file_.append(locations);
}

void RecordingWriter::note(uint64_t tick, std::string text) {
    flush();
    file_.append(RecordedNote{tick, std::move(text)});
}

void RecordingWriter::flush() {
    if (block_.ticks.empty())
        return;
    RecordedContacts contacts;
    for (const RecordedTick& tick : block_.ticks)
        if (tick.found > 0)
            contacts.found.push_back({tick.tick, tick.found});
    if (!contacts.found.empty())
        file_.append(contacts);
    if (!strokes_.strokes.empty())
        file_.append(strokes_);
    strokes_.strokes.clear();
    addLocations(0, block_);
    for (auto& [hand, block] : otherBlocks_) {
        addLocations(hand, block);
        file_.append(RecordedHandTicks{hand, block});
        block.ticks.clear();
    }
    file_.append(block_);
    ticks_ += block_.ticks.size();
    block_.ticks.clear();
}

void RecordingWriter::finish() {
    flush();
    file_.append(RecordedEnd{ticks_});
}

} // namespace touchstone
