#include "workbench/timeline/verification.h"

#include <cstdio>

namespace touchstone {

Verdict verify(const Timeline& timeline, RecordedSceneShelf& shelf, JobProgress& progress) {
    RecordingReader reader(timeline.file());
    Verdict verdict;
    Replayer replayer([&](const RecordedScene& scene) {
        const FoundScene found = shelf.get(scene);
        if (const std::string change = found.change(); !change.empty())
            verdict.changes.push_back(found.path.filename().string() + " " + change);
        return found.scene;
    });
    uint64_t done = 0;
    const auto ticks = static_cast<double>(timeline.size());
    verdict.report = replayer.replay(reader, [&](const RecordedTick&, const HapticOutput&, int64_t, bool) {
        progress.at(static_cast<double>(++done) / ticks);
    });
    return verdict;
}

std::string Verdict::text() const {
    char text[192];
    const auto number = [](uint64_t n) { return static_cast<unsigned long long>(n); };
    if (report.replayed == 0)
        return "none of its ticks can be touched again: what they began with is missing";
    if (!report.first)
        std::snprintf(text, sizeof text, "equal to the last bit in %llu ticks", number(report.replayed));
    else
        std::snprintf(text, sizeof text,
                      "tick %llu (%.3f s) differs first, %sin the stage '%s'; %llu of %llu ticks differ",
                      number(report.first->tick), report.first->time, whichHand(report).c_str(),
                      report.first->stage.c_str(), number(report.differing), number(report.replayed));
    std::string all = text;
    if (report.ticks > report.replayed)
        all += "; " + std::to_string(report.ticks - report.replayed) + " ticks behind gaps were left out";
    for (const std::string& change : changes)
        all += "; " + change;
    return all;
}

} // namespace touchstone
