#include "haptics/recording/servo_recorder.h"

#include <exception>
#include <utility>

namespace touchstone {

/// A recording that fails, for lack of disk space or memory, ends; the other one continues.
template <class Action>
void ServoRecorder::guarded(const Action& action, bool flight) {
    try {
        action();
    } catch (const std::exception& error) {
        problem_ += (problem_.empty() ? "" : "\n") + std::string(error.what());
        if (flight)
            flight_.reset();
        else {
            writer_.reset();
            failed_ = true;
        }
    }
}

void ServoRecorder::start(const std::filesystem::path& file, const std::string& command) {
    writer_.reset();
    writer_.emplace(file, recordingOrigin(command, servo_.rateHz()));
    file_ = file;
    ticks_ = 0;
    servo_.requestCheckpoint();
}

void ServoRecorder::stop() {
    if (!writer_)
        return;
    guarded([&] { writer_->finish(); }, false);
    writer_.reset();
}

void ServoRecorder::sceneSculpted(uint32_t number, uint32_t root, uint64_t hash,
                                  std::span<const SculptEntry> entries) {
    std::vector<SculptEntry>& journal = journals_[root];
    journal.insert(journal.end(), entries.begin(), entries.end());
    sculpted_[number] = {root, hash, journal.size()};
}

void ServoRecorder::take(const TickRecord& record) {
    TouchCheckpoint checkpoint;
    bool found = false;
    // Checkpoints of records that were dropped come first.
    while (record.checkpoint && !found && servo_.popCheckpoint(checkpoint))
        found = checkpoint.tick == record.tick && checkpoint.scene == record.scene &&
                checkpoint.hand == record.hand;
    const RecordedTick recorded = writer_ || flight_ ? recordedTick(record) : RecordedTick{};
    if (record.hand > 0) {
        others_.push_back({record.hand, recorded, found ? std::optional(checkpoint) : std::nullopt});
        return;
    }
    if (std::exchange(lastTick_, record.tick) >= record.tick) // the servo was started again
        bodies_.clear();
    // Popped whether anybody records or not, so that the next ones find room.
    while (record.checkpoint && (bodies_.empty() || bodiesTick_ < record.tick) &&
           servo_.popBodyState(bodiesTick_, bodies_))
        continue;
    const bool bodies = record.checkpoint && !bodies_.empty() && bodiesTick_ == record.tick;
    const std::shared_ptr<PersistentTextures> textures = servo_.texturesOf(record.root);
    textures_.follow(textures);
    const std::span<const BrushStroke> strokes = textures_.next(record.tick);
    found &= textures == nullptr || textures_.state() != nullptr; // no replay begins where they are lost
    const DrivenState* const driven = servo_.drivenBefore(record);
    found &= driven != nullptr || !record.checkpoint || !servo_.drives(record.root); // as of the textures
    const std::vector<HandToRecord> others = std::exchange(others_, {});
    const uint64_t lost = record.step - nextStep_;
    nextStep_ = record.step + 1;
    forgetBefore(record);
    if (!writer_ && !flight_)
        return;
    const auto scene = scenes_.find(record.root);
    const auto sculptedScene = sculpted_.find(record.scene);
    SculptToRecord sculpt;
    const bool isSculpted = sculptedScene != sculpted_.end();
    if (isSculpted)
        sculpt = {sculptedScene->second.root, sculptedScene->second.hash,
                  std::span(journals_[sculptedScene->second.root]).first(sculptedScene->second.entries)};
    const TickToRecord tick{.tick = recorded,
                            .settings = servo_.settingsOf(record.settings),
                            .scene = scene != scenes_.end() ? &scene->second : nullptr,
                            .checkpoint = found ? &checkpoint : nullptr,
                            .whole = record.whole && (bodies || !record.keptState),
                            .lostBefore = lost,
                            .others = others,
                            .sculpt = isSculpted ? &sculpt : nullptr,
                            .toolNumber = record.tool,
                            .tool = servo_.toolOf(record.tool),
                            .bodies = bodies ? &bodies_ : nullptr,
                            .textures = textures_.state(),
                            .strokes = strokes,
                            .driven = driven};
    if (writer_)
        guarded([&] { writer_->add(tick); }, false);
    if (flight_)
        guarded([&] { flight_->add(tick); }, true);
}

/// No later record names the scenes before. A program that edits a material for hours offers one with each
/// edit.
void ServoRecorder::forgetBefore(const TickRecord& record) {
    scenes_.erase(scenes_.begin(), scenes_.lower_bound(record.root));
    journals_.erase(journals_.begin(), journals_.lower_bound(record.root));
    sculpted_.erase(sculpted_.begin(), sculpted_.lower_bound(record.scene));
}

void ServoRecorder::flush() {
    if (writer_)
        guarded(
            [&] {
                writer_->flush();
                ticks_ = writer_->ticks();
            },
            false);
    if (flight_)
        guarded([&] { flight_->flush(); }, true);
}

void ServoRecorder::finish() {
    flush();
    stop();
    if (flight_)
        guarded([&] { flight_->finish(); }, true);
}

std::vector<KeptFlight> ServoRecorder::takeKept() {
    return flight_ ? flight_->takeKept() : std::vector<KeptFlight>();
}

} // namespace touchstone
