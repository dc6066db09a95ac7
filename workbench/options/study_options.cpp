// Options of the commands that measure.

#include "workbench/options/command_options.h"
#include "workbench/options/number_range.h"

#include <charconv>
#include <string>
#include <string_view>
#include <system_error>

namespace touchstone {

namespace {

/// "2/8"
void parseShard(const std::string& text, StudyCommandOptions& options) {
    const size_t slash = text.find('/');
    int shard = 0, shards = 0;
    const auto whole = [](std::string_view part, int& number) {
        const auto read = std::from_chars(part.data(), part.data() + part.size(), number);
        return read.ec == std::errc{} && read.ptr == part.data() + part.size();
    };
    if (slash == std::string::npos || !whole(std::string_view(text).substr(0, slash), shard) ||
        !whole(std::string_view(text).substr(slash + 1), shards) || shard < 1 || shard > shards)
        throw CLI::ValidationError("--shard", "'" + text + "' is no share; write I/N, I from 1 to N");
    options.shard = shard;
    options.shards = shards;
}

} // namespace

void defineBench(CLI::App& app, BenchOptions& options) {
    app.add_option(
           "WHAT", options.what,
           "fast: the bounds of a tick in rays; growth: its time over the number of triangles; moving: "
           "a thousand objects that move, and objects that close on the hand; fields: how long a mesh's "
           "distance field takes to build; all of these without it; "
           "protocol: the servo rates of [000 Table I] as they were measured, three runs of three minutes")
        ->type_name("")
        ->check(CLI::IsMember({"fast", "growth", "moving", "fields", "protocol"}));
    app.add_option("--json", options.json, "Write the figures here")->type_name("FILE");
    app.add_option(
           "--largest", options.largestTriangles,
           "Leave out what has more triangles [1000000]; 10000000 takes 2.6 GB and a quarter of a minute")
        ->type_name("N");
    app.add_option("--rounds", options.rounds, "Turns of 1000 ticks for each case [20]")
        ->type_name("N")
        ->check(CLI::Range(1, 10000));
    app.add_option("--seconds", options.seconds, "protocol: of each run [180]")
        ->type_name("S")
        ->check(within(0.05, 3600.0));
    app.add_option("--runs", options.runs, "protocol: runs of each object [3]")
        ->type_name("N")
        ->check(CLI::Range(1, 100));
    app.add_flag("--check", options.check, "Exit status 1 where a bound is missed");
}

void defineStudy(CLI::App& app, StudyCommandOptions& options) {
    app.add_option(
           "WHAT", options.what,
           "Shapes (plane, relief, sphere, cylinder, torus, waves, wedge), models, folders of them, "
           "`rate`, the servo's, and `voxel`, those of distance fields; without any, every shape, the rate "
           "and the voxels")
        ->type_name("");
    app.add_option("--out", options.out, "Folder for study.csv, study.json and plots/")->type_name("DIR");
    app.add_option("--ladder", options.ablations, "This ablation alone (see --list); may be given again")
        ->type_name("NAME")
        ->expected(1)
        ->take_all();
    app.add_option("--rounds", options.rounds, "Turns that every configuration takes [150]")
        ->type_name("N")
        ->check(CLI::Range(2, 10000));
    app.add_flag("--quick", options.quick, "A rougher answer in less time");
    app.add_option("--finest", options.finestVoxel,
                   "voxel: the finest field has at most this many voxels on a shape's diagonal, from 64 on "
                   "in powers of "
                   "two [512]; 1024 takes 3 GB and some minutes")
        ->type_name("N")
        ->check(CLI::Range(64, 2048));
    app.add_flag("--list", options.list, "Print the ablations and shapes");
    app.add_option_function<std::string>(
           "--shard", [&options](const std::string& text) { parseShard(text, options); },
           "Study every N-th of what is asked for only, from the I-th, and leave plots to `study merge`: for "
           "GNU parallel and job arrays")
        ->type_name("I/N");
    app.parse_complete_callback([&app, &options] {
        if (options.out.empty() && !options.list && app.get_subcommands().empty())
            throw CLI::RequiredError("--out");
    });
}

void defineCompare(CLI::App& app, StudyCompareOptions& options) {
    app.add_option("A", options.first, "study.json of one run")->type_name("")->required();
    app.add_option("B", options.second, "study.json of another")->type_name("")->required();
}

void defineMerge(CLI::App& app, StudyMergeOptions& options) {
    app.add_option("PART", options.parts, "Folders that `study --shard` wrote (or study.json files)")
        ->type_name("")
        ->required();
    app.add_option("--out", options.out, "Folder for the whole study and its plots")
        ->type_name("DIR")
        ->required();
}

} // namespace touchstone
