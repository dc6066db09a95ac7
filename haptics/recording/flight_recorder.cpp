#include "haptics/recording/flight_recorder.h"

#include "engine/core/error.h"
#include "haptics/recording/recording_reader.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <ctime>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace touchstone {

namespace {

namespace fs = std::filesystem;

constexpr const char* kLock = ".lock";

/// Locks the session; -1 where a running process holds the lock.
int lockSession(const fs::path& session) {
    const int descriptor = open((session.string() + kLock).c_str(), O_RDWR | O_CREAT | O_CLOEXEC, 0644);
    if (descriptor < 0)
        throw Error(session.string() + kLock, "", std::string("cannot be written: ") + std::strerror(errno),
                    "choose another folder with --flight-recorder");
    if (flock(descriptor, LOCK_EX | LOCK_NB) == 0)
        return descriptor;
    close(descriptor);
    return -1;
}

fs::path segmentOf(const fs::path& session, int index) {
    return session.string() + (index == 0 ? "-a" : "-b") + std::string(kRecordingEnding);
}

void removeSession(const fs::path& session) {
    std::error_code ignored;
    for (int index : {0, 1})
        fs::remove(segmentOf(session, index), ignored);
    fs::remove(session.string() + kLock, ignored);
}

std::string bytesOf(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), std::istreambuf_iterator<char>()};
}

/// Sequence number of the first chunk; empty where there is none.
std::optional<uint32_t> firstSequence(const std::string& recording) {
    constexpr size_t kAt = kFileHeaderSize + 12;
    if (recording.size() < kFileHeaderSize + kChunkHeaderSize)
        return std::nullopt;
    uint32_t sequence = 0;
    std::memcpy(&sequence, recording.data() + kAt, sizeof sequence);
    return sequence;
}

/// Two segments as one recording, followed by `end`.
std::string joined(const fs::path& session, bool both, int current, const std::string& end) {
    std::string before = both ? bytesOf(segmentOf(session, 1 - current)) : std::string();
    std::string after = bytesOf(segmentOf(session, current));
    const auto first = firstSequence(before), second = firstSequence(after);
    if (first && second && *first > *second)
        std::swap(before, after);
    if (!firstSequence(after))
        std::swap(before, after);
    if (firstSequence(before))
        after = before + after.substr(kFileHeaderSize);
    return after + end;
}

std::string dated(std::time_t time) {
    std::tm utc{};
    gmtime_r(&time, &utc);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y%m%d-%H%M%S", &utc);
    return text.data();
}

/// An unused name in the folder.
fs::path freshName(const fs::path& folder, const std::string& stem) {
    for (int n = 0;; ++n) {
        fs::path path =
            folder / (stem + (n == 0 ? "" : "-" + std::to_string(n)) + std::string(kRecordingEnding));
        if (!fs::exists(path))
            return path;
    }
}

/// Writes the whole file or nothing.
void writeWhole(const fs::path& path, const std::string& bytes) {
    const fs::path part = path.string() + ".part";
    std::error_code error;
    {
        std::ofstream stream(part, std::ios::binary | std::ios::trunc);
        stream.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
        stream.close();
        if (!stream) {
            const std::string why = std::strerror(errno);
            fs::remove(part, error);
            throw Error(path.string(), "", "the flight recording cannot be kept: " + why,
                        "free some space on the disk");
        }
    }
    fs::rename(part, path, error);
    if (error)
        throw Error(path.string(), "", "the flight recording cannot be kept: " + error.message(), "");
}

/// Deletes the oldest kept files beyond the limits.
void prune(const FlightConfig& config) {
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    std::error_code error;
    uint64_t bytes = 0;
    for (const fs::directory_entry& entry : fs::directory_iterator(config.folder, error)) {
        const std::string name = entry.path().filename().string();
        if (entry.path().extension() != kRecordingEnding || name.starts_with("live-"))
            continue;
        files.emplace_back(entry.last_write_time(error), entry.path());
        bytes += entry.file_size(error);
    }
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + 1 < files.size(); ++i) { // the newest stays
        if (files.size() - i <= config.maxFiles && bytes <= config.maxBytes)
            break;
        bytes -= fs::file_size(files[i].second, error);
        fs::remove(files[i].second, error);
    }
}

} // namespace

std::vector<KeptFlight> FlightRecorder::recover(const FlightConfig& config) {
    std::vector<KeptFlight> kept;
    std::error_code error;
    std::vector<fs::path> sessions;
    for (const fs::directory_entry& entry : fs::directory_iterator(config.folder, error))
        if (entry.path().extension() == kLock && entry.path().filename().string().starts_with("live-"))
            sessions.push_back(entry.path().parent_path() / entry.path().stem());
    for (const fs::path& session : sessions) {
        const int lock = lockSession(session);
        if (lock < 0)
            continue; // its process is running
        const std::string bytes = joined(session, true, 0, "");
        if (firstSequence(bytes)) {
            const fs::path file = freshName(config.folder, "crash-" + dated(std::time(nullptr)));
            writeWhole(file, bytes);
            kept.push_back({file, "an earlier session ended without closing; its last seconds"});
        }
        removeSession(session);
        close(lock);
    }
    if (!kept.empty())
        prune(config);
    return kept;
}

FlightRecorder::FlightRecorder(FlightConfig config) : config_(std::move(config)) {
    std::error_code error;
    fs::create_directories(config_.folder, error);
    if (error)
        throw Error(config_.folder.string(), "", "cannot be made: " + error.message(),
                    "choose another folder with --flight-recorder");
    const std::string stem = "live-" + std::to_string(getpid());
    for (int n = 0; lock_ < 0; ++n) {
        session_ = config_.folder / (stem + (n == 0 ? "" : "." + std::to_string(n)));
        lock_ = lockSession(session_);
    }
}

FlightRecorder::~FlightRecorder() {
    writer_.reset();
    removeSession(session_);
    close(lock_);
}

fs::path FlightRecorder::segment(int index) const {
    return segmentOf(session_, index);
}

/// Overwrites the older of the two segments.
void FlightRecorder::rotate() {
    const uint32_t sequence = writer_ ? writer_->file().nextSequence() : 0;
    if (writer_) {
        writer_->flush();
        current_ = 1 - current_;
        previous_ = true;
    }
    const uint32_t next = writer_ ? writer_->file().nextSequence() : sequence;
    writer_.emplace(segment(current_), config_.origin, next);
    recorded_ = 0.0;
}

void FlightRecorder::add(const TickToRecord& tick) {
    const double dt = std::clamp(tick.tick.dt, 0.0, 1.0);
    // Half a tick less: a second of ticks adds up to slightly less or more than a second.
    if (tick.checkpoint != nullptr && tick.whole && (!writer_ || recorded_ + 0.5 * dt >= config_.seconds))
        rotate();
    if (!writer_)
        return;
    writer_->add(tick);
    recorded_ += dt;
    clock_ += dt;
    if (const std::optional<Fault> fault = faultOf(tick)) {
        const auto last = last_.find(fault->name);
        if (pending_ || (last != last_.end() && clock_ - last->second < config_.pause))
            return;
        writer_->note(tick.tick.tick, fault->text);
        last_[fault->name] = clock_;
        pending_ = fault;
        due_ = clock_ + config_.afterwards;
    }
}

/// Of any hand, the first one first.
std::optional<Fault> FlightRecorder::faultOf(const TickToRecord& tick) {
    std::optional<Fault> first = watches_[0].add(tick.tick);
    for (const HandToRecord& other : tick.others) {
        std::optional<Fault> fault = watches_[other.hand].add(other.tick);
        if (first || !fault)
            continue;
        fault->text = "hand " + std::to_string(other.hand + 1) + ": " + fault->text;
        first = std::move(fault);
    }
    return first;
}

void FlightRecorder::flush() {
    if (writer_)
        writer_->flush();
    if (pending_ && clock_ >= due_)
        keep();
}

void FlightRecorder::finish() {
    if (writer_)
        writer_->flush();
    if (pending_)
        keep();
}

void FlightRecorder::keep() {
    const Fault fault = *std::exchange(pending_, std::nullopt);
    const std::vector<std::byte> end = chunkOf(RecordedEnd{writer_->ticks()}, writer_->file().nextSequence());
    const fs::path file = freshName(config_.folder, fault.name + "-" + dated(std::time(nullptr)));
    writeWhole(
        file, joined(session_, previous_, current_, {reinterpret_cast<const char*>(end.data()), end.size()}));
    kept_.push_back({file, fault.text});
    prune(config_);
}

} // namespace touchstone
