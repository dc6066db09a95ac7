// Recomputes a recording as fast as possible and compares the result.

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "haptics/recording/replayer.h"
#include "workbench/commands/replay_comparison.h"
#include "workbench/figures/tick_csv.h"
#include "workbench/figures/tick_statistics.h"
#include "workbench/options/commands.h"
#include "workbench/timeline/recorded_scenes.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <cstdio>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

namespace {

/// The scene's file: the given replacement, the recorded path, or beside the recording.
std::filesystem::path scenePath(const ReplayOptions& options, const SceneIdentity& recorded, size_t index) {
    if (!options.scenes.empty())
        return options.scenes[std::min(index, options.scenes.size() - 1)];
    if (const std::optional<std::filesystem::path> found = findRecordedScene(options.recording, recorded))
        return *found;
    throw Error(recorded.absolutePath.empty() ? recorded.path : recorded.absolutePath, "",
                "the scene that was touched is not there", "say with --scene where it is now");
}

/// Loads the recorded scenes and reports changes.
class SceneFinder {
  public:
    explicit SceneFinder(const ReplayOptions& options) : options_(options) {}

    ReplayScene load(const RecordedScene& recorded) {
        FoundScene found =
            loadRecordedScene(recorded, scenePath(options_, recorded.identity, scenes_.size()));
        if (const std::string change = found.change(); !change.empty())
            std::fprintf(stderr, "touchstone: warning: %s %s\n", found.path.c_str(), change.c_str());
        scenes_.push_back(found);
        return found.scene;
    }
    [[nodiscard]] const std::vector<FoundScene>& scenes() const { return scenes_; }

  private:
    const ReplayOptions& options_;
    std::vector<FoundScene> scenes_;
};

void tellOfOrigin(const RecordingOrigin& then) {
    const RecordingOrigin now = recordingOrigin("replay", 0.0);
    if (then.build != now.build)
        std::fprintf(stderr,
                     "touchstone: warning: recorded by another build (%s, %s): last bits may differ\n",
                     then.version.c_str(), then.compiler.c_str());
    if (then.processor != now.processor)
        std::fprintf(stderr,
                     "touchstone: warning: recorded on another processor (%s): last bits may differ\n",
                     then.processor.c_str());
}

void tellOfDamage(const ReplayOptions& options, const ReplayReport& report) {
    const char* file = options.recording.c_str();
    for (const std::string& damage : report.damage)
        std::fprintf(stderr, "touchstone: warning: %s: %s\n", file, damage.c_str());
    if (report.cutOff)
        std::fprintf(stderr,
                     "touchstone: warning: %s is cut off (the program that wrote it was killed, or the disk "
                     "was full): replayed as far as it goes\n",
                     file);
    if (report.gaps > 0)
        std::fprintf(stderr,
                     "touchstone: warning: %s: ticks are missing in %llu places (%llu were not recorded); "
                     "the replay went on at the next checkpoint, without %llu recorded ticks\n",
                     file, static_cast<unsigned long long>(report.gaps),
                     static_cast<unsigned long long>(report.lost),
                     static_cast<unsigned long long>(report.ticks - report.replayed));
    for (const RecordedNote& note : report.notes)
        std::printf("tick %llu: %s\n", static_cast<unsigned long long>(note.tick), note.text.c_str());
}

nlohmann::ordered_json vectorJson(const glm::dvec3& v) {
    return {v.x, v.y, v.z};
}

nlohmann::ordered_json differenceJson(const std::optional<Difference>& first) {
    if (!first)
        return nullptr;
    return {{"tick", first->tick},
            {"time", first->time},
            {"hand", first->hand},
            {"stage", first->stage},
            {"recorded_proxy", vectorJson(first->recordedProxy)},
            {"replayed_proxy", vectorJson(first->replayedProxy)},
            {"recorded_force", vectorJson(first->recordedForce)},
            {"replayed_force", vectorJson(first->replayedForce)}};
}

nlohmann::ordered_json reportJson(const ReplayOptions& options, const ReplayReport& report,
                                  const std::vector<FoundScene>& scenes, const TickStatistics& statistics) {
    const RecordingOrigin now = recordingOrigin("replay", 0.0);
    nlohmann::ordered_json sceneList = nlohmann::ordered_json::array();
    for (const FoundScene& scene : scenes)
        sceneList.push_back({{"recorded", scene.recorded.identity.path},
                             {"replayed", scene.path.string()},
                             {"same_file", scene.sameFile},
                             {"feels_the_same", scene.sameFelt}});
    nlohmann::ordered_json notes = nlohmann::ordered_json::array();
    for (const RecordedNote& note : report.notes)
        notes.push_back({{"tick", note.tick}, {"text", note.text}});
    return {{"command", "replay"},
            {"recording", options.recording.string()},
            {"recorded_by",
             {{"command", report.origin.command},
              {"date", report.origin.date},
              {"version", report.origin.version},
              {"compiler", report.origin.compiler},
              {"processor", report.origin.processor},
              {"rate_hz", report.origin.rateHz},
              {"same_build", report.origin.build == now.build},
              {"same_processor", report.origin.processor == now.processor}}},
            {"scenes", sceneList},
            {"equal", !report.first.has_value()},
            {"first_difference", differenceJson(report.first)},
            {"hands", report.hands},
            {"ticks", report.ticks},
            {"replayed", report.replayed},
            {"differing", report.differing},
            {"not_recorded", report.lost},
            {"gaps", report.gaps},
            {"cut_off", report.cutOff},
            {"damage", report.damage},
            {"notes", notes},
            {"step", statistics.stepJson()},
            {"contact", statistics.contactJson()},
            {"force", statistics.forceJson()},
            {"flags", statistics.flagsJson()}};
}

void printResult(const ReplayReport& report) {
    const auto replayed = static_cast<unsigned long long>(report.replayed);
    if (report.replayed == 0) {
        std::printf(report.ticks == 0
                        ? "there are no ticks in it\n"
                        : "none of its ticks can be replayed: what they began with is missing\n");
        return;
    }
    if (!report.first) {
        std::printf("%llu ticks (%.1f s) replayed, all equal\n", replayed, report.seconds);
        return;
    }
    const Difference& first = *report.first;
    std::printf("tick %llu (%.6g s) differs first, %sin the stage '%s'; %llu of %llu ticks differ\n",
                static_cast<unsigned long long>(first.tick), first.time, whichHand(report).c_str(),
                first.stage.c_str(), static_cast<unsigned long long>(report.differing), replayed);
    if (first.stage == "state" || first.stage == "poses")
        return;
    const auto row = [](const char* what, const glm::dvec3& proxy, const glm::dvec3& force) {
        std::printf("  %s: proxy %.17g %.17g %.17g m, force %.17g %.17g %.17g N\n", what, proxy.x, proxy.y,
                    proxy.z, force.x, force.y, force.z);
    };
    row("recorded", first.recordedProxy, first.recordedForce);
    row("replayed", first.replayedProxy, first.replayedForce);
}

bool sameFile(const std::filesystem::path& a, const std::filesystem::path& b) {
    std::error_code error;
    return std::filesystem::weakly_canonical(a, error) == std::filesystem::weakly_canonical(b, error) ||
           std::filesystem::equivalent(a, b, error);
}

/// What is written must be neither what is read nor anything else that is written. A plot is three files: the
/// picture, gnuplot's script and its data.
void refuseOverwriting(const ReplayOptions& options) {
    std::vector<std::filesystem::path> taken{options.recording};
    taken.insert(taken.end(), options.scenes.begin(), options.scenes.end());
    std::vector<std::filesystem::path> written{options.out, options.json, options.compareOut, options.plot};
    if (!options.plot.empty())
        for (const char* ending : {".gp", ".dat"})
            written.push_back(std::filesystem::path(options.plot).replace_extension(ending));
    for (const std::filesystem::path& file : written) {
        if (file.empty())
            continue;
        for (const std::filesystem::path& other : taken)
            if (sameFile(file, other))
                throw Error(
                    file.string(), "", "it would be overwritten, or written twice",
                    "give each file that is written a name of its own; a plot takes those with .gp and "
                    ".dat, too");
        taken.push_back(file);
    }
}

} // namespace

int replayCommand(const ReplayOptions& options) {
    refuseOverwriting(options);
    RecordingReader reader(options.recording);
    std::optional<OutputFile> csv, json;
    if (!options.out.empty()) {
        csv.emplace(options.out);
        csv->write(kTickCsvHeader);
    }
    if (!options.json.empty())
        json.emplace(options.json);
    SceneFinder finder(options);
    TickStatistics statistics;
    std::string rows;
    std::map<uint32_t, ReplayScene> scenes; // shared with the comparison
    const Replayer::Load load = [&](const RecordedScene& scene) {
        const auto found = scenes.find(scene.number);
        return found != scenes.end() ? found->second
                                     : scenes.emplace(scene.number, finder.load(scene)).first->second;
    };
    Replayer replayer(load);
    const ReplayReport report = replayer.replay(
        reader, [&](const RecordedTick& tick, const HapticOutput& output, int64_t stepNs, bool) {
            statistics.add(output, stepNs);
            if (!csv)
                return;
            constexpr size_t kRowsAtOnce = 1 << 20; // bytes
            appendTickRow(rows, tick.time, output, stepNs);
            if (rows.size() < kRowsAtOnce)
                return;
            csv->write(rows);
            rows.clear();
        });
    tellOfOrigin(report.origin);
    tellOfDamage(options, report);
    if (csv) {
        csv->write(rows);
        csv->commit();
    }
    const std::vector<ReplayComparison> compared = compareReplay(options, load);
    if (json) {
        nlohmann::ordered_json figures = reportJson(options, report, finder.scenes(), statistics);
        if (!compared.empty())
            figures["compared"] = comparisonsJson(compared);
        json->write(figures.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n");
        json->commit();
    }
    printResult(report);
    printComparisons(compared);
    return report.first || report.replayed == 0 || !report.damage.empty() ? 1 : 0;
}

} // namespace touchstone
