#include "workbench/commands/run_sculpt.h"

#include "engine/core/error.h"
#include "engine/time/seconds_now.h"
#include "workbench/files/sculpted_file.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>

namespace touchstone {

namespace {

nlohmann::ordered_json delayJson(std::vector<double> delays) {
    if (delays.empty())
        return {};
    std::ranges::sort(delays);
    const auto at = [&](double fraction) {
        return 1e3 * delays[static_cast<size_t>(fraction * static_cast<double>(delays.size() - 1))];
    };
    return {{"p50", at(0.5)}, {"p99", at(0.99)}, {"max", at(1.0)}};
}

} // namespace

RunSculpt::RunSculpt(const SculptOptions& options, const Model& model)
    : options_(options), last_(model.haptic) {
    const SceneSculptor named(model.haptic);
    tool_ = options.tool;
    tool_.active = tool_.held = true;
    tool_.object = static_cast<int32_t>(named.objectNamed(""));
    for (size_t k = 0; k < model.haptic->objects.size() && !options.stamp.empty(); ++k)
        if (model.haptic->objects[k]->name == options.stamp)
            tool_.stamp = static_cast<int32_t>(k);
    if (!options.stamp.empty() && tool_.stamp < 0)
        throw Error("sculpting", "", "the scene has no object " + options.stamp + " to stamp with",
                    "name one of its objects");
}

void RunSculpt::start(Session& session) {
    session.sculptor().setTool(tool_);
}

void RunSculpt::take(const TickRecord& record, const HapticSettings&) {
    if (record.hand == 0 && record.editDelay > 0)
        delays_.push_back(1e-3 * record.editDelay);
}

void RunSculpt::finish(Session& session) {
    session.sculptor().drain();
    session.pump(secondsNow());
    const SculptFigures figures = session.sculptor().figures();
    const auto object = static_cast<size_t>(tool_.object);
    for (const std::filesystem::path& file : options_.files)
        if (const size_t triangles = writeSculpted(file, *last_, object); triangles > 0)
            std::printf("%zu triangles, written to %s\n", triangles, file.c_str());
    std::printf("%llu dabs, %.6g mm^3 removed, field %016llx\n",
                static_cast<unsigned long long>(figures.dabs), 1e9 * figures.removed,
                static_cast<unsigned long long>(figures.hash));
    if (!figures.problem.empty())
        std::fprintf(stderr, "touchstone: warning: %s\n", figures.problem.c_str());
}

nlohmann::ordered_json RunSculpt::json(const Session& session, double seconds) const {
    const SculptFigures figures = session.sculptor().figures();
    char hash[24];
    std::snprintf(hash, sizeof hash, "%016llx", static_cast<unsigned long long>(figures.hash));
    return {{"tool", infoOf(tool_.tool).name},
            {"radius_m", tool_.radius},
            {"dabs", figures.dabs},
            {"thinned", figures.thinned},
            {"dropped", session.servo().droppedEdits()},
            {"scenes", figures.scenes},
            {"scenes_per_second", static_cast<double>(figures.scenes) / seconds},
            {"felt_after_ms", delayJson(delays_)},
            {"longest_dab_ms", 1e3 * figures.longestDab},
            {"removed_m3", figures.removed},
            {"strokes", figures.undoSteps},
            {"history_bytes", figures.memory},
            {"hash", hash}};
}

} // namespace touchstone
