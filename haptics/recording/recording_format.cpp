#include "haptics/recording/recording_format.h"

#include "engine/core/machine.h"
#include "haptics/recording/byte_stream.h"
#include "haptics/recording/recorded_settings.h"
#include "haptics/recording/recorded_ticks.h"
#include "haptics/recording/recorded_world.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace touchstone {

namespace {

void put(ByteWriter& bytes, const RecordingOrigin& origin) {
    for (const std::string* text :
         {&origin.version, &origin.build, &origin.compiler, &origin.processor, &origin.command, &origin.date})
        bytes.put(*text);
    bytes.put(origin.rateHz);
}

void get(ByteReader& bytes, RecordingOrigin& origin) {
    for (std::string* text :
         {&origin.version, &origin.build, &origin.compiler, &origin.processor, &origin.command, &origin.date})
        bytes.get(*text);
    bytes.get(origin.rateHz);
}

/// Nodes, then the clipping plane if there is one.
void put(ByteWriter& bytes, const ScenePart& part) {
    bytes.put(static_cast<uint32_t>(part.hidden.size()));
    for (const int node : part.hidden)
        bytes.put(static_cast<int32_t>(node));
    bytes.put(static_cast<uint8_t>(part.clip.has_value()));
    if (!part.clip)
        return;
    bytes.put(part.clip->normal);
    bytes.put(part.clip->offset);
}

void get(ByteReader& bytes, ScenePart& part) {
    uint32_t count = 0;
    bytes.get(count);
    for (int32_t node = 0, before = -1; count > 0; --count, before = node) {
        bytes.get(node);
        if (node <= before)
            throw Error("", "hidden nodes", "are not in order", "");
        part.hidden.push_back(node);
    }
    uint8_t clips = 0;
    bytes.get(clips);
    if (clips == 0)
        return;
    ClipPlane plane;
    bytes.get(plane.normal);
    bytes.get(plane.offset);
    // Distances from it are measured by its normal, whose length the writer makes 1 up to rounding.
    if (!clipPlane(plane.normal, plane.offset) || !(std::abs(glm::length(plane.normal) - 1.0) <= 1e-9))
        throw Error("", "clipping plane", "has no direction or place", "");
    part.clip = plane;
}

void put(ByteWriter& bytes, const RecordedScene& scene) {
    const SceneIdentity& identity = scene.identity;
    bytes.put(scene.number);
    bytes.put(identity.path);
    bytes.put(identity.absolutePath);
    bytes.put(static_cast<uint8_t>(identity.generated));
    bytes.put(static_cast<uint8_t>(identity.fit));
    bytes.put(identity.fileSize);
    bytes.put(identity.fileHash);
    bytes.put(identity.feltHash);
    putLimits(bytes, identity.limits);
    if (!identity.edits.empty() || !identity.part.whole())
        bytes.put(identity.edits);
    if (!identity.part.whole())
        put(bytes, identity.part);
}

void get(ByteReader& bytes, RecordedScene& scene) {
    SceneIdentity& identity = scene.identity;
    uint8_t generated = 0, fit = 0;
    bytes.get(scene.number);
    bytes.get(identity.path);
    bytes.get(identity.absolutePath);
    bytes.get(generated);
    bytes.get(fit);
    bytes.get(identity.fileSize);
    bytes.get(identity.fileHash);
    bytes.get(identity.feltHash);
    identity.limits = getLimits(bytes);
    identity.generated = generated != 0;
    if (fit > static_cast<uint8_t>(Fit::Workspace))
        throw Error("", "fit", "is none that this version has", "");
    identity.fit = static_cast<Fit>(fit);
    if (bytes.left() > 0)
        bytes.get(identity.edits);
    if (bytes.left() > 0)
        get(bytes, identity.part);
}

void put(ByteWriter& bytes, const RecordedSettings& settings) {
    bytes.put(settings.number);
    putSettings(bytes, settings.settings);
}

void get(ByteReader& bytes, RecordedSettings& settings) {
    bytes.get(settings.number);
    settings.settings = getSettings(bytes);
}

void put(ByteWriter& bytes, const TouchCheckpoint& checkpoint) {
    bytes.put(checkpoint.tick);
    bytes.put(checkpoint.scene);
    bytes.put(checkpoint.previousTime);
    bytes.put(checkpoint.size);
    bytes.put(checkpoint.state());
}

void get(ByteReader& bytes, TouchCheckpoint& checkpoint) {
    bytes.get(checkpoint.tick);
    bytes.get(checkpoint.scene);
    bytes.get(checkpoint.previousTime);
    bytes.get(checkpoint.size);
    if (checkpoint.size > TouchCheckpoint::kCapacity)
        throw Error("", "", "is larger than any state", "");
    const std::span<const std::byte> state = bytes.take(checkpoint.size);
    std::copy(state.begin(), state.end(), checkpoint.bytes.begin());
}

/// Hand 0 has chunks of its own, and there are kMaxHands at most.
uint32_t otherHand(uint32_t hand) {
    if (hand == 0 || hand >= kMaxHands)
        throw Error("", "", "is of a hand that cannot be", "");
    return hand;
}

void put(ByteWriter& bytes, const RecordedHandTicks& ticks) {
    bytes.put(ticks.hand);
    put(bytes, ticks.ticks);
}
void get(ByteReader& bytes, RecordedHandTicks& ticks, uint32_t format) {
    bytes.get(ticks.hand);
    (void)otherHand(ticks.hand);
    get(bytes, ticks.ticks, format);
}
void put(ByteWriter& bytes, const RecordedHandState& state) {
    bytes.put(state.checkpoint.hand);
    put(bytes, state.checkpoint);
}
void get(ByteReader& bytes, RecordedHandState& state) {
    uint32_t hand = 0;
    bytes.get(hand);
    get(bytes, state.checkpoint);
    state.checkpoint.hand = otherHand(hand);
}

void put(ByteWriter& bytes, const RecordedLoss& loss) {
    bytes.put(loss.ticks);
}
void get(ByteReader& bytes, RecordedLoss& loss) {
    bytes.get(loss.ticks);
}
void put(ByteWriter& bytes, const RecordedNote& note) {
    bytes.put(note.tick);
    bytes.put(note.text);
}
void get(ByteReader& bytes, RecordedNote& note) {
    bytes.get(note.tick);
    bytes.get(note.text);
}
void put(ByteWriter& bytes, const RecordedEnd& end) {
    bytes.put(end.ticks);
}
void get(ByteReader& bytes, RecordedEnd& end) {
    bytes.get(end.ticks);
}

/// The other items have the same layout in every format.
template <class Item>
void get(ByteReader& bytes, Item& item, uint32_t) {
    get(bytes, item);
}

template <size_t... I>
RecordedItem decodeAs(size_t name, ByteReader& bytes, uint32_t format, std::index_sequence<I...>) {
    RecordedItem item;
    ((I == name ? get(bytes, item.emplace<I>(), format) : void()), ...);
    return item;
}

} // namespace

RecordingOrigin recordingOrigin(std::string command, double rateHz) {
    const std::time_t now = std::time(nullptr);
    std::tm utc{};
    gmtime_r(&now, &utc);
    std::array<char, 32> date{};
    std::strftime(date.data(), date.size(), "%Y-%m-%dT%H:%M:%SZ", &utc);
    return {TOUCHSTONE_VERSION, buildIdentity(), compilerName(), processorName(),
            std::move(command), date.data(),     rateHz};
}

std::vector<std::byte> encode(const RecordedItem& item) {
    std::vector<std::byte> payload;
    ByteWriter bytes(payload);
    std::visit([&](const auto& value) { put(bytes, value); }, item);
    return payload;
}

RecordedItem decode(size_t name, std::span<const std::byte> payload, uint32_t format) {
    ByteReader bytes(payload);
    RecordedItem item =
        decodeAs(name, bytes, format, std::make_index_sequence<std::variant_size_v<RecordedItem>>());
    if (bytes.left() != 0)
        throw Error("", "", "holds more than it should", "");
    return item;
}

} // namespace touchstone
