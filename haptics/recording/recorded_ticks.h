#pragma once
// The payload of a block of ticks of one hand. As recording_format.cpp's of the other items: `put` writes
// what `get` reads. `get` throws Error for what cannot be. Any thread.

#include "haptics/recording/byte_stream.h"
#include "haptics/recording/recording_format.h"

namespace touchstone {

void put(ByteWriter& bytes, const RecordedTicks& ticks);
/// `format`: kRecordingVersion of the file.
void get(ByteReader& bytes, RecordedTicks& ticks, uint32_t format);

} // namespace touchstone
