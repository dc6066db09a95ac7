#include "workbench/commands/touch_sculpt.h"

#include "workbench/files/sculpted_file.h"

#include <nlohmann/json.hpp>

#include <cstdio>
#include <string>
#include <utility>

namespace touchstone {

TouchSculpt::TouchSculpt(const std::filesystem::path& journal, std::shared_ptr<const HapticScene> scene)
    : steps_(readSculptJournal(journal)), sculptor_(std::move(scene)) {
    while (waits() && !steps_[next_].time)
        apply();
}

void TouchSculpt::apply() {
    const SculptReport one = sculptor_.apply(steps_[next_++]);
    all_.removed += one.removed;
    all_.dabs += one.dabs;
    all_.bricks += one.bricks;
}

bool TouchSculpt::applyUntil(double time) {
    if (!waits() || *steps_[next_].time > time)
        return false;
    const std::shared_ptr<const HapticScene> was = sculptor_.scene();
    while (waits() && *steps_[next_].time <= time)
        apply();
    if (sculptor_.scene() == was)
        return false;
    before_ = was;
    return true;
}

std::string TouchSculpt::hashText() const {
    char text[24];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(sculptor_.hash()));
    return text;
}

nlohmann::ordered_json TouchSculpt::json() const {
    return {{"steps", next_},
            {"steps_left", steps_.size() - next_},
            {"dabs", all_.dabs},
            {"removed_m3", all_.removed},
            {"hash", hashText()}};
}

void TouchSculpt::finish(const std::vector<std::filesystem::path>& files) const {
    std::string first;
    for (const SculptStep& step : steps_)
        if (step.action == SculptAction::Stroke) {
            first = step.object;
            break;
        }
    for (const std::filesystem::path& file : files) {
        const size_t object = sculptor_.objectNamed(first);
        if (const size_t triangles = writeSculpted(file, *sculptor_.scene(), object); triangles > 0)
            std::printf("%zu triangles, written to %s\n", triangles, file.c_str());
    }
    std::printf("%zu strokes, %zu dabs, %.6g mm^3 removed, field %s\n", next_, all_.dabs, 1e9 * all_.removed,
                hashText().c_str());
    if (waits())
        std::fprintf(stderr, "touchstone: warning: %zu strokes come after the last tick\n",
                     steps_.size() - next_);
}

} // namespace touchstone
