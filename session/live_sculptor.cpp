#include "session/live_sculptor.h"

#include "engine/core/float_mode.h"
#include "engine/time/seconds_now.h"

#include <algorithm>
#include <chrono>
#include <exception>

namespace touchstone {

namespace {

constexpr auto kPoll = std::chrono::milliseconds(1); // the servo cannot wake a thread without a lock

/// Leaves out every second dab of the same stroke, after the first `felt` entries; what Drag moves by is
/// passed on.
uint64_t thin(std::deque<SculptEntry>& waiting, size_t felt) {
    std::deque<SculptEntry> kept;
    uint64_t left = 0;
    glm::dvec3 motion(0.0);
    bool leave = false;
    for (size_t i = 0; i < waiting.size(); ++i) {
        SculptEntry entry = waiting[i];
        const bool plain = entry.kind == SculptEntryKind::Dab && i > felt && i + 1 < waiting.size() &&
                           waiting[i - 1].kind == SculptEntryKind::Dab &&
                           waiting[i + 1].kind == SculptEntryKind::Dab;
        leave = plain && !leave;
        if (leave) {
            motion += entry.motion;
            ++left;
            continue;
        }
        entry.motion += std::exchange(motion, glm::dvec3(0.0));
        kept.push_back(entry);
    }
    waiting = std::move(kept);
    return left;
}

SculptEntry as(SculptEntryKind kind, SculptEntry entry) {
    entry.kind = kind;
    return entry;
}

} // namespace

LiveSculptor::~LiveSculptor() {
    wanted_.store(true, std::memory_order_relaxed); // no more previews
    {
        const std::scoped_lock lock(mutex_);
        stopping_ = true;
    }
    wake_.notify_all();
    if (worker_.joinable())
        worker_.join();
}

/// The owner's turn: the worker does not take the next one.
std::unique_lock<std::mutex> LiveSculptor::stopApplying() {
    wanted_.store(true, std::memory_order_relaxed);
    std::unique_lock lock(applying_);
    wanted_.store(false, std::memory_order_relaxed);
    return lock;
}

void LiveSculptor::begin(uint32_t number, std::shared_ptr<const HapticScene> scene, ScenePtr source) {
    const std::unique_lock applying = stopApplying();
    const std::scoped_lock lock(mutex_);
    sculptor_.reset();
    if (scene != nullptr)
        sculptor_.emplace(std::move(scene));
    source_ = std::move(source);
    root_ = oldestRoot_ = number;
    waiting_.clear();
    previewed_ = 0;
    journal_.clear();
    sent_ = 0;
    made_ = offered_ = 0;
    figures_ = {};
}

std::optional<uint32_t> LiveSculptor::carryOver(std::shared_ptr<const HapticScene> scene, ScenePtr source,
                                                SceneSwap swap) {
    const std::unique_lock applying = stopApplying();
    if (!sculptor_ || journal_.empty())
        return std::nullopt;
    sculptor_->moveTo(std::move(scene));
    source_ = std::move(source);
    root_ = servo_.nextSceneNumber();
    noteOffered();
    servo_.offerSculpted(published(true), swap);
    // What was published before is of a root that nobody shows any more, but its bricks have changed.
    const std::scoped_lock lock(mutex_);
    auto& now = published_.back().changed;
    for (size_t i = 0; i + 1 < published_.size(); ++i)
        now.insert(now.end(), published_[i].changed.begin(), published_[i].changed.end());
    return root_;
}

void LiveSculptor::startWorker() {
    if (!worker_.joinable())
        worker_ = std::thread([this] { work(); });
}

void LiveSculptor::setTool(const LiveTool& tool) {
    if (tool == tool_)
        return;
    tool_ = tool;
    servo_.setTool(tool);
    if (!tool.active && !worker_.joinable())
        return;
    {
        const std::scoped_lock lock(mutex_);
        active_ = tool.active;
        startWorker();
    }
    wake_.notify_all();
}

void LiveSculptor::command(SculptEntryKind kind) {
    add({.kind = kind});
}

void LiveSculptor::add(const SculptEntry& entry) {
    {
        const std::scoped_lock lock(mutex_);
        waiting_.push_back(entry);
        startWorker();
    }
    wake_.notify_all();
}

std::vector<SculptedScene> LiveSculptor::take() {
    const std::scoped_lock lock(mutex_);
    return std::exchange(published_, {});
}

SculptFigures LiveSculptor::figures() const {
    const std::scoped_lock lock(mutex_);
    return figures_;
}

void LiveSculptor::drain() {
    std::unique_lock lock(mutex_);
    if (!worker_.joinable())
        return;
    gather();
    wake_.notify_all();
    idle_.wait(lock, [this] { return waiting_.empty() && !busy_; });
}

/// What the hands made.
void LiveSculptor::gather() {
    for (SculptEntry entry; servo_.popEdit(entry);)
        if (std::exchange(entry.root, 0) >= oldestRoot_)
            waiting_.push_back(entry);
    while (waiting_.size() > previewed_ + kMostWaiting) {
        const uint64_t left = thin(waiting_, previewed_);
        figures_.thinned += left;
        if (left == 0)
            break;
    }
}

void LiveSculptor::work() {
    enterFloatMode(); // as a replay: the same bits
    for (;;) {
        // The servo may adopt a scene while the next is offered, which then waits until the scene before is
        // collected: the last edit would be felt with the edit after it.
        const bool offered = servo_.editedPending();
        if (offered) {
            const std::scoped_lock applying(applying_);
            servo_.collectEdited();
        }
        {
            std::unique_lock lock(mutex_);
            if (stopping_)
                return;
            gather();
            busy_ = !waiting_.empty();
            if (!busy_) {
                idle_.notify_all();
                if (active_ || offered)
                    wake_.wait_for(lock, kPoll);
                else
                    wake_.wait(lock, [this] { return stopping_ || active_ || !waiting_.empty(); });
                continue;
            }
        }
        while (wanted_.load(std::memory_order_relaxed)) {
            std::this_thread::sleep_for(kPoll);
            const std::scoped_lock lock(mutex_);
            if (stopping_)
                return;
        }
        const std::scoped_lock applying(applying_);
        servo_.collectEdited();
        applyWaiting();
    }
}

std::optional<SculptEntry> LiveSculptor::next() {
    const std::scoped_lock lock(mutex_);
    return waiting_.empty() ? std::nullopt : std::optional(takeFront());
}

SculptEntry LiveSculptor::takeFront() {
    const SculptEntry entry = waiting_.front();
    waiting_.pop_front();
    previewed_ -= previewed_ > 0 ? 1 : 0;
    return entry;
}

/// As many entries as kPublish allows, or one up to its shape, then a publication; once more with distances
/// where a shape was made, after what the hand makes beside it.
void LiveSculptor::applyWaiting() {
    const double begin = secondsNow();
    const size_t before = journal_.size();
    while (journal_.size() == before || secondsNow() - begin < kPublish) {
        std::optional<SculptEntry> entry = next();
        if (!entry)
            break;
        const bool shapes = sculptor_ && restoring_ > kWhole && sculptor_->canShape(*entry);
        if (shapes)
            entry->kind = SculptEntryKind::Shape;
        apply(*entry);
        if (shapes)
            break;
    }
    if (journal_.size() == before || !sculptor_)
        return;
    publish();
    std::optional<int32_t> object = sculptor_->owesDistances();
    for (int shapes = 1; object; object = sculptor_->owesDistances()) {
        const size_t made = journal_.size();
        if (const auto joined = shapes < kMostShapes ? nextBeside() : std::nullopt) {
            apply(as(SculptEntryKind::Shape, *joined));
            ++shapes;
        } else {
            apply({.kind = SculptEntryKind::Restore, .object = *object});
            if (journal_.size() == made || journal_.back().kind != SculptEntryKind::Restore)
                break;                // it failed: the next change begins with it
            shapes = makePreviewed(); // in the same publication: what is felt stays
        }
        if (journal_.size() > made)
            publish();
    }
}

/// Between steps of a restoration.
void LiveSculptor::previewWaiting(int32_t object) {
    servo_.collectEdited();
    const std::optional<SculptEntry> entry = nextPreview(object);
    if (!entry)
        return;
    const double begin = secondsNow();
    const size_t made = journal_.size();
    apply(as(SculptEntryKind::Preview, *entry));
    if (journal_.size() > made)
        publish();
    previewing_ += secondsNow() - begin;
}

/// The next entry that can be felt while distances of `object` are restored. Begins wait: a preview belongs
/// to no stroke.
std::optional<SculptEntry> LiveSculptor::nextPreview(int32_t object) {
    const std::scoped_lock lock(mutex_);
    gather();
    size_t at = previewed_;
    while (at < waiting_.size() && waiting_[at].kind == SculptEntryKind::Begin)
        ++at;
    if (at >= std::min(waiting_.size(), kMostPreviews) || wanted_.load(std::memory_order_relaxed) ||
        waiting_[at].object != object || !sculptor_->canShape(waiting_[at]))
        return std::nullopt;
    previewed_ = at + 1;
    return waiting_[at];
}

/// What is felt as previews, which ended with the restoration: as shapes where they leave their distances to
/// one restoration, else as previews again. Returns the number of shapes.
int LiveSculptor::makePreviewed() {
    const auto felt = [this](size_t at) -> std::optional<SculptEntry> {
        const std::scoped_lock lock(mutex_);
        return at < previewed_ ? std::optional(waiting_[at]) : std::nullopt;
    };
    int shapes = 0;
    for (std::optional<SculptEntry> first = felt(0); first; first = felt(0)) {
        const bool begins = first->kind == SculptEntryKind::Begin;
        if (!begins && sculptor_->owesDistances() && (shapes >= kMostShapes || !sculptor_->joins(*first)))
            break;
        {
            const std::scoped_lock lock(mutex_);
            (void)takeFront();
        }
        apply(begins ? *first : as(SculptEntryKind::Shape, *first), true);
        shapes += begins ? 0 : 1;
    }
    size_t at = 0;
    for (std::optional<SculptEntry> next = felt(at); next; next = felt(++at))
        if (next->kind != SculptEntryKind::Begin)
            apply(as(SculptEntryKind::Preview, *next), true);
    return shapes;
}

/// A scene that no tick has adopted leaves its edits to the next one. Where one is adopted right here, what
/// is measured is at most too long.
void LiveSculptor::noteOffered() {
    offered_ = servo_.editedPending() && offered_ > 0 ? offered_ : made_;
    made_ = 0;
}

void LiveSculptor::publish() {
    sculptor_->settle();
    noteOffered();
    servo_.offerEdited(published(false));
}

/// The next entry, where it leaves its distances to the same restoration as the last shape.
std::optional<SculptEntry> LiveSculptor::nextBeside() {
    const std::scoped_lock lock(mutex_);
    gather();
    if (waiting_.empty() || wanted_.load(std::memory_order_relaxed) || !sculptor_->joins(waiting_.front()))
        return std::nullopt;
    return takeFront();
}

/// `felt`: as a preview, before.
void LiveSculptor::apply(const SculptEntry& entry, bool felt) {
    if (!sculptor_)
        return;
    const double begin = secondsNow(), previewing = previewing_;
    SculptReport report;
    std::string problem;
    try {
        report = entry.kind == SculptEntryKind::Restore
                     ? sculptor_->restore(entry.object, [&] { previewWaiting(entry.object); })
                     : sculptor_->apply(entry);
        const bool made = entry.kind == SculptEntryKind::Dab || entry.kind == SculptEntryKind::Shape;
        // Else the object is hidden: it may come back.
        if (entry.kind == SculptEntryKind::Preview ? report.bricks > 0 : !made || report.dabs > 0) {
            journal_.push_back(entry);
            if (!felt && made_ == 0)
                made_ = entry.tick;
        }
    } catch (const std::exception& error) {
        problem = error.what();
    }
    const double seconds = secondsNow() - begin - (previewing_ - previewing);
    if (entry.kind == SculptEntryKind::Dab || entry.kind == SculptEntryKind::Restore)
        restoring_ = seconds;
    const std::scoped_lock lock(mutex_);
    figures_.dabs += report.dabs;
    figures_.removed += report.removed;
    if (entry.kind != SculptEntryKind::Restore || !problem.empty()) // nobody asked for it
        figures_.problem = std::move(problem);
    figures_.longestDab = std::max(figures_.longestDab, seconds);
}

/// The present scene, which the owner finds before the servo does. `whole`: with the whole journal.
ReshapedScene LiveSculptor::published(bool whole) {
    SculptedScene scene{.number = servo_.nextSceneNumber(),
                        .root = root_,
                        .haptic = sculptor_->scene(),
                        .source = source_,
                        .hash = sculptor_->hash()};
    const auto first = journal_.begin() + static_cast<ptrdiff_t>(whole ? 0 : sent_);
    scene.entries.assign(first, journal_.end());
    ReshapedScene offered{.scene = scene.haptic,
                          .source = source_,
                          .number = scene.number,
                          .root = root_,
                          .reshaped = sculptor_->sculpted()};
    offered.oldestEdit = offered_;
    sent_ = journal_.size();
    for (const int object : offered.reshaped)
        if (!scene.haptic->objects[static_cast<size_t>(object)]->empty()) // hidden: when it is shown again
            scene.changed.push_back({object, sculptor_->takeChangedBricks(object)});
    // It visits the whole history.
    constexpr double kMemoryEvery = 0.5; // s
    const double now = secondsNow();
    if (now - memoryAt_ > kMemoryEvery) {
        memory_ = sculptor_->memoryBytes();
        memoryAt_ = now;
    }
    const std::scoped_lock lock(mutex_);
    ++figures_.scenes;
    figures_.undoSteps = sculptor_->undoSteps();
    figures_.redoSteps = sculptor_->redoSteps();
    figures_.memory = memory_;
    figures_.hash = scene.hash;
    published_.push_back(std::move(scene));
    return offered;
}

} // namespace touchstone
