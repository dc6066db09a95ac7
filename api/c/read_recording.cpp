#include "api/c/read_recording.h"

#include "api/c/calls.h"

#include <algorithm>
#include <utility>
#include <vector>

namespace touchstone::api {

namespace {

TickRow rowOf(const RecordedTick& tick) {
    TickRow row;
    row.time = tick.time;
    row.hip = tick.sample.inWorkspace();
    row.proxy = tick.proxy;
    row.force = tick.force;
    row.command = tick.sample.mapping.workspaceFromDevice.direction(tick.command);
    row.contacts = tick.contacts;
    row.flags = tick.flags;
    row.stepNs = tick.stepNs;
    return row;
}

void refuseMissing(const ts_ticks& arrays) {
    const auto refuse = [](const void* array, const char* member) {
        if (array != nullptr)
            refuseArgument(std::string("ticks.") + member, "a recording does not have it; give null");
    };
    refuse(arrays.normal, "normal");
    refuse(arrays.penetration, "penetration");
    refuse(arrays.friction, "friction");
    refuse(arrays.object, "object");
    refuse(arrays.triangle, "triangle");
}

} // namespace

ReadRecording::ReadRecording(std::string file) : file_(std::move(file)) {
    (void)placeOf(0); // whether it is a recording
}

ReadRecording::Place& ReadRecording::placeOf(size_t hand) {
    if (places_[hand] == nullptr)
        places_[hand] = std::make_unique<Place>(Place{RecordingReader(file_)});
    return *places_[hand];
}

bool ReadRecording::readChunk(size_t hand) {
    Place& place = placeOf(hand);
    const std::optional<RecordingReader::Item> item = place.reader.next();
    begun_ = begun_ || !item;
    if (!item)
        return false;
    const auto keep = [&](const RecordedTicks& ticks, size_t of) {
        hands_ = std::max(hands_, of + 1);
        for (const RecordedTick& tick : ticks.ticks)
            if (of == hand)
                place.waiting.push_back(rowOf(tick));
    };
    if (const auto* ticks = std::get_if<RecordedTicks>(&item->item)) {
        keep(*ticks, 0);
        begun_ = true; // the same ticks of the other hands stand before it
    } else if (const auto* others = std::get_if<RecordedHandTicks>(&item->item))
        keep(others->ticks, others->hand);
    else if (const auto* origin = std::get_if<RecordingOrigin>(&item->item))
        origin_ = *origin;
    else if (const auto* scene = std::get_if<RecordedScene>(&item->item))
        scene_ = scene->identity.path;
    return true;
}

size_t ReadRecording::knownHands() {
    while (!begun_ && readChunk(0)) {
    }
    return hands_;
}

size_t ReadRecording::hands() {
    const std::lock_guard lock(mutex_);
    return knownHands();
}

size_t ReadRecording::read(size_t hand, const TickArrays& ticks) {
    const std::lock_guard lock(mutex_);
    refuseMissing(ticks.arrays());
    if (ticks.capacity() == 0)
        refuseArgument("ticks.capacity", "is 0");
    requireBelow(hand, knownHands(), "hand");
    std::deque<TickRow>& waiting = placeOf(hand).waiting;
    while (waiting.size() < ticks.capacity() && readChunk(hand)) {
    }
    const size_t count = std::min(waiting.size(), ticks.capacity());
    for (size_t i = 0; i < count; ++i)
        ticks.put(i, waiting[i]);
    waiting.erase(waiting.begin(), waiting.begin() + static_cast<ptrdiff_t>(count));
    return count;
}

std::string ReadRecording::text(std::string_view what) const {
    const std::lock_guard lock(mutex_);
    if (what == "version")
        return origin_.version;
    if (what == "build")
        return origin_.build;
    if (what == "processor")
        return origin_.processor;
    if (what == "command")
        return origin_.command;
    if (what == "date")
        return origin_.date;
    if (what == "scene")
        return scene_;
    if (what != "damage")
        refuseArgument("what", "'" + std::string(what) +
                                   "' is none of version, build, processor, command, date, scene, damage");
    const auto damageOf = [](const auto& place) {
        return place != nullptr ? place->reader.damage() : std::vector<std::string>();
    };
    std::string lines; // of the place that has seen most of it
    const auto furthest =
        std::ranges::max_element(places_, {}, [&](const auto& place) { return damageOf(place).size(); });
    for (const std::string& line : damageOf(*furthest))
        lines += (lines.empty() ? "" : "\n") + line;
    return lines;
}

} // namespace touchstone::api
