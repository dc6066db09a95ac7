#pragma once

#include "sound/synthesizer.h"
#include "sound/wav_file.h"

#include <filesystem>
#include <vector>

namespace touchstone {

/// The sound of an offline run as a WAV file: second t of it is second t of the path. Full scale is full
/// volume.
class WrittenSound {
  public:
    static constexpr int kRate = 48000;                        ///< frames per second
    static constexpr double kShortest = 1e-4, kLongest = 0.05; ///< s, range of a tick's duration

    /// Throws Error with the file's name.
    explicit WrittenSound(const std::filesystem::path& file) : file_(file, kRate), frames_(kBlock) {}

    void add(const SoundTick& tick);
    void commit();

  private:
    static constexpr size_t kBlock = 4096;

    void render();

    WavFile file_;
    Synthesizer synthesizer_{kRate};
    std::vector<SoundFrame> frames_;
    SoundTick last_;
    double seconds_ = 0.0;             // of the ticks so far
    size_t written_ = 0, skipped_ = 0; // frames
    size_t early_ = 0;                 // frames before that of the first tick
};

} // namespace touchstone
