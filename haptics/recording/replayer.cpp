#include "haptics/recording/replayer.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/body/body_world.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/servo/realtime_thread.h"
#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

std::string whichHand(const ReplayReport& report) {
    if (report.hands == 1 || !report.first || report.first->stage == "poses" ||
        report.first->stage == "field" || report.first->stage == "textures")
        return "";
    return "of hand " + std::to_string(report.first->hand + 1) + ", ";
}

ReplayReport Replayer::replay(RecordingReader& reader, const Each& each) {
    begin(each);
    while (const std::optional<RecordingReader::Item> item = reader.next())
        take(*item);
    report_.damage = reader.damage();
    report_.cutOff = reader.cutOff();
    if (report_.ticks > 0 && report_.replayed == 0 && report_.gaps == 0)
        throw Error("recording", "", "no tick can be replayed: no state to begin with fits this build",
                    "use the build that recorded it (" + report_.origin.version + ", " +
                        report_.origin.build + ")");
    return std::move(report_);
}

void Replayer::begin(const Each& each) {
    enterFloatMode();
    report_ = ReplayReport{};
    each_ = &each;
    lose();
}

void Replayer::take(const RecordingReader::Item& item) {
    if (item.damageBefore) {
        ++report_.gaps;
        lose();
    }
    std::visit([this](const auto& value) { take(value); }, item.item);
}

void Replayer::take(const RecordingOrigin& origin) {
    if (report_.origin.version.empty())
        report_.origin = origin;
}

void Replayer::take(const RecordedScene& scene) {
    scenes_[scene.number] = scene;
}

void Replayer::take(const RecordedSettings& settings) {
    settings_[settings.number] = change_ ? change_(settings.settings) : settings.settings;
}

void Replayer::take(const TouchCheckpoint& checkpoint) {
    checkpoint_ = checkpoint;
}

void Replayer::take(const RecordedHandState& state) {
    otherStates_[state.checkpoint.hand] = state.checkpoint;
}

void Replayer::take(const RecordedContacts& contacts) {
    for (const RecordedContacts::Found& found : contacts.found)
        found_[found.tick] = found.found;
}

void Replayer::take(const RecordedBodies& bodies) {
    bodies_ = bodies;
}

void Replayer::take(const RecordedDriven& driven) {
    driven_[driven.state.tick] = driven.state;
}

void Replayer::take(const RecordedTextures& textures) {
    if (textures.part == 0) {
        textures_.clear();
        strokes_.clear();
        nextStroke_ = 0;
    }
    textures_.push_back(textures);
}

void Replayer::take(const RecordedStrokes& strokes) {
    strokes_.insert(strokes_.end(), strokes.strokes.begin(), strokes.strokes.end());
}

void Replayer::take(const RecordedLocations& locations) {
    glm::dvec2 before = locations.before;
    for (const RecordedLocations::Shown& shown : locations.shown) {
        shown_[locations.hand][shown.tick] = {shown.limits, before, shown.location};
        before = shown.location;
    }
}

void Replayer::take(const RecordedHandTicks& ticks) {
    std::deque<RecordedTick>& waiting = others_[ticks.hand];
    waiting.insert(waiting.end(), ticks.ticks.ticks.begin(), ticks.ticks.ticks.end());
    report_.hands = std::max(report_.hands, size_t{ticks.hand} + 1);
}

void Replayer::take(const RecordedSculpt& sculpt) {
    std::vector<SculptEntry>& journal = journals_[sculpt.root];
    if (sculpt.first > journal.size())
        throw Error("recording", "", "leaves out what was sculpted before", "the file is damaged");
    journal.resize(sculpt.first); // a part of a flight recording repeats what the one before it holds
    journal.insert(journal.end(), sculpt.entries.begin(), sculpt.entries.end());
    sculpted_[sculpt.scene] = {sculpt.root, sculpt.hash, journal.size()};
}

void Replayer::take(const RecordedLoss& loss) {
    report_.lost += loss.ticks;
    ++report_.gaps;
    lose();
}

void Replayer::take(const RecordedNote& note) {
    report_.notes.push_back(note);
}

void Replayer::take(const RecordedTicks& ticks) {
    for (const RecordedTick& tick : ticks.ticks) {
        ++report_.ticks;
        const bool whole = gather(tick);
        // Where a hand's checkpoint is missing, a replay that knows the state continues.
        const bool states = checkpoint_ && otherStates_.size() + 1 == ticks_.size();
        const bool begins = states && checkpoint_->tick == tick.tick && checkpoint_->scene == tick.scene;
        const bool ownState = change_ && known_ && tick.scene == scene_;
        const bool goesOn = whole && change_ && known_ && tick.scene != scene_ && takeUp(tick);
        if (whole && begins && !ownState && !goesOn)
            resume(tick);
        else if (!whole || tick.scene != scene_)
            lose();
        checkpoint_.reset();
        otherStates_.clear();
        bodies_.reset();
        if (known_)
            step(tick);
        found_.erase(found_.begin(), found_.upper_bound(tick.tick));
        for (auto& shown : shown_)
            shown.erase(shown.begin(), shown.upper_bound(tick.tick));
        driven_.erase(driven_.begin(), driven_.upper_bound(tick.tick));
    }
}

/// The rows of all hands at this tick, with what their displays showed. False where one is missing.
bool Replayer::gather(const RecordedTick& tick) {
    ticks_.resize(1);
    ticks_[0] = tick;
    uint32_t next = 1;
    for (auto& [hand, waiting] : others_) {
        while (!waiting.empty() && waiting.front().tick < tick.tick)
            waiting.pop_front();
        if (waiting.empty() || waiting.front().tick != tick.tick)
            continue;
        if (hand != next++)
            return false;
        ticks_.push_back(waiting.front());
        waiting.pop_front();
    }
    for (size_t hand = 0; hand < ticks_.size(); ++hand)
        if (const auto shown = shown_[hand].find(tick.tick); shown != shown_[hand].end())
            ticks_[hand].pad = shown->second;
    return known_ ? ticks_.size() == devices_.size() : ticks_.size() == 1 + otherStates_.size();
}

/// The state is unknown from here to the next checkpoint.
void Replayer::lose() {
    known_ = false;
    checkpoint_.reset();
    otherStates_.clear();
    others_.clear();
    bodies_.reset();
    found_.clear();
    for (auto& shown : shown_)
        shown.clear();
}

/// The scene with this number, loaded on first use; null for none.
Replayer::Touched* Replayer::touched(uint32_t number) {
    if (number == 0)
        return nullptr;
    if (sculpted_.contains(number))
        return sculpted(number);
    std::unique_ptr<Touched>& entry = loaded_[number];
    if (entry == nullptr) {
        const auto scene = scenes_.find(number);
        if (scene == scenes_.end())
            throw Error("recording", "", "touches a scene that it does not name", "the file is damaged");
        entry = std::make_unique<Touched>();
        entry->scene = load_(scene->second);
        entry->world = WorldState(entry->scene.source, *entry->scene.haptic);
        if (entry->world.bodies() != nullptr)
            entry->world.bodies()->setFinding(body::BodyWorld::Finding::Replayed);
    }
    return entry.get();
}

uint32_t Replayer::rootOf(uint32_t scene) const {
    const auto found = sculpted_.find(scene);
    return found != sculpted_.end() ? found->second.root : scene;
}

/// The root's scene after the journal's entries up to those of `number`.
Replayer::Touched* Replayer::sculpted(uint32_t number) {
    const EditedScene& wanted = sculpted_.at(number);
    std::unique_ptr<Edited>& edited = edited_[wanted.root];
    if (edited != nullptr && edited->number == number)
        return &edited->touched;
    const Touched* const root = touched(wanted.root);
    if (root == nullptr || sculpted_.contains(wanted.root))
        throw Error("recording", "", "sculpts a scene that it does not name", "the file is damaged");
    if (edited == nullptr || edited->applied > wanted.entries)
        edited = std::make_unique<Edited>(SceneSculptor(root->scene.haptic));
    const std::vector<SculptEntry>& journal = journals_.at(wanted.root);
    if (wanted.entries > journal.size())
        throw Error("recording", "", "lacks a part of what was sculpted", "the file is damaged");
    for (; edited->applied < wanted.entries; ++edited->applied)
        (void)edited->sculptor.apply(journal[edited->applied]);
    edited->sculptor.settle();
    edited->number = number;
    edited->touched.scene = {edited->sculptor.scene(), root->scene.source};
    edited->touched.world = WorldState(root->scene.source, *edited->touched.scene.haptic,
                                       WorldBodies::Simulated, nullptr, root->world.textures());
    if (edited->sculptor.hash() != wanted.hash && !change_)
        differs({.stage = "field"});
    return &edited->touched;
}

/// With other settings, the scene's next edit: the hands' own state goes on as on the servo (adopt). False
/// where it is another scene.
bool Replayer::takeUp(const RecordedTick& tick) {
    if (rootOf(tick.scene) != rootOf(scene_) || tick.scene == 0)
        return false;
    Touched* const touched = this->touched(tick.scene);
    putDriven(tick, *touched);
    touched->world.forget();
    if (std::isfinite(previousTime_))
        touched->world.advance(previousTime_);
    const HapticScene& scene = *touched->scene.haptic;
    const ObjectMotions moved = touched->world.poses();
    const auto edited = edited_.find(rootOf(tick.scene));
    const std::vector<int> reshaped =
        edited != edited_.end() ? edited->second->sculptor.sculpted() : std::vector<int>();
    for (DeviceState& device : devices_)
        takeUpReshaped(scene, moved.empty() ? ObjectMotions(scene.restMotions) : moved, reshaped, device);
    scene_ = tick.scene;
    return true;
}

/// Where the recording says what a caller moved before `tick`, the objects are there.
void Replayer::putDriven(const RecordedTick& tick, Touched& touched) const {
    const auto state = driven_.find(tick.tick);
    if (state == driven_.end())
        return;
    const size_t objects = touched.scene.haptic->objects.size();
    for (const DrivenPose& pose : state->second.poses())
        if (static_cast<size_t>(pose.object) >= objects)
            throw Error("recording", "", "moves an object that its scene does not have",
                        "the file is damaged, or its scene is another one now");
    if (touched.world.driven() == nullptr)
        touched.world =
            WorldState(touched.scene.source, *touched.scene.haptic, WorldBodies::Simulated,
                       touched.world.bodies(), touched.world.textures(), std::make_shared<DrivenObjects>());
    touched.world.driven()->restore(state->second);
}

/// Restores the state of every hand at the checkpoint before `tick`.
void Replayer::resume(const RecordedTick& tick) {
    Touched* const touched = this->touched(tick.scene);
    const HapticScene* const scene = touched != nullptr ? touched->scene.haptic.get() : nullptr;
    const double came = checkpoint_->previousTime;
    otherStates_[0] = *checkpoint_;
    // Without a gap before it, it must equal the state after the preceding ticks.
    const bool goesOn = known_ && scene_ == tick.scene && came == previousTime_;
    devices_.resize(ticks_.size());
    pads_.resize(ticks_.size());
    samples_.resize(ticks_.size());
    outputs_.resize(ticks_.size());
    traces_.resize(ticks_.size());
    known_ = true;
    for (uint32_t hand = 0; hand < devices_.size(); ++hand) {
        const auto state = otherStates_.find(hand);
        if (state == otherStates_.end() || state->second.tick != tick.tick) {
            known_ = false;
            continue;
        }
        if (goesOn && !change_) {
            TouchCheckpoint own;
            takeCheckpoint(devices_[hand], own);
            const bool displays = ticks_[hand].pad.limits.reach > 0.0;
            if (!std::ranges::equal(own.state(), state->second.state()) ||
                (displays && pads_[hand].last != ticks_[hand].pad.before))
                differs({.tick = tick.tick, .time = tick.time, .hand = hand, .stage = "state"});
        }
        pads_[hand].last = ticks_[hand].pad.before;
        known_ &= restoreCheckpoint(state->second.state(), scene, devices_[hand]);
    }
    scene_ = tick.scene;
    if (!known_ || touched == nullptr)
        return;
    // A virtual point on a field is watched, too, and walks on no neighbours.
    if (std::ranges::any_of(devices_, [&](const DeviceState& device) {
            return device.watch.touching &&
                   scene->objects[static_cast<size_t>(device.reference)]->shape == nullptr;
        }))
        scene->buildNeighbourhoods();
    putDriven(tick, *touched);
    if (!goesOn) {
        touched->world.forget();
        if (std::isfinite(came))
            touched->world.advance(came);
    }
    if (touched->world.textures() != nullptr && !goesOn)
        known_ &= restoreTextures(tick, *touched->world.textures());
    if (!known_)
        return;
    // A scene with bodies is known where their state is.
    if ((touched->world.bodies() != nullptr || touched->world.soft() != nullptr) && !(goesOn && change_))
        known_ = bodies_ && bodies_->tick == tick.tick && touched->world.restoreBodies(bodies_->bytes);
}

const WorldState* Replayer::rootWorld() const {
    const auto scene = loaded_.find(rootOf(scene_));
    return scene != loaded_.end() && scene->second != nullptr ? &scene->second->world : nullptr;
}

std::span<const DrivenPose> Replayer::moved() const {
    const WorldState* const world = rootWorld();
    return world != nullptr && world->driven() != nullptr ? world->driven()->newest().poses()
                                                          : std::span<const DrivenPose>{};
}

const body::BodyWorld* Replayer::bodies() const {
    const WorldState* const world = rootWorld();
    return world != nullptr ? world->bodies().get() : nullptr;
}

/// The state before `tick`: the last whole one and the strokes since. False where that does not fit.
bool Replayer::restoreTextures(const RecordedTick& tick, PersistentTextures& textures) const {
    if (textures_.empty() || textures_[0].tick > tick.tick)
        return false;
    textures.reset();
    for (const RecordedTextures& part : textures_)
        for (const RecordedTextures::Tile& tile : part.tiles) {
            PersistentTexture* const texture = textures.at(static_cast<int>(tile.object));
            if (texture == nullptr || tile.tile >= texture->tiles())
                return false;
            const PersistentTexture::Place place = texture->placeOf(tile.tile);
            std::vector<float> values = tile.values;
            if (values.size() == 1)
                values.resize(size_t{place.width} * place.height, tile.values[0]);
            if (!texture->setTile(tile.tile, values))
                return false;
        }
    for (size_t k = 0; k < textures.objects(); ++k)
        if (PersistentTexture* const texture = textures.at(static_cast<int>(k)))
            texture->settle();
    for (const BrushStroke& stroke : strokes_)
        if (stroke.tick < tick.tick)
            textures.apply({&stroke, 1});
    return true;
}

/// True where the tick made the recorded strokes, so that the textures are the recorded ones.
bool Replayer::sameStrokes(const RecordedTick& tick, const PersistentTextures* textures) {
    while (nextStroke_ < strokes_.size() && strokes_[nextStroke_].tick < tick.tick)
        ++nextStroke_;
    const size_t first = nextStroke_;
    while (nextStroke_ < strokes_.size() && strokes_[nextStroke_].tick == tick.tick)
        ++nextStroke_;
    const auto recorded = std::span(strokes_).subspan(first, nextStroke_ - first);
    const std::span<const BrushStroke> made =
        textures != nullptr ? textures->strokes() : std::span<const BrushStroke>();
    return std::ranges::equal(recorded, made, [](BrushStroke a, BrushStroke b) {
        a.tick = b.tick = 0;
        return a == b;
    });
}

void Replayer::step(const RecordedTick& tick) {
    const auto settings = settings_.find(tick.settings);
    if (settings == settings_.end())
        throw Error("recording", "tick " + std::to_string(tick.tick), "has settings that are not there",
                    "the file is damaged");
    if (tick.checkpoint) // as the servo did, also where the checkpoint itself was lost
        for (DeviceState& device : devices_)
            device.candidates.invalidate();
    std::ranges::fill(outputs_, HapticOutput{});
    std::ranges::fill(traces_, StageTrace{});
    int64_t stepNs = 0;
    uint32_t poses = 0;
    bool texturesEqual = true;
    double animated = tick.time;
    if (Touched* const touched = this->touched(tick.scene)) {
        const HapticScene& scene = *touched->scene.haptic;
        // Data for the neighbourhood watch and rays became available when built, in the middle of the run.
        if (change_ || !has(tick.flags, TickFlag::NeighbourhoodMissing)) {
            if (settings->second.contact == ContactMethod::Neighbourhood)
                scene.buildNeighbourhoods();
            if (settings->second.contact == ContactMethod::Rays)
                scene.buildRays();
        }
        const std::optional<DeviceLimits>& limits =
            scenes_.at(rootOf(tick.scene)).identity.limits; // of format 1
        for (size_t hand = 0; hand < ticks_.size(); ++hand) {
            samples_[hand] = ticks_[hand].sample;
            if (limits)
                samples_[hand].limits = *limits;
        }
        if (touched->world.bodies() != nullptr)
            if (const auto found = found_.find(tick.tick); found != found_.end())
                touched->world.bodies()->repeat(found->second);
        putDriven(tick, *touched);
        if (touched->world.driven() != nullptr)
            touched->world.driven()->setStep(tick.dt);
        animated = animationTime(settings->second, tick.time);
        // A replay has its vertices in time: it stands still where the servo did.
        touched->world.advance(animated, has(tick.flags, TickFlag::DeformationHeld));
        poses = touched->world.poseHash();
        const TickInput input{.tick = tick.tick,
                              .time = tick.time,
                              .dt = tick.dt,
                              .late = tick.late,
                              .hands = samples_,
                              .tool = tool_.active ? &tool_ : nullptr};
        StageTracer tracer(devices_, traces_);
        const long long begin = monotonicNs();
        hapticStep(scene, settings->second, input, touched->world, devices_, outputs_, tracer);
        texturesEqual = sameStrokes(tick, touched->world.textures().get());
        stepNs = monotonicNs() - begin;
        report_.seconds += report_.replayed > 0 ? tick.dt : 0.0;
    }
    bool locationsEqual = true;
    for (uint32_t hand = 0; hand < ticks_.size(); ++hand)
        locationsEqual &= sameLocation(hand, ticks_[hand], settings->second);
    previousTime_ = animated;
    ++report_.replayed;
    if (change_) {
        if (each_ != nullptr && *each_)
            (*each_)(tick, outputs_[0], stepNs, false);
        return;
    }
    const bool posesEqual = tick.poses.value_or(poses) == poses;
    if (!posesEqual)
        differs({.tick = tick.tick, .time = tick.time, .stage = "poses"});
    const bool equal = compare(0, tick);
    bool allEqual = equal && posesEqual && texturesEqual && locationsEqual;
    for (uint32_t hand = 1; hand < ticks_.size(); ++hand)
        allEqual &= compare(hand, ticks_[hand]);
    if (!texturesEqual)
        differs({.tick = tick.tick, .time = tick.time, .stage = "textures"});
    report_.differing += allEqual ? 0 : 1;
    if (each_ != nullptr && *each_)
        (*each_)(tick, outputs_[0], stepNs, equal);
}

void Replayer::differs(const Difference& difference) {
    if (!report_.first)
        report_.first = difference;
}

/// Makes the tick's contact location; true where it has the recorded bits, or is none to compare.
bool Replayer::sameLocation(uint32_t hand, const RecordedTick& tick, const HapticSettings& settings) {
    const PadCommand made =
        padStep(samples_[hand], outputs_[hand], settings.forceEnabled, tick.dt, tick.pad.limits, pads_[hand]);
    if (change_ || made.location() == tick.pad.location)
        return true;
    differs({.tick = tick.tick, .time = tick.time, .hand = hand, .stage = "contact location"});
    return false;
}

/// True where every stage of the hand has the recorded bits.
bool Replayer::compare(uint32_t hand, const RecordedTick& tick) {
    const HapticOutput& output = outputs_[hand];
    const StageHashes hashes = stageHashes(traces_[hand], output);
    if (hashes == tick.hashes)
        return true;
    const auto stage = static_cast<size_t>(std::ranges::mismatch(hashes, tick.hashes).in1 - hashes.begin());
    differs({.tick = tick.tick,
             .time = tick.time,
             .hand = hand,
             .stage = std::string(kStageNames[stage]),
             .recordedProxy = tick.proxy,
             .replayedProxy = output.proxy,
             .recordedForce = tick.force,
             .replayedForce = output.force});
    return false;
}

} // namespace touchstone
