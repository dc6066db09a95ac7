// The cost of accuracy, on our shapes and on the user's models: the command around study/.

#include "engine/core/error.h"
#include "engine/load/model_endings.h"
#include "study/ablation/ablation.h"
#include "study/compare_studies.h"
#include "study/errors/noticeable.h"
#include "study/rate/rate_ablation.h"
#include "study/report/report.h"
#include "study/result/provenance.h"
#include "study/study.h"
#include "study/voxel/voxel_study.h"
#include "workbench/options/commands.h"

#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <numeric>

namespace touchstone {

namespace {

using namespace study;

/// A progress bar on a terminal, nothing in a log.
class Bar {
  public:
    Bar() : shown_(isatty(STDERR_FILENO) != 0) {}
    ~Bar() { clear(); }
    Bar(const Bar&) = delete;
    Bar& operator=(const Bar&) = delete;

    void show(const std::string& name, const std::string& what, double all) const {
        constexpr int kWidth = 30;
        if (!shown_)
            return;
        const auto full = static_cast<size_t>(std::lround(kWidth * std::clamp(all, 0.0, 1.0)));
        std::fprintf(stderr, "\r\033[K[%s%s] %3.0f %%  %s: %s", std::string(full, '#').c_str(),
                     std::string(kWidth - full, '.').c_str(), 100.0 * all, name.c_str(), what.c_str());
    }
    void clear() const {
        if (shown_)
            std::fputs("\r\033[K", stderr);
    }

  private:
    bool shown_;
};

/// Subjects that are no shapes: the servo rate, and the voxels of distance fields.
constexpr const char *kRate = "rate", *kVoxel = "voxel";

const ShapeKind* kindNamed(const std::string& name) {
    for (const ShapeKind& kind : shapeKinds())
        if (kind.name == name)
            return &kind;
    return nullptr;
}

void printAblations() {
    for (const Ablation& ablation : ablations()) {
        std::printf("%s: %s\n  all configurations: %s\n", std::string(ablation.name).c_str(),
                    std::string(ablation.question).c_str(), std::string(ablation.base).c_str());
        for (const ConfigurationLine& line : configurationLines())
            if (line.ablation == ablation.name)
                std::printf("  %-18s %s\n", std::string(line.name).c_str(),
                            std::string(line.settings).c_str());
        for (const Product& product : products())
            if (product.ablation == ablation.name) {
                std::printf("  all combinations of one configuration each of:");
                for (const std::string_view axis : product.axes)
                    std::printf(" %s", std::string(axis).c_str());
                std::printf("\n");
            }
    }
    std::printf(
        "%s: how often the servo ticks: the stiffest stable wall, energy and processor at 0.5, 1, 2, 4 kHz; "
        "an ablation without a scene, named like a shape\n",
        kRate);
    std::printf(
        "%s: how large the voxels of a distance field are: sphere, torus, box and groove at 1/64 to 1/512 "
        "of their diagonals (--finest), trilinear and tricubic, beside their meshes\n",
        kVoxel);
    std::printf("shapes:\n");
    for (const ShapeKind& kind : shapeKinds())
        std::printf("  %-18s %s; %s triangles\n", std::string(kind.name).c_str(),
                    std::string(kind.what).c_str(), grouped(kind.triangles).c_str());
}

/// The models in a folder and its subfolders.
std::vector<std::string> modelsIn(const std::filesystem::path& folder) {
    std::vector<std::string> models;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(
             folder, std::filesystem::directory_options::skip_permission_denied)) {
        if (endsIn(entry.path(), kModelEndings) && entry.is_regular_file())
            models.push_back(entry.path().string());
    }
    if (models.empty())
        throw Error(folder.string(), "", "has no model in it", "name a folder that has some");
    return models;
}

/// A model, shape, "rate" or "voxel", and its name in the results.
struct Asked {
    std::string what, name;
};

/// Files are named by their file names, and by their paths where several share one.
std::vector<Asked> named(const std::vector<std::string>& what) {
    std::map<std::string, int> files;
    const auto fileName = [](const std::string& path) {
        return std::filesystem::path(path).filename().string();
    };
    for (const std::string& path : what)
        ++files[fileName(path)];
    std::vector<Asked> asked;
    for (const std::string& path : what)
        asked.push_back({path, files[fileName(path)] > 1 ? path : fileName(path)});
    return asked;
}

/// The subjects in a fixed order, restricted to this shard.
std::vector<Asked> share(const StudyCommandOptions& options) {
    std::vector<std::string> what;
    for (const std::string& asked : options.what) {
        const bool folder = kindNamed(asked) == nullptr && std::filesystem::is_directory(asked);
        const std::vector<std::string> these = folder ? modelsIn(asked) : std::vector<std::string>{asked};
        what.insert(what.end(), these.begin(), these.end());
    }
    if (options.what.empty())
        for (const ShapeKind& kind : shapeKinds())
            what.emplace_back(kind.name);
    if (options.what.empty() && options.ablations.empty())
        what.insert(what.end(), {kRate, kVoxel});
    std::sort(what.begin(), what.end());
    what.erase(std::unique(what.begin(), what.end()), what.end());
    const std::vector<Asked> all = named(what);
    std::vector<Asked> mine;
    for (size_t i = 0; i < all.size(); ++i)
        if (i % static_cast<size_t>(options.shards) == static_cast<size_t>(options.shard - 1))
            mine.push_back(all[i]);
    return mine;
}

void studyOne(const Asked& asked, const StudyOptions& options, int finestVoxel, bool tessellate,
              StudyResult& result, const StudyProgress& progress) {
    if (asked.what == kRate) {
        result.rates = studyRates(kServoRates, {.rounds = std::max(2, options.rounds / 5)},
                                  [&](double done) { progress("servo rates", done); });
        return;
    }
    if (asked.what == kVoxel) {
        VoxelOptions voxels{.errorTicks = options.errorTicks, .rounds = std::max(2, options.rounds / 5)};
        voxels.across.clear();
        for (int across = 64; across <= finestVoxel; across *= 2)
            voxels.across.push_back(across);
        result.voxels = studyVoxels(voxels, result.notes, [&](double done) { progress("voxels", done); });
        return;
    }
    const ShapeKind* kind = kindNamed(asked.what);
    if (kind == nullptr) {
        studySubject(loadSubject(asked.what, asked.name), options, result, progress);
        return;
    }
    tessellate = tessellate && kind->round;
    const double first = tessellate ? 0.5 : 1.0;
    studySubject(kind->make(kind->triangles), options, result,
                 [&](const std::string& what, double done) { progress(what, first * done); });
    if (tessellate)
        studyTessellation(*kind, options, result, [&](const std::string& what, double done) {
            progress("tessellation, " + what, first + (1.0 - first) * done);
        });
}

double sum(const std::array<Estimate, kStageCount>& stages) {
    return std::accumulate(stages.begin(), stages.end(), 0.0,
                           [](double total, const Estimate& stage) { return total + stage.value; });
}

void printVoxels(const StudyResult& result) {
    std::string shape;
    for (const VoxelResult& v : result.voxels) {
        if (v.shape != shape) {
            shape = v.shape;
            std::printf(
                "\n%s as a distance field\n  %-12s %9s %-24s %6s %8s %8s %8s %10s %10s %10s %9s %8s\n",
                shape.c_str(), "nodes from", "triangles", "touched by", "across", "voxel mm", "MB", "build s",
                "place um", "surface um", "max um", "angle", "ns");
        }
        std::printf("  %-12s %9zu %-24s %6.0f %8.3f %8.2f %8.3f %10.4g %10.4g %10.4g %8.3f° %8.0f\n",
                    v.source.c_str(), v.triangles, v.method.c_str(), v.across, 1e3 * v.voxel, 1e-6 * v.memory,
                    v.build, 1e6 * v.meanPosition, 1e6 * v.meanSurface, 1e6 * v.maxSurface,
                    v.direction.p99 / 0.017453292519943295, v.step.value);
    }
}

void printTable(const StudyResult& result) {
    std::string scene;
    for (const ConfigurationResult& configuration : result.configurations) {
        if (configuration.scene != scene) {
            scene = configuration.scene;
            std::printf("\n%s, %s\n  * on the Pareto front, = what the program does by itself\n",
                        scene.c_str(), configuration.path.c_str());
            std::printf("  %-56s %9s %17s %8s %10s %9s %9s\n", "configuration", "ns", "95 %", "stages",
                        "force mN", "angle", "proxy um");
        }
        const Errors& e = configuration.errors;
        std::printf("%c%c %-56s %9.0f %8.0f..%-7.0f %7.1f%% %10.4g %8.3f° %9.4g\n",
                    configuration.pareto ? '*' : ' ', configuration.isDefault ? '=' : ' ',
                    (configuration.ablation + ": " + configuration.configuration).c_str(),
                    configuration.step.value, configuration.step.low, configuration.step.high,
                    configuration.stepMean.value > 0.0
                        ? 100.0 * (sum(configuration.stages) / configuration.stepMean.value - 1.0)
                        : 0.0,
                    1e3 * felt(e), e.forceDirection.p99 / 0.017453292519943295, 1e6 * e.position.p99);
    }
    double furthest = 0.0;
    for (const ConfigurationResult& configuration : result.configurations)
        if (configuration.stepMean.value > 0.0)
            furthest =
                std::max(furthest, std::fabs(sum(configuration.stages) / configuration.stepMean.value - 1.0));
    if (furthest > 0.0)
        std::printf("\nthe stages of each configuration add up to its step within %.1f %%\n",
                    100.0 * furthest);
    for (const RateResult& r : result.rates)
        std::printf(
            "servo at %4.0f Hz: stiffest stable wall %6.0f N/m, bound from theory %6.0f N/m; a stroke is "
            "given %.3g mJ; %.3f..%.3f %% of a processor\n",
            r.rateHz, r.stiffestStable, r.bound, 1e3 * r.energyCreated, 100.0 * r.busy.low,
            100.0 * r.busy.high);
    printVoxels(result);
    if (result.configurations.empty())
        return;
    std::printf(
        "\nforce, angle and proxy: 99th percentile of the difference from the truth. stages: how much "
        "the sum of the stages differs from the whole step.\n");
}

/// Writes the results and messages to the folder `out`. Without `plots` for a shard to be merged.
void publish(const StudyResult& result, const std::filesystem::path& out, bool plots) {
    std::filesystem::create_directories(out);
    writeStudyCsv(result, out / "study.csv");
    writeStudyJson(result, out / "study.json");
    PlotsWritten drawn;
    if (plots)
        drawn = writeStudyPlots(result, out);
    for (const std::string& note : result.notes)
        std::printf("note: %s\n", note.c_str());
    for (const std::string& problem : result.problems)
        std::fprintf(stderr, "touchstone: problem: %s\n", problem.c_str());
    for (const std::string& problem : drawn.problems)
        std::fprintf(stderr, "touchstone: problem: %s\n", problem.c_str());
    std::printf("%s: %zu configurations, %zu problems, %zu plots\n", (out / "study.json").c_str(),
                result.configurations.size(), result.problems.size(), drawn.files.size());
}

} // namespace

int studyCommand(const StudyCommandOptions& options) {
    if (options.list) {
        printAblations();
        return 0;
    }
    for (const std::string& name : options.ablations)
        if (std::none_of(ablations().begin(), ablations().end(),
                         [&](const Ablation& ablation) { return ablation.name == name; }))
            throw Error("study", "--ladder", "there is no ablation '" + name + "'",
                        "see touchstone study --list");
    StudyOptions plan;
    plan.ablations = options.ablations;
    if (options.quick) {
        plan.rounds = 25;
        plan.errorTicks = 1500;
        plan.largestTriangles = 65'536;
    }
    const int finestVoxel = options.finestVoxel > 0 ? options.finestVoxel : options.quick ? 128 : 512;
    if (options.rounds > 0)
        plan.rounds = options.rounds;
    const bool tessellate = plan.ablations.empty() || std::find(plan.ablations.begin(), plan.ablations.end(),
                                                                "tessellation") != plan.ablations.end();
    StudyResult result;
    result.provenance = provenanceOf(options.commandLine);
    result.noticeable = noticeableDifferences();
    const std::vector<Asked> mine = share(options);
    {
        const Bar bar;
        for (size_t i = 0; i < mine.size(); ++i) {
            const auto progress = [&](const std::string& what, double done) {
                bar.show(mine[i].what, what,
                         (static_cast<double>(i) + done) / static_cast<double>(mine.size()));
            };
            try {
                studyOne(mine[i], plan, finestVoxel, tessellate, result, progress);
            } catch (const std::exception& error) { // one of thousands may be invalid, or too large
                if (options.shards == 1 && mine.size() == 1)
                    throw;
                const std::string what = error.what();
                result.problems.push_back(what.starts_with(mine[i].what) ? what : mine[i].what + ": " + what);
            }
        }
    }
    printTable(result);
    publish(result, options.out, options.shards == 1);
    // A shard without subjects succeeds; one without results fails.
    return mine.empty() || !result.configurations.empty() || !result.rates.empty() || !result.voxels.empty()
               ? 0
               : 1;
}

int studyMerge(const StudyMergeOptions& options) {
    std::vector<StudyResult> parts;
    for (const std::filesystem::path& part : options.parts)
        parts.push_back(readStudyJson(std::filesystem::is_directory(part) ? part / "study.json" : part));
    publish(mergeStudies(parts), options.out, true);
    return 0;
}

int studyCompare(const StudyCompareOptions& options) {
    const OrderKept kept = compareOrder(readStudyJson(options.first), readStudyJson(options.second));
    std::printf("%zu configurations in both, %zu in one only; errors differ in %zu\n", kept.matched,
                kept.onlyInOne, kept.errorsChanged);
    std::printf("Pareto front: %zu configurations in both, %zu in one only\n", kept.frontBoth, kept.frontOne);
    std::printf("%zu pairs; %zu apart in the first study, %zu of these in the other order in the second\n"
                "%zu apart in both studies, %zu of these in the other order\n",
                kept.pairs, kept.apart, kept.swapped.size(), kept.bothApart, kept.swappedApart);
    for (const std::string& pair : kept.swapped)
        std::printf("  %s\n", pair.c_str());
    return kept.swapped.empty() && kept.matched > 0 ? 0 : 1;
}

} // namespace touchstone
