#include "haptics/recording/recorded_world.h"

#include "engine/core/error.h"
#include "engine/core/member_count.h"

#include <cmath>

namespace touchstone {

namespace {

template <class Enumeration>
void getEnumeration(ByteReader& bytes, Enumeration& value, Enumeration last, const char* what) {
    uint8_t number = 0;
    bytes.get(number);
    if (number > static_cast<uint8_t>(last))
        throw Error("", what, "is none that this version has", "");
    value = static_cast<Enumeration>(number);
}

/// Files without a painting tool are those of before there was one.
void putColor(ByteWriter& bytes, SculptTool tool, const glm::vec3& color) {
    if (tool == SculptTool::Paint)
        for (int k = 0; k < 3; ++k)
            bytes.put(color[k]);
}
void getColor(ByteReader& bytes, SculptTool tool, glm::vec3& color) {
    if (tool == SculptTool::Paint)
        for (int k = 0; k < 3; ++k)
            bytes.get(color[k]);
}

} // namespace

void put(ByteWriter& bytes, const RecordedTool& recorded) {
    const LiveTool& tool = recorded.tool;
    bytes.put(static_cast<uint8_t>(tool.active));
    bytes.put(static_cast<uint8_t>(tool.held));
    bytes.put(static_cast<uint8_t>(tool.tool));
    bytes.put(tool.object);
    bytes.put(tool.stamp);
    for (const double number : {tool.radius, tool.strength, tool.falloff, tool.resistance})
        bytes.put(number);
    putColor(bytes, tool.tool, tool.color);
}
void get(ByteReader& bytes, RecordedTool& recorded) {
    LiveTool& tool = recorded.tool;
    uint8_t active = 0, held = 0;
    bytes.get(active);
    bytes.get(held);
    getEnumeration(bytes, tool.tool, kLastSculptTool, "tool");
    bytes.get(tool.object);
    bytes.get(tool.stamp);
    for (double* const number : {&tool.radius, &tool.strength, &tool.falloff, &tool.resistance})
        bytes.get(*number);
    getColor(bytes, tool.tool, tool.color);
    tool.active = active != 0;
    tool.held = held != 0;
    if (!(tool.radius > 0.0 && std::isfinite(tool.radius + tool.resistance) && tool.strength > 0.0 &&
          tool.strength <= 1.0 && tool.falloff >= 0.0 && tool.falloff <= 1.0))
        throw Error("", "tool", "has a size or strength that cannot be", "");
}

void put(ByteWriter& bytes, const RecordedSculpt& sculpt) {
    bytes.put(sculpt.scene);
    bytes.put(sculpt.root);
    bytes.put(sculpt.hash);
    bytes.put(sculpt.first);
    bytes.put(static_cast<uint32_t>(sculpt.entries.size()));
    for (const SculptEntry& entry : sculpt.entries) {
        bytes.put(static_cast<uint8_t>(entry.kind));
        bytes.put(static_cast<uint8_t>(entry.tool));
        bytes.put(entry.object);
        bytes.put(entry.stamp);
        bytes.put(entry.tick);
        bytes.put(entry.centre);
        bytes.put(entry.motion);
        for (const double number : {entry.radius, entry.strength, entry.falloff})
            bytes.put(number);
        putColor(bytes, entry.tool, entry.color);
    }
}
/// What an entry's numbers do is checked where it is applied.
void get(ByteReader& bytes, RecordedSculpt& sculpt) {
    uint32_t count = 0;
    bytes.get(sculpt.scene);
    bytes.get(sculpt.root);
    bytes.get(sculpt.hash);
    bytes.get(sculpt.first);
    bytes.get(count);
    if (bytes.left() < size_t{count} * kSculptEntrySize ||
        bytes.left() > size_t{count} * (kSculptEntrySize + kPaintSize))
        throw Error("", "", "holds another number of edits than it says", "");
    sculpt.entries.resize(count);
    for (SculptEntry& entry : sculpt.entries) {
        getEnumeration(bytes, entry.kind, kLastSculptEntryKind, "edit");
        getEnumeration(bytes, entry.tool, kLastSculptTool, "tool");
        bytes.get(entry.object);
        bytes.get(entry.stamp);
        bytes.get(entry.tick);
        bytes.get(entry.centre);
        bytes.get(entry.motion);
        for (double* const number : {&entry.radius, &entry.strength, &entry.falloff})
            bytes.get(*number);
        getColor(bytes, entry.tool, entry.color);
    }
}

void put(ByteWriter& bytes, const RecordedContacts& contacts) {
    bytes.put(static_cast<uint32_t>(contacts.found.size()));
    for (const RecordedContacts::Found& found : contacts.found) {
        bytes.put(found.tick);
        bytes.put(found.found);
    }
}
void get(ByteReader& bytes, RecordedContacts& contacts) {
    uint32_t count = 0;
    bytes.get(count);
    for (uint32_t i = 0; i < count; ++i) { // the reader throws at the end of the chunk
        RecordedContacts::Found& found = contacts.found.emplace_back();
        bytes.get(found.tick);
        bytes.get(found.found);
    }
}
void put(ByteWriter& bytes, const RecordedBodies& bodies) {
    bytes.put(bodies.tick);
    bytes.put(static_cast<uint32_t>(bodies.bytes.size()));
    for (const std::byte byte : bodies.bytes)
        bytes.put(static_cast<uint8_t>(byte));
}
void get(ByteReader& bytes, RecordedBodies& bodies) {
    bytes.get(bodies.tick);
    uint32_t count = 0;
    bytes.get(count);
    for (uint32_t i = 0; i < count; ++i) {
        uint8_t byte = 0;
        bytes.get(byte);
        bodies.bytes.push_back(static_cast<std::byte>(byte));
    }
}

void put(ByteWriter& bytes, const RecordedTextures& textures) {
    bytes.put(textures.tick);
    bytes.put(textures.part);
    bytes.put(static_cast<uint32_t>(textures.tiles.size()));
    for (const RecordedTextures::Tile& tile : textures.tiles) {
        bytes.put(tile.object);
        bytes.put(tile.tile);
        bytes.put(static_cast<uint32_t>(tile.values.size()));
        bytes.put(std::as_bytes(std::span(tile.values)));
    }
}
void get(ByteReader& bytes, RecordedTextures& textures) {
    uint32_t count = 0;
    bytes.get(textures.tick);
    bytes.get(textures.part);
    bytes.get(count);
    for (uint32_t i = 0; i < count; ++i) { // the reader throws at the end of the chunk
        RecordedTextures::Tile& tile = textures.tiles.emplace_back();
        uint32_t values = 0;
        bytes.get(tile.object);
        bytes.get(tile.tile);
        bytes.get(values);
        if (values == 0 || values > PersistentTexture::kTile * PersistentTexture::kTile)
            throw Error("", "", "has a tile of another size than it can have", "");
        tile.values.resize(values);
        for (float& value : tile.values)
            bytes.get(value);
    }
}

void put(ByteWriter& bytes, const RecordedStrokes& strokes) {
    bytes.put(static_cast<uint32_t>(strokes.strokes.size()));
    for (const BrushStroke& stroke : strokes.strokes) {
        bytes.put(stroke.tick);
        bytes.put(stroke.object);
        bytes.put(stroke.most);
        bytes.put(stroke.point);
        bytes.put(stroke.normal);
        bytes.put(stroke.radius);
        bytes.put(stroke.change);
    }
}
void get(ByteReader& bytes, RecordedStrokes& strokes) {
    uint32_t count = 0;
    bytes.get(count);
    if (bytes.left() != size_t{count} * kBrushStrokeSize)
        throw Error("", "", "holds another number of strokes than it says", "");
    strokes.strokes.resize(count);
    for (BrushStroke& stroke : strokes.strokes) {
        bytes.get(stroke.tick);
        bytes.get(stroke.object);
        bytes.get(stroke.most);
        bytes.get(stroke.point);
        bytes.get(stroke.normal);
        bytes.get(stroke.radius);
        bytes.get(stroke.change);
    }
}

static_assert(memberCount<PadTick>() == 3 && memberCount<PadLimits>() == 2 &&
                  memberCount<LocationLimiterState>() == 1,
              "a member was added: does it change a location, or outlive the tick? Then it is recorded");

void put(ByteWriter& bytes, const RecordedLocations& locations) {
    const auto putPlace = [&](const glm::dvec2& place) {
        bytes.put(place.x);
        bytes.put(place.y);
    };
    bytes.put(locations.hand);
    putPlace(locations.before);
    bytes.put(static_cast<uint32_t>(locations.shown.size()));
    for (const RecordedLocations::Shown& shown : locations.shown) {
        bytes.put(shown.tick);
        bytes.put(shown.limits.reach);
        bytes.put(shown.limits.rate);
        putPlace(shown.location);
    }
}
void get(ByteReader& bytes, RecordedLocations& locations) {
    const auto getPlace = [&](glm::dvec2& place) {
        bytes.get(place.x);
        bytes.get(place.y);
        if (!std::isfinite(place.x) || !std::isfinite(place.y))
            throw Error("", "contact location", "is not finite", "");
    };
    uint32_t count = 0;
    bytes.get(locations.hand);
    if (locations.hand >= kMaxHands)
        throw Error("", "", "is of a hand that cannot be", "");
    getPlace(locations.before);
    bytes.get(count);
    constexpr size_t kShownSize = sizeof(uint64_t) + 4 * sizeof(double);
    if (bytes.left() != count * kShownSize)
        throw Error("", "", "holds another number of contact locations than it says", "");
    locations.shown.resize(count);
    for (RecordedLocations::Shown& shown : locations.shown) {
        bytes.get(shown.tick);
        bytes.get(shown.limits.reach);
        bytes.get(shown.limits.rate);
        getPlace(shown.location);
    }
}

void put(ByteWriter& bytes, const RecordedDriven& driven) {
    bytes.put(driven.state.tick);
    bytes.put(driven.state.count);
    for (const DrivenPose& pose : driven.state.poses()) {
        bytes.put(pose.object);
        for (const Similarity* const map : {&pose.now, &pose.goal}) {
            bytes.put(map->scale);
            bytes.put(map->rotation);
            bytes.put(map->translation);
        }
        bytes.put(pose.speed);
        bytes.put(pose.turn);
    }
}
void get(ByteReader& bytes, RecordedDriven& driven) {
    bytes.get(driven.state.tick);
    bytes.get(driven.state.count);
    if (driven.state.count > kMostDriven)
        throw Error("", "", "moves more objects than can be moved", "");
    for (uint32_t i = 0; i < driven.state.count; ++i) {
        DrivenPose& pose = driven.state.objects[i];
        bytes.get(pose.object);
        for (Similarity* const map : {&pose.now, &pose.goal}) {
            bytes.get(map->scale);
            bytes.get(map->rotation);
            bytes.get(map->translation);
            const double turned = glm::length(map->rotation), far = glm::length(map->translation);
            if (!(map->scale > 0.0) || !std::isfinite(map->scale) || !(std::abs(turned - 1.0) < 1e-6) ||
                !std::isfinite(far))
                throw Error("", "", "has a pose that cannot be", "");
        }
        bytes.get(pose.speed);
        bytes.get(pose.turn);
        if (pose.object < 0 || !(pose.speed >= 0.0 && pose.speed <= kMostDriveSpeed) ||
            !(pose.turn >= 0.0 && pose.turn <= kMostDriveTurn))
            throw Error("", "", "has a motion that cannot be", "");
    }
}

} // namespace touchstone
