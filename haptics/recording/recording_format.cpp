#include "haptics/recording/recording_format.h"

#include "engine/core/machine.h"
#include "haptics/recording/byte_stream.h"
#include "haptics/recording/recorded_settings.h"
#include "haptics/recording/recorded_world.h"

#include <algorithm>
#include <cmath>
#include <ctime>

namespace touchstone {

namespace {

// Bits of a tick.
constexpr uint32_t kSampleValid = 1, kLate = 2, kMissed = 4, kCheckpoint = 8, kBegins = 16, kInSight = 32;

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

void put(ByteWriter& bytes, const RecordedTick& tick) {
    bytes.put(tick.tick);
    bytes.put(tick.time);
    bytes.put(tick.dt);
    bytes.put(tick.sample.position);
    bytes.put(tick.sample.orientation);
    bytes.put(tick.sample.age);
    bytes.put(tick.sample.buttons);
    bytes.put(tick.settings);
    bytes.put(tick.scene);
    bytes.put((tick.sample.valid ? kSampleValid : 0) | (tick.late ? kLate : 0) | (tick.missed ? kMissed : 0) |
              (tick.checkpoint ? kCheckpoint : 0) | (tick.sample.begins ? kBegins : 0) |
              (tick.sample.inSight ? kInSight : 0));
    bytes.put(tick.wakeLatencyNs);
    bytes.put(tick.stepNs);
    for (const uint32_t hash : tick.hashes)
        bytes.put(hash);
    bytes.put(tick.proxy);
    bytes.put(tick.force);
    bytes.put(tick.command);
    bytes.put(tick.contacts);
    bytes.put(tick.flags);
}

void get(ByteReader& bytes, RecordedTick& tick) {
    uint32_t bits = 0;
    bytes.get(tick.tick);
    bytes.get(tick.time);
    bytes.get(tick.dt);
    bytes.get(tick.sample.position);
    bytes.get(tick.sample.orientation);
    bytes.get(tick.sample.age);
    bytes.get(tick.sample.buttons);
    bytes.get(tick.settings);
    bytes.get(tick.scene);
    bytes.get(bits);
    bytes.get(tick.wakeLatencyNs);
    bytes.get(tick.stepNs);
    for (uint32_t& hash : tick.hashes)
        bytes.get(hash);
    bytes.get(tick.proxy);
    bytes.get(tick.force);
    bytes.get(tick.command);
    bytes.get(tick.contacts);
    bytes.get(tick.flags);
    tick.sample.valid = (bits & kSampleValid) != 0;
    tick.late = (bits & kLate) != 0;
    tick.missed = (bits & kMissed) != 0;
    tick.checkpoint = (bits & kCheckpoint) != 0;
    tick.sample.begins = (bits & kBegins) != 0;
    tick.sample.inSight = (bits & kInSight) != 0;
    // Samples come from devices and may have any value. These two come from the program.
    if (!std::isfinite(tick.time) || !std::isfinite(tick.dt))
        throw Error("", "tick " + std::to_string(tick.tick), "has no time", "");
}

bool same(const DeviceMapping& a, const DeviceMapping& b) {
    const Similarity &s = a.workspaceFromDevice, &t = b.workspaceFromDevice;
    return s.scale == t.scale && s.rotation == t.rotation && s.translation == t.translation &&
           a.coupling == b.coupling;
}

/// For each tick i for which `changes(i)` is true, i and what `put` writes of its sample.
template <class Changes, class Put>
void putChanges(ByteWriter& bytes, const std::vector<RecordedTick>& ticks, const Changes& changes,
                const Put& put) {
    std::vector<uint32_t> places;
    for (uint32_t i = 0; i < ticks.size(); ++i)
        if (changes(i))
            places.push_back(i);
    bytes.put(static_cast<uint32_t>(places.size()));
    for (const uint32_t i : places) {
        bytes.put(i);
        put(ticks[i].sample);
    }
}

/// Gives every tick the value of the last change at or before it; before the first change the default.
/// `read` reads the value of a change at a tick. `what`: for a message.
template <class Value, class Read>
void getChanges(ByteReader& bytes, std::vector<RecordedTick>& ticks, Value DeviceSample::*field,
                const char* what, const Read& read) {
    uint32_t changes = 0, next = 0;
    bytes.get(changes);
    Value value{};
    const auto upTo = [&](uint32_t end) {
        for (; next < end; ++next)
            ticks[next].sample.*field = value;
    };
    for (uint32_t change = 0; change < changes; ++change) {
        uint32_t at = 0;
        bytes.get(at);
        if (at < next || at >= ticks.size())
            throw Error("", "", std::string("has the ") + what + " of a tick that it does not have", "");
        upTo(at);
        value = read("tick " + std::to_string(ticks[at].tick));
    }
    upTo(static_cast<uint32_t>(ticks.size()));
}

/// After the ticks: the mappings that differ from that of the preceding tick, the first from the identity.
void putMappings(ByteWriter& bytes, const std::vector<RecordedTick>& ticks) {
    const auto changes = [&](uint32_t i) {
        return !same(ticks[i].sample.mapping, i > 0 ? ticks[i - 1].sample.mapping : DeviceMapping{});
    };
    putChanges(bytes, ticks, changes, [&](const DeviceSample& sample) {
        const Similarity& map = sample.mapping.workspaceFromDevice;
        bytes.put(map.scale);
        bytes.put(map.rotation);
        bytes.put(map.translation);
        bytes.put(sample.mapping.coupling);
    });
}

/// The step accepts any mapping, but the writer writes only finite ones.
bool meant(const DeviceMapping& mapping) {
    const Similarity& map = mapping.workspaceFromDevice;
    const glm::dquat& q = map.rotation;
    bool finite = map.scale > 0.0 && mapping.coupling >= 0.0 && mapping.coupling <= 1.0;
    for (const double number :
         {map.scale, q.x, q.y, q.z, q.w, map.translation.x, map.translation.y, map.translation.z})
        finite = finite && std::isfinite(number);
    return finite;
}

void getMappings(ByteReader& bytes, std::vector<RecordedTick>& ticks) {
    getChanges(bytes, ticks, &DeviceSample::mapping, "mapping", [&](const std::string& tick) {
        DeviceMapping mapping;
        bytes.get(mapping.workspaceFromDevice.scale);
        bytes.get(mapping.workspaceFromDevice.rotation);
        bytes.get(mapping.workspaceFromDevice.translation);
        bytes.get(mapping.coupling);
        if (!meant(mapping))
            throw Error("", tick, "has a mapping that cannot be", "");
        return mapping;
    });
}

/// After the mappings: for each tick whose device has other limits than that of the preceding tick, its index
/// and the limits; those of the first tick always.
void putLimitChanges(ByteWriter& bytes, const std::vector<RecordedTick>& ticks) {
    const auto changes = [&](uint32_t i) {
        return i == 0 || ticks[i].sample.limits != ticks[i - 1].sample.limits;
    };
    putChanges(bytes, ticks, changes, [&](const DeviceSample& sample) { putLimits(bytes, sample.limits); });
}

void getLimitChanges(ByteReader& bytes, std::vector<RecordedTick>& ticks) {
    getChanges(bytes, ticks, &DeviceSample::limits, "limits", [&](const std::string& tick) {
        const std::optional<DeviceLimits> limits = getLimits(bytes);
        if (!limits)
            throw Error("", tick, "has no limits", "");
        return *limits;
    });
}

/// After the limits: the hash of each tick's poses, or none where nothing moves.
void putPoses(ByteWriter& bytes, const std::vector<RecordedTick>& ticks) {
    const bool moving =
        std::ranges::any_of(ticks, [](const RecordedTick& tick) { return tick.poses.value_or(0) != 0; });
    bytes.put(static_cast<uint32_t>(moving ? ticks.size() : 0));
    if (moving)
        for (const RecordedTick& tick : ticks)
            bytes.put(tick.poses.value_or(0));
}

void getPoses(ByteReader& bytes, std::vector<RecordedTick>& ticks) {
    uint32_t count = 0;
    bytes.get(count);
    if (count == 0)
        return;
    if (count != ticks.size())
        throw Error("", "", "has the poses of another number of ticks", "");
    for (RecordedTick& tick : ticks)
        bytes.get(*tick.poses);
}

void put(ByteWriter& bytes, const RecordedTicks& ticks) {
    bytes.put(static_cast<uint32_t>(ticks.ticks.size()));
    for (const RecordedTick& tick : ticks.ticks)
        put(bytes, tick);
    putMappings(bytes, ticks.ticks);
    putLimitChanges(bytes, ticks.ticks);
    putPoses(bytes, ticks.ticks);
}

void get(ByteReader& bytes, RecordedTicks& ticks, uint32_t format) {
    uint32_t count = 0;
    bytes.get(count);
    if (bytes.left() < size_t{count} * kTickSize)
        throw Error("", "", "holds another number of ticks than it says", "");
    ticks.ticks.resize(count);
    for (RecordedTick& tick : ticks.ticks)
        get(bytes, tick);
    // Format 1 ends here where every mapping is the identity, else behind the mappings.
    if (format > 1 || bytes.left() > 0)
        getMappings(bytes, ticks.ticks);
    if (format == 1) {
        for (RecordedTick& tick : ticks.ticks)
            tick.poses.reset();
        return;
    }
    getLimitChanges(bytes, ticks.ticks);
    getPoses(bytes, ticks.ticks);
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
