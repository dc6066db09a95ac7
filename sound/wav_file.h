#pragma once

#include "sound/loudness.h"

#include <filesystem>
#include <memory>
#include <span>

namespace touchstone {

/// Stereo, 16 bit. Written atomically: to a temporary file beside the target, which `commit` renames. One
/// thread; everything throws Error with the target's name.
class WavFile {
  public:
    /// `rate`: frames per second. Replaces an existing file.
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
