#pragma once

#include "api/c/handles.h"
#include "api/c/tick_arrays.h"
#include "haptics/recording/recording_reader.h"

#include <deque>
#include <mutex>
#include <string>
#include <string_view>

namespace touchstone::api {

/// What a ts_recording names.
class ReadRecording final : public Object {
  public:
    /// Throws Error.
    explicit ReadRecording(const std::string& file) : reader_(file) {}

    /// The next ticks into the arrays; their number, 0 at the end. Throws Refused and Error.
    size_t read(const TickArrays& ticks);
    /// Throws Refused for an unknown name.
    [[nodiscard]] std::string text(std::string_view what) const;

  private:
    /// False at the end of the file.
    bool readChunk();

    mutable std::mutex mutex_;
    RecordingReader reader_;
    RecordingOrigin origin_;
    std::string scene_;
    std::deque<TickRow> waiting_;
};

} // namespace touchstone::api
