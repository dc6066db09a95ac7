// The start of a servo's tick: what its owner has offered since the last one, and checkpoints.

#include "haptics/body/body_world.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/take_up_part.h"
#include "haptics/servo/servo_touch.h"
#include "haptics/world/soft_states.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

/// Switches to another scene. The checkpoint taken then drops the candidates, which point into the previous
/// one.
void ServoLoop::adopt(Touch& touch, const Offer* offer) noexcept {
    const bool edited = offer != nullptr && offer->geometry == 0; // of the present root (prepare)
    const uint32_t geometry = offer == nullptr ? 0 : edited ? touch.geometry : offer->geometry;
    const bool goesOn = geometry != 0 && geometry == touch.geometry;
    const uint32_t part = offer == nullptr ? 0 : edited ? touch.part : offer->part;
    const bool otherPart = part != touch.part;
    touch.offer = offer;
    touch.geometry = geometry;
    touch.part = part;
    if (offer != nullptr)
        offer->world.forget();
    if (goesOn && touch.takeOver(*offer, otherPart))
        return;
    // A new world: forget the proxy, fade the force in, but keep the command that the device still holds.
    for (DeviceState& device : touch.devices) {
        letGo(device);
        device.dents = {};
        device.grasp = {};
        ForceLimiter::restartRamp(device.limiter);
    }
    for (ToolPath& path : touch.paths)
        path.release();
    for (Touch::Felt& felt : touch.felt)
        felt.feedback = TouchFeedback{};
    touch.previousTime = std::numeric_limits<double>::quiet_NaN();
}

/// True where touch can go on in `next`: its vertices of the preceding tick are published, and in that tick
/// the hands felt those; or the publisher, who is told where that is, had `longest` ticks, of which `waited`
/// are over. Else the servo or the thread that offers stood still for longer than is published ahead, or the
/// animation was wound on with the offer. (Failed: an offer taken up after a tick whose vertices had stood
/// still left the hand beside the sheet.)
bool ServoLoop::Touch::canTakeOver(const Offer& next, uint64_t longest, uint64_t& waited) const noexcept {
    const bool sameGeometry = next.geometry == 0 ? next.root == root : next.geometry == geometry;
    const bool goesOn = sameGeometry && offer != nullptr && std::isfinite(previousTime);
    if (goesOn && (offer->world.held() || !next.world.reach(previousTime, offer->world)) &&
        waited++ < longest)
        return false;
    waited = 0;
    return true;
}

/// Touch goes on in a scene of equal geometry. False where it cannot: the vertices of the preceding tick are
/// not published. The hands would be taken over on vertices of another time, and a replay, which has all
/// of them, would differ from there on.
bool ServoLoop::Touch::takeOver(const Offer& next, bool otherPart) noexcept {
    next.world.begin(previousTime); // as in a replay that resumes here
    if (next.world.held()) {
        next.world.forget();
        return false;
    }
    const ObjectMotions moved = next.world.poses();
    const ObjectMotions motions = moved.empty() ? ObjectMotions(next.scene->restMotions) : moved;
    for (DeviceState& device : devices) {
        if (otherPart)
            takeUpPart(*next.scene, next.world.touched(*next.scene),
                       next.before == root ? next.partBefore.get() : nullptr, motions, feltRadius(*settings),
                       device);
        else
            letGoOfEmptied(*next.scene, motions, device);
        if (!next.reshaped.empty())
            takeUpReshaped(*next.scene, motions, next.reshaped, device);
    }
    return true;
}

/// Start of a tick: the newest scene and settings, and checkpoints where they are due.
void ServoLoop::prepare(Touch& touch) noexcept {
    TickRecord& record = touch.record();
    // The scene first: settings that were sent before it was offered are there.
    const auto longestAside = static_cast<uint64_t>(config_.longestAside * config_.rateHz);
    const Offer* const root = scene_.adopt([&](const Offer* next) {
        return next == nullptr || touch.canTakeOver(*next, longestAside, touch.aside);
    });
    settings_.update();
    const NumberedSettings& settings = root != nullptr && root->settings.number > settings_.value().number
                                           ? root->settings
                                           : settings_.value();
    touch.settings = &settings.settings;
    record.settings = settings.number;
    if (forceSwitch_.off()) {
        touch.settings = &settings.withoutForce;
        record.settings |= kWithoutForce;
    }
    tools_.update();
    record.tool = tools_.value().number;
    touch.tool = tools_.value().tool.active ? &tools_.value().tool : nullptr;
    const Offer* offer = root;
    record.root = root != nullptr ? root->root : 0;
    const Offer* const edited = edited_.adopt([&](const Offer* next) {
        // In the root's first tick what was felt is released. An edit of a scene that waits itself waits
        // behind it.
        if (root != nullptr && root->root == touch.root && next->root == root->root)
            return touch.canTakeOver(*next, longestAside, touch.editAside);
        touch.editAside = 0;
        return root == nullptr || next->root <= root->root;
    });
    if (edited != nullptr && root != nullptr && edited->root == root->root)
        offer = edited;
    // An edit leaves the world's state as it is: the hands' alone is kept, and a replay goes on with its own.
    bool whole = record.tick >= touch.nextCheckpoint || checkpointWanted_.load(std::memory_order_relaxed);
    bool due = whole;
    if (const uint32_t number = offer != nullptr ? offer->number : 0; number != touch.scene) {
        if (offer != root && record.root != touch.root)
            adopt(touch, root); // its first edit came before its first tick
        adopt(touch, offer);
        if (offer != nullptr && offer->oldestEdit > 0)
            record.editDelay = static_cast<uint32_t>(record.tick - offer->oldestEdit);
        due = true;
        whole = whole || offer == root || record.root != touch.root || std::isnan(touch.previousTime);
        touch.scene = number;
        touch.root = record.root;
    }
    record.scene = touch.scene;
    record.checkpoint = due;
    if (due)
        takeCheckpoints(touch, whole);
    record.whole = due && (record.keptState || offer == nullptr ||
                           (offer->world.bodies() == nullptr && offer->world.soft() == nullptr));
    if (offer != nullptr && offer->world.driven() != nullptr) [[unlikely]]
        offer->world.driven()->begin(record.tick, record.dt, record.checkpoint);
}

/// One of every hand, that of hand 0 the last. `whole`: with the state of what moves, so that a replay can
/// begin here.
void ServoLoop::takeCheckpoints(Touch& touch, bool whole) noexcept {
    TickRecord& record = touch.record();
    if (whole) {
        checkpointWanted_.store(false, std::memory_order_relaxed);
        touch.nextCheckpoint =
            record.tick + static_cast<uint64_t>(std::max(1.0, config_.checkpointSeconds * config_.rateHz));
    }
    if (whole && touch.offer != nullptr)
        record.keptState = touch.offer->world.keepState(record.tick);
    const size_t count = touch.checkpoints.size();
    for (size_t i = 0; i < count; ++i) {
        const size_t hand = count - 1 - i;
        TouchCheckpoint& checkpoint = touch.checkpoints[i];
        checkpoint.tick = record.tick;
        checkpoint.hand = static_cast<uint32_t>(hand);
        checkpoint.scene = record.scene;
        checkpoint.previousTime = touch.previousTime;
        takeCheckpoint(touch.devices[hand], checkpoint);
    }
    checkpoints_.push(touch.checkpoints);
}

} // namespace touchstone
