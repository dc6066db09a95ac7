// Makes any number of valid files and opens, inspects and touches each; meant for a build with sanitizers.
// Files are handled in child processes, so that one that crashes is a finding like any other.
#include "tests/valid_files/touch_check.h"
#include "tests/valid_files/valid_file.h"

#include <CLI/CLI.hpp>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace touchstone::test {
namespace {

constexpr unsigned kLongest = 300; ///< s for a file: a child that takes longer ends, which is a finding

struct Options {
    uint64_t seed = 1, first = 0, count = 1000, batch = 50;
    std::filesystem::path write;
    bool warnings = false;
    int worker = -1; ///< of a child: where it shares Shared
};

/// What the children tell their parent.
struct Shared {
    uint64_t next = 0;     ///< the file that is being handled
    uint64_t findings = 0; ///< files with one
    uint64_t touchable = 0, touched = 0, triangles = 0, contactTicks = 0;
};

void save(const Options& options, uint64_t index, const std::vector<uint8_t>& file) {
    if (options.write.empty())
        return;
    const auto* bytes = reinterpret_cast<const char*>(file.data());
    const char* ending = file.size() > 3 && bytes[0] == 'g' ? ".glb" : ".gltf";
    std::ofstream(options.write / (std::to_string(index) + ending), std::ios::binary)
        .write(bytes, static_cast<std::streamsize>(file.size()));
}

/// Handles files up to `end` in this process.
void handle(const Options& options, uint64_t end, Shared& shared) {
    for (; shared.next < end; ++shared.next) {
        alarm(kLongest);
        const Recipe recipe = recipeOf(options.seed, shared.next);
        const std::vector<uint8_t> file = validFile(recipe);
        const TouchReport report = openAndTouch(file, recipe.seed);
        shared.touchable += report.touchable ? 1 : 0;
        shared.touched += report.contactTicks > 0 ? 1 : 0;
        shared.triangles += report.triangles;
        shared.contactTicks += static_cast<uint64_t>(report.contactTicks);
        if (options.warnings)
            for (const std::string& warning : report.warnings)
                std::printf("warning %llu: %s\n", static_cast<unsigned long long>(shared.next),
                            warning.c_str());
        if (report.findings.empty())
            continue;
        ++shared.findings;
        save(options, shared.next, file);
        for (const std::string& finding : report.findings)
            std::printf("finding %llu: %s\n  %s\n", static_cast<unsigned long long>(shared.next),
                        finding.c_str(), recipe.text().c_str());
        std::fflush(stdout);
    }
}

/// Runs this program again on files `first` to `end` and returns its wait status. A fork alone would not do:
/// libraries start threads when they are loaded, and wait for them at exit.
int runWorker(const Options& options, uint64_t first, uint64_t end, int sharedFile) {
    std::vector<std::string> words{"valid_files",
                                   "--seed",
                                   std::to_string(options.seed),
                                   "--first",
                                   std::to_string(first),
                                   "--count",
                                   std::to_string(end - first),
                                   "--worker",
                                   std::to_string(sharedFile)};
    if (!options.write.empty())
        words.insert(words.end(), {"--write", options.write.string()});
    if (options.warnings)
        words.emplace_back("--warnings");
    std::vector<char*> arguments;
    for (std::string& word : words)
        arguments.push_back(word.data());
    arguments.push_back(nullptr);
    const pid_t child = fork();
    if (child == 0) {
        execv("/proc/self/exe", arguments.data());
        _exit(127);
    }
    int status = 0;
    if (child < 0 || waitpid(child, &status, 0) != child) {
        std::perror("valid_files");
        std::exit(2);
    }
    return status;
}

/// Handles a batch in a child; a child that does not come back is a finding of the file that it was at, and
/// the rest of its batch goes to the next one.
void runBatch(const Options& options, uint64_t end, int sharedFile, Shared& shared) {
    std::fflush(stdout);
    const uint64_t begin = shared.next;
    const int status = runWorker(options, begin, end, sharedFile);
    if (status == 0)
        return;
    ++shared.findings;
    if (shared.next >= end) {
        std::printf("finding %llu..%llu: the batch ends with status %d (a leak?)\n",
                    static_cast<unsigned long long>(begin), static_cast<unsigned long long>(end - 1), status);
        return;
    }
    const Recipe recipe = recipeOf(options.seed, shared.next);
    std::printf("finding %llu: ends with %s %d\n  %s\n", static_cast<unsigned long long>(shared.next),
                WIFSIGNALED(status) ? "signal" : "status",
                WIFSIGNALED(status) ? WTERMSIG(status) : WEXITSTATUS(status), recipe.text().c_str());
    save(options, shared.next, validFile(recipe));
    ++shared.next;
}

int run(const Options& options) {
    const int sharedFile = options.worker >= 0 ? options.worker : memfd_create("valid_files", 0);
    if (sharedFile < 0 || ftruncate(sharedFile, sizeof(Shared)) != 0) {
        std::perror("valid_files");
        return 2;
    }
    void* memory = mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED, sharedFile, 0);
    if (memory == MAP_FAILED) {
        std::perror("valid_files");
        return 2;
    }
    auto& shared = *static_cast<Shared*>(memory); // the file begins as zeros
    const uint64_t end = options.first + options.count;
    if (options.worker >= 0) {
        handle(options, end, shared);
        return 0;
    }
    if (!options.write.empty())
        std::filesystem::create_directories(options.write);
    const auto begin = std::chrono::steady_clock::now();
    for (shared.next = options.first; shared.next < end;)
        runBatch(options, std::min(end, shared.next + options.batch), sharedFile, shared);
    const double seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
    const auto number = [](uint64_t value) { return static_cast<unsigned long long>(value); };
    std::printf("%llu files of seed %llu in %.0f s: %llu with findings; %llu touchable, %llu touched, %llu "
                "triangles, "
                "%llu ticks in contact\n",
                number(options.count), number(options.seed), seconds, number(shared.findings),
                number(shared.touchable), number(shared.touched), number(shared.triangles),
                number(shared.contactTicks));
    return shared.findings == 0 ? 0 : 1;
}

} // namespace
} // namespace touchstone::test

int main(int argc, char** argv) {
    touchstone::test::Options options;
    CLI::App app{
        "Generates valid glTF files; opens, inspects and touches each of them. Exit status 1: findings."};
    app.add_option("--seed", options.seed, "Seed of the run")->capture_default_str();
    app.add_option("--first", options.first, "Number of the first file")->capture_default_str();
    app.add_option("--count", options.count, "Number of files")->capture_default_str();
    app.add_option("--batch", options.batch, "Files that one child process handles")
        ->capture_default_str()
        ->check(CLI::PositiveNumber);
    app.add_option("--write", options.write, "Folder for the files with findings");
    app.add_flag("--warnings", options.warnings, "Print the loader's warnings");
    app.add_option("--worker", options.worker)->group(""); // of a child
    CLI11_PARSE(app, argc, argv);
    return touchstone::test::run(options);
}
