#include "haptics/recording/replayer.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "haptics/body/body_world.h"

#include <algorithm>
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
                                       WorldBodies::Simulated, root->world.carriedOver());
    if (edited->sculptor.hash() != wanted.hash && !change_)
        differs({.stage = "field"});
    return &edited->touched;
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

} // namespace touchstone
