#include "haptics/recording/recording_file.h"

#include "engine/core/checksum.h"
#include "engine/core/error.h"
#include "haptics/recording/byte_stream.h"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>

namespace touchstone {

namespace {

std::vector<std::byte> fileHeader() {
    std::vector<std::byte> header;
    ByteWriter bytes(header);
    bytes.put(std::as_bytes(std::span(kRecordingMagic)));
    bytes.put(kRecordingVersion);
    bytes.put(static_cast<uint32_t>(kFileHeaderSize));
    bytes.put(uint32_t{0});
    bytes.put(crc32c(header));
    return header;
}

} // namespace

std::vector<std::byte> chunkOf(const RecordedItem& item, uint32_t sequence) {
    const std::vector<std::byte> payload = encode(item);
    std::vector<std::byte> covered; // by the checksum
    ByteWriter inner(covered);
    inner.put(std::as_bytes(std::span(kChunkNames[item.index()])));
    inner.put(static_cast<uint32_t>(payload.size()));
    inner.put(sequence);
    std::vector<std::byte> chunk;
    ByteWriter bytes(chunk);
    bytes.put(kChunkSync);
    bytes.put(std::span<const std::byte>(covered));
    bytes.put(crc32c(payload, crc32c(covered)));
    bytes.put(std::span<const std::byte>(payload));
    return chunk;
}

RecordingFile::RecordingFile(std::filesystem::path path, uint32_t sequence)
    : path_(std::move(path)), sequence_(sequence) {
    descriptor_ = open(path_.c_str(), O_WRONLY | O_CREAT | O_TRUNC | O_CLOEXEC, 0644);
    if (descriptor_ < 0)
        throw Error(path_.string(), "", std::string("cannot be written: ") + std::strerror(errno),
                    "make its folder, or choose one that you may write to");
    try {
        write(fileHeader());
    } catch (...) {
        close(descriptor_);
        throw;
    }
}

RecordingFile::~RecordingFile() {
    close(descriptor_);
}

void RecordingFile::append(const RecordedItem& item) {
    write(chunkOf(item, sequence_));
    ++sequence_;
}

void RecordingFile::write(std::span<const std::byte> bytes) {
    size_t done = 0;
    while (done < bytes.size()) {
        const ssize_t wrote = ::write(descriptor_, bytes.data() + done, bytes.size() - done);
        if (wrote < 0 && errno == EINTR)
            continue;
        if (wrote <= 0) {
            const int problem = wrote < 0 ? errno : ENOSPC;
            // Not possible for a pipe or /dev/full; a reader then cuts off the rest.
            if (ftruncate(descriptor_, static_cast<off_t>(bytes_)) == 0)
                lseek(descriptor_, static_cast<off_t>(bytes_), SEEK_SET);
            throw Error(path_.string(), "", std::string("recording failed: ") + std::strerror(problem),
                        problem == EFBIG
                            ? "raise the limit on the size of files (ulimit -f)"
                            : "free some space on the disk; what was recorded until now is there");
        }
        done += static_cast<size_t>(wrote);
    }
    bytes_ += bytes.size();
}

} // namespace touchstone
