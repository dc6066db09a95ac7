#include "engine/core/output_file.h"

#include "engine/core/error.h"

#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <system_error>

namespace touchstone {

OutputFile::OutputFile(std::filesystem::path target) : target_(std::move(target)) {
    if (std::filesystem::is_directory(target_))
        throw Error(target_.string(), "", "is a folder", "name a file in it");
    // A pipe or a terminal (/dev/stdout) is written to directly; a link is followed, not replaced.
    std::filesystem::path opened = target_;
    if (!std::filesystem::exists(target_) || std::filesystem::is_regular_file(target_)) {
        if (std::filesystem::is_symlink(target_) && std::filesystem::exists(target_))
            target_ = std::filesystem::canonical(target_);
        temporary_ = target_;
        temporary_ += ".part" + std::to_string(getpid());
        opened = temporary_;
    }
    stream_.open(opened, std::ios::binary | std::ios::trunc);
    if (!stream_) {
        const std::string why = std::strerror(errno);
        temporary_.clear();
        throw Error(target_.string(), "", "cannot be written: " + why,
                    "make its folder, or choose one that you may write to");
    }
}

OutputFile::~OutputFile() {
    if (temporary_.empty())
        return;
    stream_.close();
    std::error_code ignored;
    std::filesystem::remove(temporary_, ignored);
}

void OutputFile::write(std::string_view text) {
    stream_.write(text.data(), static_cast<std::streamsize>(text.size()));
    if (!stream_)
        throw Error(target_.string(), "", std::string("writing failed: ") + std::strerror(errno),
                    "free some space on the disk");
}

void OutputFile::commit() {
    stream_.close();
    std::error_code error;
    if (stream_ && !temporary_.empty())
        std::filesystem::rename(temporary_, target_, error);
    if (!stream_ || error)
        throw Error(target_.string(), "",
                    "writing failed: " + (error ? error.message() : std::strerror(errno)),
                    "free some space on the disk");
    temporary_.clear();
}

void writeFile(const std::filesystem::path& target, std::string_view text) {
    OutputFile file(target);
    file.write(text);
    file.commit();
}

} // namespace touchstone
