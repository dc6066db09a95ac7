#pragma once
// The payloads of what changes the world while it is touched (the tool, edits of fields, bodies, persistent
// textures, objects that a caller moves) and of contact locations. As recording_format.cpp's of the hands:
// `put` writes what `get` reads. `get` throws Error for what cannot be. Any thread.

#include "haptics/recording/byte_stream.h"
#include "haptics/recording/recording_format.h"

namespace touchstone {

void put(ByteWriter& bytes, const RecordedTool& tool);
void get(ByteReader& bytes, RecordedTool& tool);
void put(ByteWriter& bytes, const RecordedSculpt& sculpt);
void get(ByteReader& bytes, RecordedSculpt& sculpt);
void put(ByteWriter& bytes, const RecordedContacts& contacts);
void get(ByteReader& bytes, RecordedContacts& contacts);
void put(ByteWriter& bytes, const RecordedBodies& bodies);
void get(ByteReader& bytes, RecordedBodies& bodies);
void put(ByteWriter& bytes, const RecordedTextures& textures);
void get(ByteReader& bytes, RecordedTextures& textures);
void put(ByteWriter& bytes, const RecordedStrokes& strokes);
void get(ByteReader& bytes, RecordedStrokes& strokes);
void put(ByteWriter& bytes, const RecordedLocations& locations);
void get(ByteReader& bytes, RecordedLocations& locations);
void put(ByteWriter& bytes, const RecordedDriven& driven);
void get(ByteReader& bytes, RecordedDriven& driven);

} // namespace touchstone
