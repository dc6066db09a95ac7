#include "experiment/people/person_session.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <fstream>
#include <sstream>

namespace touchstone::experiment {

namespace {

using Json = nlohmann::ordered_json;

constexpr const char* kCheck = "crc";

std::string timeNow() {
    std::array<char, 32> text{};
    const std::time_t now = std::time(nullptr);
    std::tm parts{};
    gmtime_r(&now, &parts);
    std::strftime(text.data(), text.size(), "%Y-%m-%dT%H:%M:%SZ", &parts);
    return text.data();
}

uint64_t mixed(uint64_t x) { // splitmix64
    x += 0x9e3779b97f4a7c15u;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9u;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebu;
    return x ^ (x >> 31);
}

uint32_t checkOf(const std::string& body, uint32_t before) {
    return crc32c(std::as_bytes(std::span(body.data(), body.size())), before);
}

/// The line with its check as the last member.
std::string sealed(const std::string& body, uint32_t check) {
    std::array<char, 32> end{};
    std::snprintf(end.data(), end.size(), ",\"%s\":\"%08x\"}\n", kCheck, check);
    return body.substr(0, body.size() - 1) + end.data();
}

std::string readAll(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    if (!in || !std::filesystem::is_regular_file(file))
        throw Error(file.string(), "", "cannot be opened", "check the name");
    std::stringstream text;
    text << in.rdbuf();
    return text.str();
}

} // namespace

struct PersonSession::File {
    std::filesystem::path path;
    int descriptor = -1;
    uint32_t check = 0; // of all lines so far
    off_t size = 0;

    File() = default;
    File(const File&) = delete;
    File& operator=(const File&) = delete;
    ~File() {
        if (descriptor >= 0)
            ::close(descriptor);
    }
    void open(const std::filesystem::path& name, int flags) {
        path = name;
        descriptor = ::open(name.c_str(), flags | O_WRONLY | O_APPEND | O_CLOEXEC, 0644);
        if (descriptor < 0)
            fail(errno == EEXIST ? "exists already"
                                 : std::string("cannot be written: ") + std::strerror(errno),
                 errno == EEXIST ? "resume it, or give another person's number" : "check the folder");
        if (::flock(descriptor, LOCK_EX | LOCK_NB) != 0)
            fail("is open in another program", "end that one first");
    }
    [[noreturn]] void fail(const std::string& problem, const std::string& remedy) const {
        throw Error(path.string(), "", problem, remedy);
    }
};

PersonSession::PersonSession(const std::filesystem::path& file, const StudyPlan& plan,
                             const SessionStart& start)
    : plan_(plan), start_(start), file_(std::make_unique<File>()) {
    begin();
    file_->open(file, O_CREAT | O_EXCL);
    append({{"touchstoneSession", kSessionVersion},
            {"program", TOUCHSTONE_VERSION},
            {"started", timeNow()},
            {"person", start.person + 1},
            {"seed", start.seed},
            {"pilots", start.pilots},
            {"device", start.device},
            {"folder", std::filesystem::absolute(file).parent_path().string()},
            {"study", plan.source}});
}

PersonSession::PersonSession(const std::filesystem::path& file) : file_(std::make_unique<File>()) {
    load(file, true);
    append({{"event", "resumed"}, {"time", timeNow()}});
}

PersonSession::~PersonSession() = default;
PersonSession::PersonSession(PersonSession&&) noexcept = default;

PersonSession PersonSession::read(const std::filesystem::path& file) {
    PersonSession session;
    session.load(file, false);
    return session;
}

void PersonSession::begin() {
    order_ = plan_.orderFor(start_.person, start_.pilots);
    if (order_.empty())
        throw Error("study", plan_.name,
                    start_.pilots ? "it has no pilot condition" : "it has pilot conditions alone",
                    start_.pilots ? "leave out --pilots" : "give --pilots");
    progress_.clear();
    for (const Condition& condition : plan_.conditions) {
        Progress progress;
        if (condition.varied != Varied::Nothing)
            progress.staircase.emplace(condition.rule);
        progress_.push_back(std::move(progress));
    }
}

void PersonSession::load(const std::filesystem::path& file, bool resume) {
    const std::string name = file.string(), text = readAll(file);
    if (resume)
        file_->open(file, 0);
    uint32_t check = 0;
    size_t number = 0, begin = 0;
    while (begin < text.size()) {
        const size_t end = text.find('\n', begin);
        if (end == std::string::npos)
            break; // cut off by a crash
        ++number;
        const std::string line = text.substr(begin, end - begin), place = "line " + std::to_string(number);
        Json json;
        try {
            json = Json::parse(line);
        } catch (const Json::exception&) {
            throw Error(name, place, "it is no JSON: the file was edited or is damaged",
                        "restore the file as it was written");
        }
        if (number == 1 && (!json.is_object() || !json.contains("touchstoneSession")))
            throw Error(name, place, "it is no session", "name a file that touchstone experiment wrote");
        if (number == 1 && json["touchstoneSession"] != kSessionVersion)
            throw Error(name, place,
                        "it is a session of version " + json["touchstoneSession"].dump() +
                            "; this program has version " + std::to_string(kSessionVersion),
                        "use the program that wrote it");
        const size_t seal = line.rfind(std::string(",\"") + kCheck + "\":\"");
        const std::string body = seal == std::string::npos ? line : line.substr(0, seal) + "}";
        check = checkOf(body, check);
        if (seal == std::string::npos || line + "\n" != sealed(body, check))
            throw Error(name, place, "it is not as it was written: the file was edited or is damaged",
                        "restore the file as it was written");
        try {
            take(json, number, name);
        } catch (const Json::exception& error) {
            throw Error(name, place, std::string("a member is missing or of another kind: ") + error.what(),
                        "");
        }
        begin = end + 1;
    }
    if (number == 0)
        throw Error(name, "", "it has no whole line",
                    "begin a new session: nothing was answered in this one");
    if (begin < text.size())
        note_ = "its last line is cut off (" + std::to_string(text.size() - begin) +
                " bytes): what it was to hold was not yet answered, and is shown again";
    if (!resume)
        return;
    if (begin < text.size()) {
        std::ofstream cut(name + ".cut", std::ios::binary | std::ios::app);
        cut << text.substr(begin) << "\n";
        if (!cut.flush() || ::ftruncate(file_->descriptor, static_cast<off_t>(begin)) != 0)
            file_->fail("its cut-off line cannot be moved to " + name + ".cut", "check the disk");
        note_ += "; the bytes are in " + name + ".cut";
    }
    file_->check = check;
    file_->size = static_cast<off_t>(begin);
}

void PersonSession::take(const Json& line, size_t number, const std::string& name) {
    const auto wrong = [&](const std::string& problem) {
        throw Error(name, "line " + std::to_string(number), problem, "restore the file as it was written");
    };
    if (number == 1) {
        start_.person = line.at("person").get<size_t>() - 1;
        start_.seed = line.at("seed").get<uint64_t>();
        start_.pilots = line.at("pilots").get<bool>();
        start_.device = line.at("device").get<std::string>();
        plan_ = parseStudy(line.at("study").dump(),
                           std::filesystem::path(line.at("folder").get<std::string>()) / "study");
        begin();
        settle();
        return;
    }
    const std::string event = line.at("event").get<std::string>();
    if (event == "resumed")
        return;
    if (finished())
        wrong("it comes after the end of the session");
    if (line.at("condition").get<std::string>() != plan_.conditions[condition()].name)
        wrong("it belongs to another condition");
    if (event == "trained") {
        trained_ = true;
    } else if (event == "trial") {
        if (training() || line.at("level").get<double>() != level() ||
            line.at("referenceFirst").get<bool>() != referenceFirst())
            wrong("the trial is not the one that follows");
        apply(line.at("answer").get<int>(), line.at("seconds").at(0).get<double>(),
              line.at("seconds").at(1).get<double>());
    } else {
        wrong("unknown event '" + event + "'");
    }
}

double PersonSession::level() const {
    const auto& staircase = progress_[condition()].staircase;
    return staircase ? staircase->level() : 0.0;
}

/// From seed, person, condition and trial alone, so that a resumed session shows the same.
bool PersonSession::referenceFirst() const {
    const uint64_t trial = progress_[condition()].trials;
    return (mixed(mixed(mixed(mixed(start_.seed) ^ start_.person) ^ condition()) ^ trial) & 1) != 0;
}

void PersonSession::endTraining() {
    if (finished() || trained_)
        return;
    append({{"event", "trained"}, {"condition", plan_.conditions[condition()].name}, {"time", timeNow()}});
    trained_ = true;
}

void PersonSession::answer(int interval, double firstSeconds, double secondSeconds) {
    if (finished() || training() || interval < 1 || interval > 2)
        return;
    append({{"event", "trial"},
            {"condition", plan_.conditions[condition()].name},
            {"trial", progress_[condition()].trials + 1},
            {"level", level()},
            {"referenceFirst", referenceFirst()},
            {"answer", interval},
            {"right", isReference(interval)},
            {"seconds", {firstSeconds, secondSeconds}},
            {"time", timeNow()}});
    apply(interval, firstSeconds, secondSeconds);
}

void PersonSession::apply(int interval, double firstSeconds, double secondSeconds) {
    Progress& progress = progress_[condition()];
    TrialRecord trial{.condition = condition(),
                      .level = level(),
                      .referenceFirst = referenceFirst(),
                      .answer = interval,
                      .right = isReference(interval),
                      .firstSeconds = firstSeconds,
                      .secondSeconds = secondSeconds};
    ++progress.trials;
    progress.right += trial.right ? 1 : 0;
    if (progress.staircase) {
        progress.staircase->answer(trial.right);
        trial.reversal = progress.staircase->trials().back().reversal;
    }
    trials_.push_back(trial);
    settle();
}

/// On to the next condition where this one is done.
void PersonSession::settle() {
    while (!finished() && done(condition())) {
        ++place_;
        trained_ = false;
    }
}

bool PersonSession::done(size_t condition) const {
    const Progress& progress = progress_[condition];
    return progress.staircase ? progress.staircase->finished()
                              : progress.trials >= plan_.conditions[condition].trials;
}

size_t PersonSession::trialsOf(size_t condition) const {
    return progress_[condition].trials;
}

std::optional<double> PersonSession::threshold(size_t condition) const {
    return progress_[condition].staircase ? progress_[condition].staircase->threshold() : std::nullopt;
}

void PersonSession::append(Json line) {
    if (!file_)
        throw Error("session", "", "it was read for a report", "");
    const std::string body = line.dump();
    const uint32_t check = checkOf(body, file_->check);
    const std::string text = sealed(body, check);
    const ssize_t written = ::write(file_->descriptor, text.data(), text.size());
    if (written != static_cast<ssize_t>(text.size()) ||
        (start_.synchronise && ::fdatasync(file_->descriptor) != 0)) {
        const std::string why = written < 0 ? std::strerror(errno) : "the disk is full";
        (void)!::ftruncate(file_->descriptor, file_->size); // else the next line would join what is left
        file_->fail("the answer cannot be written: " + why,
                    "make room on the disk; nothing answered before is lost");
    }
    file_->check = check;
    file_->size += written;
}

std::vector<PersonSession> readSessions(const std::filesystem::path& folder,
                                        std::vector<std::string>& problems) {
    std::vector<std::filesystem::path> files;
    if (!std::filesystem::is_directory(folder))
        throw Error(folder.string(), "", "there is no such folder", "name the folder of the sessions");
    for (const auto& entry : std::filesystem::directory_iterator(folder))
        if (entry.path().extension() == kSessionEnding)
            files.push_back(entry.path());
    std::sort(files.begin(), files.end());
    std::vector<PersonSession> sessions;
    for (const std::filesystem::path& file : files)
        try {
            sessions.push_back(PersonSession::read(file));
            if (!sessions.back().note().empty())
                problems.push_back(file.string() + ": " + sessions.back().note());
        } catch (const Error& error) {
            problems.emplace_back(error.what());
        }
    return sessions;
}

} // namespace touchstone::experiment
