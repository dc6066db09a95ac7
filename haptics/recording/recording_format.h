#pragma once
// The contents of a recording; docs/recording.md has the layout byte by byte. Change both and
// kRecordingVersion together.

#include "engine/device_io/device_io.h"
#include "haptics/recording/scene_identity.h"
#include "haptics/recording/stage_hashes.h"
#include "haptics/settings/haptic_settings.h"
#include "haptics/shape/field/sculpt/live_tool.h"
#include "haptics/state/touch_checkpoint.h"
#include "haptics/texture/persistent_texture.h"
#include "haptics/tick/pad_step.h"
#include "haptics/world/driven_objects.h"

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <variant>
#include <vector>

namespace touchstone {

/// Written; the reader reads this one and all before it. Format 2 adds hands (RecordedHandTicks and
/// RecordedHandState), the limits of each tick's device, and the hash of the poses; format 3 sculpting
/// (RecordedTool and RecordedSculpt).
inline constexpr uint32_t kRecordingVersion = 3;
/// Like PNG's: a byte that is not text, both line ends and an end of file, each of which a faulty copy
/// changes.
inline constexpr std::string_view kRecordingMagic{"\x89TSR\r\n\x1a\n", 8};
inline constexpr size_t kFileHeaderSize = 24, kChunkHeaderSize = 20, kTickSize = 224, kSculptEntrySize = 90,
                        kPaintSize = 12, ///< more, of an entry of Paint
    kBrushStrokeSize = 80;
inline constexpr uint32_t kChunkSync = 0x6b6e6843;  ///< "Chnk": where reading resumes after damage
inline constexpr uint32_t kLargestChunk = 1u << 20; ///< bytes of payload: the reader's memory is bounded
inline constexpr std::string_view kRecordingEnding = ".tsrec";

/// The program that made it. Another build or processor may produce other bits.
struct RecordingOrigin {
    std::string version, build, compiler, processor;
    std::string command; ///< "touch", "run", "window", "flight recorder"
    std::string date;    ///< ISO 8601, UTC
    double rateHz = 0.0; ///< 0: ticks at individual times
};
/// This program, now.
[[nodiscard]] RecordingOrigin recordingOrigin(std::string command, double rateHz);

struct RecordedScene {
    uint32_t number = 0; ///< number by which ticks name it; 0 is no scene
    SceneIdentity identity;
};
struct RecordedSettings {
    uint32_t number = 0;
    HapticSettings settings;
};
struct RecordedTick {
    uint64_t tick = 0;
    double time = 0.0, dt = 0.0; ///< s
    DeviceSample sample;         ///< format 1: without limits, which are those of the scene (SceneIdentity)
    uint32_t settings = 0, scene = 0;
    std::optional<uint32_t> poses = 0; ///< WorldState::poseHash; null: format 1 does not have it
    uint32_t found = 0;                ///< WorldState::foundContacts (RecordedContacts)
    bool late = false, missed = false, checkpoint = false;
    int32_t wakeLatencyNs = 0, stepNs = 0;
    StageHashes hashes{};
    // For people; only the hashes are compared.
    glm::dvec3 proxy{0.0}, force{0.0}; ///< m, N, stages 6 and 7, workspace
    glm::dvec3 command{0.0};           ///< N, device frame
    uint32_t contacts = 0, flags = 0;
    PadTick pad; ///< RecordedLocations
};
/// Of hand 0, with the mapping, the limits and the poses of each.
struct RecordedTicks {
    std::vector<RecordedTick> ticks;
};
/// The same ticks of another hand; before those of hand 0.
struct RecordedHandTicks {
    uint32_t hand = 0;
    RecordedTicks ticks;
};
/// The state of another hand than hand 0 (TouchCheckpoint::hand); after that of hand 0.
struct RecordedHandState {
    TouchCheckpoint checkpoint;
};
/// The tool of all ticks from here to the next one; before the first: none is active.
struct RecordedTool {
    LiveTool tool;
};
/// Before the first tick in a scene that was sculpted: `scene` is that of `root` (RecordedScene) after the
/// journal's entries up to the last of these.
struct RecordedSculpt {
    uint32_t scene = 0, root = 0;
    uint64_t hash = 0;                ///< of the fields, SceneSculptor::hash; 0: the next chunk goes on
    uint32_t first = 0;               ///< place of the first entry in the root's journal
    std::vector<SculptEntry> entries; ///< may repeat what earlier chunks of the file hold
};
/// When contacts of bodies came, for the ticks that follow; only of scenes with bodies.
struct RecordedContacts {
    struct Found {
        uint64_t tick = 0;
        uint32_t found = 0; ///< RecordedTick::found, > 0
    };
    std::vector<Found> found;
};
/// The bodies before a tick, for its checkpoint (body::BodyWorld::save).
struct RecordedBodies {
    uint64_t tick = 0;
    std::vector<std::byte> bytes;
};
/// The persistent textures before a tick, whole: the tiles that differ from the initial value. Large ones
/// take several chunks, the first of which has `part` 0.
struct RecordedTextures {
    struct Tile {
        uint32_t object = 0, tile = 0;
        std::vector<float> values; ///< PersistentTexture::tileValues; one: all are equal
    };
    uint64_t tick = 0;
    uint32_t part = 0;
    std::vector<Tile> tiles;
};
/// What the ticks that follow change of the textures; only of scenes that have some.
struct RecordedStrokes {
    std::vector<BrushStroke> strokes;
};
/// What a hand's contact location display showed in the ticks that follow; only of hands with one.
struct RecordedLocations {
    struct Shown {
        uint64_t tick = 0;
        PadLimits limits;
        glm::dvec2 location{0.0}; ///< m, after safety
    };
    uint32_t hand = 0;
    glm::dvec2 before{0.0}; ///< m, before the first of them
    std::vector<Shown> shown;
};
/// Objects that a caller moves, before a tick: at checkpoints and where goals came.
struct RecordedDriven {
    DrivenState state;
};
/// Ticks that were made but not recorded.
struct RecordedLoss {
    uint64_t ticks = 0;
};
struct RecordedNote {
    uint64_t tick = 0;
    std::string text;
};
/// The recording ended properly.
struct RecordedEnd {
    uint64_t ticks = 0;
};
using RecordedItem =
    std::variant<RecordingOrigin, RecordedScene, RecordedSettings, TouchCheckpoint, RecordedTicks,
                 RecordedLoss, RecordedNote, RecordedEnd, RecordedHandTicks, RecordedHandState, RecordedTool,
                 RecordedSculpt, RecordedContacts, RecordedBodies, RecordedTextures, RecordedStrokes,
                 RecordedLocations, RecordedDriven>;

/// Four letters each, in the order of RecordedItem's alternatives.
inline constexpr std::array<std::string_view, 18> kChunkNames{"MADE", "SCEN", "SETT", "STAT", "TICK", "LOST",
                                                              "NOTE", "DONE", "HTIC", "HSTA", "TOOL", "SCLP",
                                                              "BCON", "BSTA", "PTEX", "PSTR", "LOCA", "OMOV"};

/// The payload of an item's chunk.
[[nodiscard]] std::vector<std::byte> encode(const RecordedItem& item);

/// The item of chunk `name` (index into kChunkNames). Throws Error (with `problem` alone) where the payload
/// is invalid: too short, or with values that no writer of that format writes.
[[nodiscard]] RecordedItem decode(size_t name, std::span<const std::byte> payload,
                                  uint32_t format = kRecordingVersion);

} // namespace touchstone
