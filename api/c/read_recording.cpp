#include "api/c/read_recording.h"

#include "api/c/calls.h"

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

bool ReadRecording::readChunk() {
    const std::optional<RecordingReader::Item> item = reader_.next();
    if (!item)
        return false;
    if (const auto* ticks = std::get_if<RecordedTicks>(&item->item))
        for (const RecordedTick& tick : ticks->ticks)
            waiting_.push_back(rowOf(tick));
    else if (const auto* origin = std::get_if<RecordingOrigin>(&item->item))
        origin_ = *origin;
    else if (const auto* scene = std::get_if<RecordedScene>(&item->item))
        scene_ = scene->identity.path;
    return true;
}

size_t ReadRecording::read(const TickArrays& ticks) {
    const std::lock_guard lock(mutex_);
    refuseMissing(ticks.arrays());
    if (ticks.capacity() == 0)
        refuseArgument("ticks.capacity", "is 0");
    while (waiting_.size() < ticks.capacity() && readChunk()) {
    }
    const size_t count = std::min(waiting_.size(), ticks.capacity());
    for (size_t i = 0; i < count; ++i)
        ticks.put(i, waiting_[i]);
    waiting_.erase(waiting_.begin(), waiting_.begin() + static_cast<ptrdiff_t>(count));
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
    std::string lines;
    for (const std::string& line : reader_.damage())
        lines += (lines.empty() ? "" : "\n") + line;
    return lines;
}

} // namespace touchstone::api
