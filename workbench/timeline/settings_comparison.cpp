#include "workbench/timeline/settings_comparison.h"

#include "engine/core/error.h"

#include <exception>
#include <utility>
#include <vector>

namespace touchstone {

namespace {

/// The force key changes no contact.
HapticSettings withForce(HapticSettings settings) {
    settings.forceEnabled = true;
    return settings;
}

} // namespace

ComparedTouch compareTouch(const Timeline& timeline, RecordedSceneShelf& shelf,
                           const HapticSettings& settings, JobProgress& progress) {
    ComparedTouch compared{.settings = settings, .change = {}, .force = {}, .figures = {}};
    if (timeline.settings().empty())
        throw Error(timeline.file().string(), "", "has no settings to compare with", "");
    compared.change = settingsDifference(withForce(timeline.settingsOf(0)), withForce(settings));
    std::vector<float> force(timeline.size());
    for (size_t i = 0; i < force.size(); ++i)
        force[i] = timeline.force()[i];
    size_t begin = 0, replayed = 0; // of the block, of all
    const RecordedTicks* block = nullptr;
    const Replayer::Each each = [&](const RecordedTick& tick, const HapticOutput& output, int64_t, bool) {
        const size_t at = begin + static_cast<size_t>(&tick - block->ticks.data());
        if (at >= force.size())
            throw Error(timeline.file().string(), "", "is no longer what it was when it was opened",
                        "open it again");
        force[at] = static_cast<float>(glm::length(output.force));
        compared.figures.add(timeline.seconds(at), tick, output);
        progress.at(static_cast<double>(++replayed) / static_cast<double>(force.size()));
    };
    Replayer replayer([&](const RecordedScene& scene) { return shelf.get(scene).scene; },
                      [&](const HapticSettings& recorded) {
                          HapticSettings changed = settings;
                          changed.forceEnabled = recorded.forceEnabled;
                          return changed;
                      });
    RecordingReader reader(timeline.file());
    replayer.begin(each);
    while (const std::optional<RecordingReader::Item> item = reader.next()) {
        block = std::get_if<RecordedTicks>(&item->item);
        replayer.take(*item);
        begin += block != nullptr ? block->ticks.size() : 0;
    }
    compared.missing = force.size() - replayed;
    compared.force = MinMaxPyramid(std::move(force));
    return compared;
}

std::string ComparedTouch::text() const {
    std::string text = figures.text(change.empty() ? "with the same settings" : "with " + change);
    if (missing > 0)
        text += "; " + std::to_string(missing) + " ticks behind gaps are as recorded";
    return text;
}

void SettingsComparison::want(bool wanted) {
    wanted_ = wanted;
    job_.abandon();
    asked_.reset();
    result_.reset();
    problem_.clear();
}

void SettingsComparison::take() {
    try {
        if (std::optional<std::shared_ptr<const ComparedTouch>> made = job_.take()) {
            result_ = std::move(*made);
            problem_.clear();
        }
    } catch (const std::exception& error) {
        result_.reset();
        problem_ = error.what();
    }
}

void SettingsComparison::update(const Recording& timeline, const Shelf& shelf,
                                const HapticSettings& settings) {
    take();
    if (!wanted_)
        return;
    HapticSettings now = withForce(settings);
    if (asked_ == now)
        return;
    job_.abandon(); // a slider that is dragged asks for another one with each picture
    asked_.reset();
    if (job_.busy())
        return;
    asked_ = now;
    job_.start([timeline, shelf, now](JobProgress& progress) {
        return std::make_shared<const ComparedTouch>(compareTouch(*timeline, *shelf, now, progress));
    });
}

} // namespace touchstone
