#pragma once

#include "api/c/handles.h"
#include "api/c/tick_arrays.h"
#include "haptics/recording/recording_reader.h"
#include "haptics/state/device_state.h"

#include <array>
#include <deque>
#include <memory>
#include <mutex>
#include <string>
#include <string_view>

namespace touchstone::api {

/// What a ts_recording names. Each hand has its own place in the file, so that memory stays bounded by a
/// chunk whichever of them the caller reads, and how far.
class ReadRecording final : public Object {
  public:
    /// Throws Error.
    explicit ReadRecording(std::string file);

    /// That the file has ticks of, as far as it has been read. Reads up to the first tick.
    [[nodiscard]] size_t hands();
    /// The next ticks of a hand into the arrays; their number, 0 at the end. Throws Refused and Error.
    size_t read(size_t hand, const TickArrays& ticks);
    /// Throws Refused for an unknown name.
    [[nodiscard]] std::string text(std::string_view what) const;

  private:
    /// Where the ticks of one hand are read.
    struct Place {
        RecordingReader reader;
        std::deque<TickRow> waiting{};
    };
    [[nodiscard]] Place& placeOf(size_t hand);
    [[nodiscard]] size_t knownHands();
    /// False at the end of the file.
    bool readChunk(size_t hand);

    mutable std::mutex mutex_;
    std::string file_;
    std::array<std::unique_ptr<Place>, kMaxHands> places_;
    size_t hands_ = 1;
    bool begun_ = false; // hand 0 has had a tick, or the end
    RecordingOrigin origin_;
    std::string scene_;
};

} // namespace touchstone::api
