#include "workbench/timeline/recording_list.h"

#include "haptics/recording/recording_reader.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <ctime>
#include <system_error>

namespace touchstone {

namespace {

constexpr int kFirstChunks = 8; // these contain origin and scene

std::string localDate(std::time_t time) {
    std::tm local{};
    localtime_r(&time, &local);
    std::array<char, 32> text{};
    std::strftime(text.data(), text.size(), "%Y-%m-%d %H:%M", &local);
    return text.data();
}

/// From "2026-03-01T14:05:00Z"; empty where there is no date.
std::string dateOf(const std::string& iso) {
    std::tm utc{};
    return strptime(iso.c_str(), "%Y-%m-%dT%H:%M:%SZ", &utc) != nullptr ? localDate(timegm(&utc)) : "";
}

std::string dateOf(std::filesystem::file_time_type changed) {
    const auto system = std::chrono::file_clock::to_sys(changed);
    return localDate(std::chrono::system_clock::to_time_t(
        std::chrono::time_point_cast<std::chrono::system_clock::duration>(system)));
}

/// Number of ticks according to the last chunk; nullopt for a truncated file.
std::optional<uint64_t> ticksAtTheEnd(RecordingReader& reader) {
    constexpr uint64_t kEnd = kChunkHeaderSize + sizeof(uint64_t);
    if (reader.size() < kFileHeaderSize + kEnd)
        return std::nullopt;
    reader.goTo(reader.size() - kEnd);
    const std::optional<RecordingReader::Item> item = reader.next();
    const auto* end = item ? std::get_if<RecordedEnd>(&item->item) : nullptr;
    return end != nullptr && !item->damageBefore ? std::optional(end->ticks) : std::nullopt;
}

/// The last note: the fault for which it was kept is the last one noted.
std::string noteIn(RecordingReader& reader) {
    std::string text;
    reader.goTo(kFileHeaderSize);
    while (const std::optional<RecordingReader::Item> item = reader.next())
        if (const auto* note = std::get_if<RecordedNote>(&item->item))
            text = note->text;
    return text;
}

/// FlightRecorder::recover keeps a session that did not end, which has no note of it.
std::string reasonOf(const RecordingFacts& facts, RecordingReader& reader) {
    if (!facts.madeBy.starts_with("flight recorder"))
        return "";
    const std::string note = noteIn(reader);
    return note.empty() ? "the program ended without closing" : note;
}

void read(RecordingFacts& facts) {
    RecordingReader reader(facts.file);
    double period = 0.0;
    bool touched = false;
    for (int i = 0; i < kFirstChunks && !touched; ++i) {
        const std::optional<RecordingReader::Item> item = reader.next();
        if (!item)
            break;
        if (const auto* origin = std::get_if<RecordingOrigin>(&item->item)) {
            facts.madeBy = origin->command;
            if (std::string date = dateOf(origin->date); !date.empty())
                facts.date = std::move(date);
            period = origin->rateHz > 0.0 ? 1.0 / origin->rateHz : 0.0;
        } else if (const auto* scene = std::get_if<RecordedScene>(&item->item)) {
            if (facts.model.empty())
                facts.model = std::filesystem::path(scene->identity.path).filename().string();
        } else if (const auto* ticks = std::get_if<RecordedTicks>(&item->item)) {
            touched = !ticks->ticks.empty();
            if (touched && period <= 0.0)
                period = ticks->ticks.back().dt;
        }
    }
    if (!touched)
        facts.problem = "there are no ticks in it";
    const std::optional<uint64_t> ticks = ticksAtTheEnd(reader);
    facts.wholeLength = ticks.has_value();
    facts.seconds = period * static_cast<double>(ticks.value_or(facts.bytes / kTickSize));
    facts.reason = reasonOf(facts, reader);
}

} // namespace

RecordingFacts recordingFacts(const std::filesystem::path& file) {
    RecordingFacts facts;
    facts.file = file;
    try {
        facts.changed = std::filesystem::last_write_time(file);
        facts.bytes = std::filesystem::file_size(file);
        facts.date = dateOf(facts.changed);
        read(facts);
    } catch (const std::exception& error) {
        facts.problem = error.what();
    }
    return facts;
}

std::vector<RecordingFacts> recordingsIn(const std::vector<std::filesystem::path>& folders,
                                         const std::vector<RecordingFacts>& known, size_t most) {
    struct File {
        std::filesystem::path path;
        std::filesystem::file_time_type changed;
        uint64_t bytes = 0;
    };
    std::vector<File> files;
    for (const std::filesystem::path& folder : folders) {
        std::error_code error;
        for (std::filesystem::directory_iterator entry(folder, error), end; !error && entry != end;
             entry.increment(error)) {
            std::error_code gone;
            if (entry->path().extension() != kRecordingEnding ||
                entry->path().filename().string().starts_with("live-") || !entry->is_regular_file(gone))
                continue;
            const File file{entry->path(), entry->last_write_time(gone), entry->file_size(gone)};
            if (!gone)
                files.push_back(file);
        }
    }
    std::ranges::sort(files, [](const File& a, const File& b) {
        return a.changed != b.changed ? a.changed > b.changed : a.path > b.path;
    });
    files.resize(std::min(files.size(), most));
    std::vector<RecordingFacts> all;
    for (const File& file : files) {
        const auto same = std::ranges::find_if(known, [&](const RecordingFacts& facts) {
            return facts.file == file.path && facts.changed == file.changed && facts.bytes == file.bytes;
        });
        all.push_back(same != known.end() ? *same : recordingFacts(file.path));
    }
    return all;
}

void RecordingList::moved(const std::filesystem::path& file, const std::filesystem::path& renamed) {
    job_.abandon(); // what it reads is old
    last_ = -kRenewal;
    if (renamed.empty())
        std::erase_if(recordings_, [&](const RecordingFacts& facts) { return facts.file == file; });
    for (RecordingFacts& facts : recordings_)
        if (facts.file == file)
            facts.file = renamed;
}

void RecordingList::update(double now) {
    if (std::optional<std::vector<RecordingFacts>> made = job_.take()) {
        recordings_ = std::move(*made);
        read_ = true;
    }
    if (job_.busy() || now - last_ < kRenewal)
        return;
    last_ = now;
    job_.start([folders = folders_, known = recordings_](const JobProgress&) {
        return recordingsIn(folders, known, kMax);
    });
}

} // namespace touchstone
