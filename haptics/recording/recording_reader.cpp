#include "haptics/recording/recording_reader.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/recording/byte_stream.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cstring>

namespace touchstone {

namespace {

constexpr size_t kMaxSentences = 20;

} // namespace

RecordingReader::RecordingReader(const std::filesystem::path& path)
    : path_(path.string()), file_(path, std::ios::binary) {
    if (!file_ || std::filesystem::is_directory(path))
        throw Error(path_, "", std::string("cannot be read: ") + std::strerror(file_ ? EISDIR : errno),
                    "check the name");
    size_ = std::filesystem::file_size(path);
    std::array<std::byte, kFileHeaderSize> header{};
    const std::string_view start(reinterpret_cast<const char*>(header.data()), kRecordingMagic.size());
    if (!bytesAt(0, header) || start != kRecordingMagic)
        throw Error(path_, "", size_ == 0 ? "is empty" : "is no recording of Touchstone",
                    "give a file that --record, the window or the flight recorder wrote");
    ByteReader bytes(std::span<const std::byte>(header).subspan(kRecordingMagic.size()));
    uint32_t headerSize = 0, reserved = 0, checksum = 0;
    bytes.get(format_);
    bytes.get(headerSize);
    bytes.get(reserved);
    bytes.get(checksum);
    if (checksum != crc32c(std::span(header).first(kFileHeaderSize - sizeof checksum)))
        throw Error(path_, "byte 0", "the header is damaged", "use another copy of the file");
    if (format_ == 0 || format_ > kRecordingVersion)
        throw Error(path_, "",
                    "is of format " + std::to_string(format_) + "; this program reads the formats 1 to " +
                        std::to_string(kRecordingVersion),
                    format_ == 0 ? "use another copy of the file" : "use a newer Touchstone");
    at_ = headerSize;
}

bool RecordingReader::bytesAt(uint64_t at, std::span<std::byte> out) {
    file_.clear();
    file_.seekg(static_cast<std::streamoff>(at));
    file_.read(reinterpret_cast<char*>(out.data()), static_cast<std::streamsize>(out.size()));
    return static_cast<size_t>(file_.gcount()) == out.size();
}

/// The chunk at `at`. Short: the file ends within it.
RecordingReader::Found RecordingReader::read(uint64_t at, Chunk& chunk, uint64_t& end) {
    if (at == size_)
        return Found::End;
    std::array<std::byte, kChunkHeaderSize> header{};
    if (!bytesAt(at, header))
        return Found::Short;
    ByteReader bytes(header);
    uint32_t sync = 0, size = 0, checksum = 0;
    bytes.get(sync);
    const std::span<const std::byte> letters = bytes.take(4);
    bytes.get(size);
    bytes.get(chunk.sequence);
    bytes.get(checksum);
    if (sync != kChunkSync || size > kLargestChunk)
        return Found::Spoilt;
    if (size > size_ - at - kChunkHeaderSize)
        return Found::Short;
    chunk.payload.resize(size);
    if (!bytesAt(at + kChunkHeaderSize, chunk.payload))
        return Found::Short;
    if (checksum != crc32c(chunk.payload, crc32c(std::span(header).subspan(4, 12))))
        return Found::Spoilt;
    const std::string_view name(reinterpret_cast<const char*>(letters.data()), letters.size());
    chunk.name =
        static_cast<size_t>(std::find(kChunkNames.begin(), kChunkNames.end(), name) - kChunkNames.begin());
    end = at + kChunkHeaderSize + size;
    return Found::Whole;
}

/// Where the next chunk may begin.
std::optional<uint64_t> RecordingReader::findSync(uint64_t from) {
    std::vector<std::byte> block(1 << 16);
    std::array<std::byte, sizeof kChunkSync> sync{};
    std::memcpy(sync.data(), &kChunkSync, sizeof kChunkSync);
    while (from + sync.size() <= size_) {
        const size_t length = static_cast<size_t>(std::min<uint64_t>(block.size(), size_ - from));
        if (!bytesAt(from, std::span(block).first(length)))
            return std::nullopt;
        const auto end = block.begin() + static_cast<std::ptrdiff_t>(length);
        const auto found = std::search(block.begin(), end, sync.begin(), sync.end());
        if (found != end)
            return from + static_cast<uint64_t>(found - block.begin());
        from += length - sync.size() + 1;
    }
    return std::nullopt;
}

void RecordingReader::spoilt(std::string what) {
    damaged_ = true;
    if (damage_.size() < kMaxSentences)
        damage_.push_back(std::move(what));
}

void RecordingReader::goTo(uint64_t offset) {
    at_ = offset;
    nextSequence_.reset();
    damaged_ = ended_ = false;
}

std::optional<RecordingReader::Item> RecordingReader::next() {
    while (!ended_) {
        Chunk chunk;
        uint64_t end = 0;
        const Found found = read(at_, chunk, end);
        if (found == Found::Whole) {
            if (nextSequence_ && chunk.sequence != *nextSequence_ && !damaged_)
                spoilt("byte " + std::to_string(at_) + ": chunks are missing");
            nextSequence_ = chunk.sequence + 1;
            const uint64_t begin = at_;
            at_ = end;
            if (chunk.name == kChunkNames.size())
                continue;
            try {
                Item item{decode(chunk.name, chunk.payload, format_), std::exchange(damaged_, false), begin};
                ended_ = std::holds_alternative<RecordedEnd>(item.item);
                return item;
            } catch (const Error& error) {
                throw Error(path_,
                            "byte " + std::to_string(begin) + " (" + std::string(kChunkNames[chunk.name]) +
                                ")" + (error.place().empty() ? "" : ", " + error.place()),
                            error.problem(), error.remedy());
            }
        }
        // The data after the last whole chunk is no chunk: damaged, or the end of what was written.
        std::optional<uint64_t> whole = found == Found::End ? std::nullopt : findSync(at_ + 1);
        while (whole && read(*whole, chunk, end) != Found::Whole)
            whole = findSync(*whole + 1);
        if (!whole) {
            ended_ = cutOff_ = true;
            if (found == Found::Spoilt)
                spoilt("byte " + std::to_string(at_) + ": spoilt to the end");
            break;
        }
        spoilt("byte " + std::to_string(at_) + ": spoilt as far as byte " + std::to_string(*whole));
        at_ = *whole;
    }
    return std::nullopt;
}

} // namespace touchstone
