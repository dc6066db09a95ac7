#include "haptics/recording/recorded_ticks.h"

#include "haptics/recording/recorded_settings.h"

#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace touchstone {

namespace {

// Bits of a tick.
constexpr uint32_t kSampleValid = 1, kLate = 2, kMissed = 4, kCheckpoint = 8, kBegins = 16, kInSight = 32;

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

} // namespace

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

} // namespace touchstone
