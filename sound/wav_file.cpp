#include "sound/wav_file.h"

#include "engine/core/error.h"

#include <sndfile.h>
#include <unistd.h>

#include <string>
#include <system_error>
#include <utility>

namespace touchstone {

struct WavFile::Stream {
    Stream(const std::filesystem::path& path, int rate) {
        SF_INFO info{};
        info.samplerate = rate;
        info.channels = 2;
        info.format = SF_FORMAT_WAV | SF_FORMAT_PCM_16;
        file = sf_open(path.c_str(), SFM_WRITE, &info);
        if (file != nullptr)
            sf_command(file, SFC_SET_CLIPPING, nullptr, SF_TRUE); // of 1.0, which is one step too large
    }
    ~Stream() { close(); }
    Stream(const Stream&) = delete;
    Stream& operator=(const Stream&) = delete;
    int close() { return file != nullptr ? sf_close(std::exchange(file, nullptr)) : 0; }

    SNDFILE* file = nullptr;
};

WavFile::WavFile(std::filesystem::path target, int rate) : target_(std::move(target)) {
    std::error_code error;
    if (std::filesystem::is_directory(target_, error))
        throw Error(target_.string(), "", "is a folder", "name a file in it");
    if (std::filesystem::exists(target_, error)) {
        if (!std::filesystem::is_regular_file(target_, error))
            throw Error(target_.string(), "", "is no file that can hold sound", "name a file");
        target_ = std::filesystem::canonical(target_, error); // a link is followed, not replaced
    }
    temporary_ = target_;
    temporary_ += ".part" + std::to_string(getpid());
    stream_ = std::make_unique<Stream>(temporary_, rate);
    if (stream_->file == nullptr) {
        temporary_.clear();
        throw Error(target_.string(), "", std::string("cannot be written: ") + sf_strerror(nullptr),
                    "make its folder, or choose one that you may write to");
    }
}

WavFile::~WavFile() {
    stream_.reset();
    std::error_code ignored;
    if (!temporary_.empty())
        std::filesystem::remove(temporary_, ignored);
}

void WavFile::write(std::span<const SoundFrame> frames) {
    static_assert(sizeof(SoundFrame) == 2 * sizeof(float));
    const auto count = static_cast<sf_count_t>(frames.size());
    if (count > 0 && sf_writef_float(stream_->file, &frames.front().left, count) != count)
        throw Error(target_.string(), "", std::string("writing failed: ") + sf_strerror(stream_->file),
                    "free some space on the disk");
}

void WavFile::commit() {
    const int failed = stream_->close();
    std::error_code error;
    if (failed == 0)
        std::filesystem::rename(temporary_, target_, error);
    if (failed != 0 || error)
        throw Error(target_.string(), "",
                    "writing failed: " + (error ? error.message() : std::string(sf_error_number(failed))),
                    "free some space on the disk");
    temporary_.clear();
}

} // namespace touchstone
