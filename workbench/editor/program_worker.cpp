#include "workbench/editor/program_worker.h"

#include "engine/core/error.h"
#include "engine/core/progress.h"
#include "engine/program/program_compiler.h"
#include "engine/time/seconds_now.h"
#include "haptics/program/load_program.h"
#include "workbench/figures/program_figures.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <charconv>
#include <chrono>
#include <fstream>
#include <string_view>
#include <utility>

namespace touchstone {

namespace {

constexpr std::chrono::milliseconds kLookEvery{10};

/// The number of "line 12"; 0: none.
unsigned lineOf(std::string_view place) {
    constexpr std::string_view kLine = "line ";
    unsigned line = 0;
    if (place.starts_with(kLine))
        std::from_chars(place.data() + kLine.size(), place.data() + place.size(), line);
    return line;
}

/// Up to one byte more than a program may have; nullopt where it cannot be read, as while it is replaced.
std::optional<std::string> textIn(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::string text(kMaxProgramBytes + 1, '\0');
    stream.read(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream.is_open() || stream.bad())
        return std::nullopt;
    text.resize(static_cast<size_t>(stream.gcount()));
    return text;
}

/// s since a file was written, at most 10: its clock may be another machine's.
double ageOf(std::filesystem::file_time_type written) {
    const std::chrono::duration<double> age = std::filesystem::file_time_type::clock::now() - written;
    return age.count() >= 0.0 && age.count() < 10.0 ? age.count() : 0.0;
}

ProgramCost costOf(const SurfaceProgram& program) {
    program::RegisterProgram felt = program::translated(program.source, program.spirv);
    program::setParameters(felt, program.source.parameters);
    const nlohmann::ordered_json figures = programFigures(felt, program.text);
    return {felt.instructions.size(), figures["ns_per_tick"].get<double>(),
            figures["ns_with_gradients"].get<double>()};
}

} // namespace

ProgramWorker::~ProgramWorker() {
    {
        const std::lock_guard lock(mutex_);
        stop_ = true;
    }
    wake_.notify_all();
    if (thread_.joinable())
        thread_.join();
}

void ProgramWorker::begin(std::vector<Source> sources) {
    const std::lock_guard lock(mutex_);
    ++generation_;
    wanted_.clear();
    unmeasured_.clear();
    finished_.clear();
    sources_.clear();
    for (Source& source : sources)
        sources_.emplace_back().Source::operator=(std::move(source));
    if (!sources_.empty() && !thread_.joinable())
        thread_ = std::thread([this] { run(); });
    wake_.notify_all();
}

void ProgramWorker::compile(size_t source, std::string text, double changed) {
    {
        const std::lock_guard lock(mutex_);
        ++sources_[source].version;
        wanted_[source] = {std::move(text), changed};
    }
    wake_.notify_all();
}

void ProgramWorker::forget(size_t source) {
    const std::lock_guard lock(mutex_);
    ++sources_[source].version;
    wanted_.erase(source);
}

void ProgramWorker::measure(size_t source, std::shared_ptr<const SurfaceProgram> program) {
    {
        const std::lock_guard lock(mutex_);
        unmeasured_[source] = std::move(program);
    }
    wake_.notify_all();
}

std::vector<ProgramReport> ProgramWorker::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, {});
}

bool ProgramWorker::busy() {
    const std::lock_guard lock(mutex_);
    return compiling_ || !wanted_.empty() || !finished_.empty();
}

void ProgramWorker::run() {
    // One of its own, with this thread's priority: who opened the model may have had a lower one.
    PreparedProgram compiler(installedProgramCompiler().program(), installedProgramCompiler().limits());
    compiler.start(); // the first text is compiled the sooner
    while (!stop_) {
        std::optional<Job> job = next();
        if (!job)
            job = changedFile();
        if (job && job->report.program == nullptr)
            compileNow(*std::move(job), compiler);
        else if (job)
            finish(*std::move(job));
    }
}

/// Texts first: they are waited for, costs are not.
std::optional<ProgramWorker::Job> ProgramWorker::next() {
    std::unique_lock lock(mutex_);
    const bool watches =
        std::ranges::any_of(sources_, [](const Known& known) { return !known.file.empty(); });
    const auto called = [this, generation = generation_] {
        return stop_ || generation_ != generation || !wanted_.empty() || !unmeasured_.empty();
    };
    if (watches)
        wake_.wait_for(lock, kLookEvery, called);
    else
        wake_.wait(lock, called);
    Job job{.generation = generation_};
    if (stop_ || (wanted_.empty() && unmeasured_.empty()))
        return std::nullopt;
    if (wanted_.empty()) {
        job.report.source = unmeasured_.begin()->first;
        job.report.program = std::move(unmeasured_.begin()->second);
        job.report.text = job.report.program->text;
        unmeasured_.erase(unmeasured_.begin());
        return job;
    }
    const auto& [source, wanted] = *wanted_.begin();
    job.report = {.source = source, .text = wanted.text, .changed = wanted.changed};
    job.name = sources_[source].name;
    job.file = sources_[source].file;
    job.version = sources_[source].version;
    wanted_.erase(wanted_.begin());
    return job;
}

std::optional<ProgramWorker::Job> ProgramWorker::changedFile() {
    struct Watched {
        size_t source = 0;
        std::filesystem::path file{};
        decltype(Known::seen) seen{};
    };
    std::vector<Watched> watched;
    uint64_t generation = 0;
    {
        const std::lock_guard lock(mutex_);
        for (size_t s = 0; s < sources_.size(); ++s)
            if (!sources_[s].file.empty())
                watched.push_back({s, sources_[s].file, sources_[s].seen});
        generation = generation_;
    }
    for (const Watched& each : watched) {
        if (stop_)
            break;
        std::error_code problem, other;
        const std::pair now(std::filesystem::last_write_time(each.file, problem),
                            std::filesystem::file_size(each.file, other));
        if (problem || other || now == each.seen)
            continue;
        std::optional<std::string> text = textIn(each.file);
        if (!text)
            continue;
        const std::lock_guard lock(mutex_);
        if (generation != generation_)
            break;
        Known& known = sources_[each.source];
        known.seen = now;
        if (*text == std::exchange(known.text, *text))
            continue;
        return Job{.report = {.source = each.source,
                              .text = *std::move(text),
                              .fromFile = true,
                              .changed = secondsNow() - ageOf(now.first)},
                   .name = known.name,
                   .file = each.file,
                   .generation = generation};
    }
    return std::nullopt;
}

bool ProgramWorker::superseded(const Job& job) {
    const std::lock_guard lock(mutex_);
    return stop_ || generation_ != job.generation ||
           (!job.report.fromFile && sources_[job.report.source].version != job.version);
}

void ProgramWorker::compileNow(Job job, PreparedProgram& compiler) {
    ProgramReport& report = job.report;
    {
        const std::lock_guard lock(mutex_);
        compiling_ = true;
    }
    try {
        auto compiled = compileSurfaceProgram(
            job.name, report.text, job.file, [&] { return superseded(job); }, compiler);
        (void)program::translated(compiled->source, compiled->spirv); // the hand must be able to run it, too
        report.program = std::move(compiled);
    } catch (const Cancelled&) {
        const std::lock_guard lock(mutex_);
        compiling_ = false;
        return;
    } catch (const Error& error) {
        report.line = lineOf(error.place());
        report.problem = error.problem() + (error.remedy().empty() ? "" : "; " + error.remedy());
    } catch (const std::exception& error) {
        report.problem = error.what();
    }
    const std::lock_guard lock(mutex_);
    compiling_ = false;
    if (generation_ == job.generation)
        finished_.push_back(std::move(report));
}

void ProgramWorker::finish(Job job) {
    try {
        job.report.cost = costOf(*job.report.program);
    } catch (const std::exception&) { // the hand cannot run it: its surface is plain
        return;
    }
    const std::lock_guard lock(mutex_);
    if (generation_ == job.generation)
        finished_.push_back(std::move(job.report));
}

} // namespace touchstone
