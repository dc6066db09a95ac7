#pragma once

#include "sound/loudness.h"

#include <filesystem>
#include <memory>
#include <span>

namespace touchstone {

/// Stereo, 16 bit. There as a whole or not at all: written under a temporary name beside the target, renamed
/// by `commit`. One thread; everything throws Error that names the target.
class WavFile {
  public:
    /// `rate`: frames a second. A file that is there is replaced.
    WavFile(std::filesystem::path target, int rate);
    ~WavFile();
    WavFile(const WavFile&) = delete;
    WavFile& operator=(const WavFile&) = delete;

    void write(std::span<const SoundFrame> frames);
    void commit();

  private:
    struct Stream; // libsndfile's
    std::filesystem::path target_, temporary_;
    std::unique_ptr<Stream> stream_;
};

} // namespace touchstone
