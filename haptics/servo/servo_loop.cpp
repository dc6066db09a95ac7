#include "haptics/servo/servo_loop.h"

#include "engine/core/error.h"
#include "engine/core/float_mode.h"
#include "engine/core/realtime_guard.h"
#include "haptics/body/body_world.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/proxy/take_up_part.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/world/soft_objects.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace touchstone {

namespace {

int32_t saturated(long long nanoseconds) {
    constexpr long long kMin = std::numeric_limits<int32_t>::min(),
                        kMax = std::numeric_limits<int32_t>::max();
    return static_cast<int32_t>(std::clamp(nanoseconds, kMin, kMax));
}

/// A position older than `staleAge` is unknown. So all stages treat a device that freezes like one that is
/// unplugged: its force fades out, and where it returns after that, touch begins again once it has left the
/// model.
void refuseStale(DeviceSample& sample) noexcept {
    sample.valid = sample.valid && sample.age <= sample.limits.staleAge; // a NaN age is not fresh
}

/// What goes with a scene; null: nothing, or it is no longer kept.
template <class Kept>
std::shared_ptr<Kept> ofScene(const std::deque<std::pair<uint32_t, std::shared_ptr<Kept>>>& kept,
                              uint32_t scene) {
    const auto found = std::ranges::find(kept, scene, [](const auto& each) { return each.first; });
    return found != kept.end() ? found->second : nullptr;
}

} // namespace

struct ServoLoop::Touch {
    explicit Touch(size_t hands)
        : devices(hands), samples(hands), outputs(hands), traces(hands), felt(hands), records(hands),
          paths(hands), pads(hands), shown(hands), checkpoints(hands) {}

    const Offer* offer = nullptr;
    uint32_t geometry = 0, part = 0;          // of the offer; geometry 0: none
    uint32_t scene = 0, root = 0;             // numbers of the offer and of what it is an edit of
    const HapticSettings* settings = nullptr; // of this tick
    const LiveTool* tool = nullptr;           // of this tick; null: none is active
    // One per hand:
    std::vector<DeviceState> devices;
    std::vector<DeviceSample> samples;
    std::vector<HapticOutput> outputs;
    std::vector<StageTrace> traces;
    struct Felt {
        TouchFeedback feedback; // of the preceding tick
        std::array<glm::dvec3, 3> planes{};
    };
    std::vector<Felt> felt;
    std::vector<TickRecord> records; // of this tick, hand 0 the last
    std::vector<ToolPath> paths;
    std::vector<LocationLimiterState> pads;
    std::vector<PadTick> shown; // in this tick
    bool late = false;          // the previous tick ended after its next deadline
    uint64_t nextCheckpoint = 0;
    double previousTime = std::numeric_limits<double>::quiet_NaN(); // of the preceding tick in this scene
    std::vector<TouchCheckpoint> checkpoints;                       // of this tick, that of hand 0 the last

    /// Everything of the record that is not of one hand is in the record of hand 0.
    TickRecord& record() noexcept { return records.back(); }

    void feelFrom(size_t hand) noexcept {
        const HapticOutput& output = outputs[hand];
        felt[hand].planes = output.planes;
        felt[hand].feedback = {.touching = output.contacts > 0,
                               .hip = output.hip,
                               .proxy = output.proxy,
                               .force = output.force / output.borne,
                               .planes = {felt[hand].planes.data(), output.planeCount},
                               .object = output.object};
    }

    /// The command without contact: the force that the device still holds goes to zero within its limits.
    DeviceCommand restCommand(size_t hand, double dt) noexcept {
        uint32_t flags = 0;
        return ForceLimiter::limit(glm::dvec3(0.0), glm::dvec3(0.0),
                                   {.limits = samples[hand].limits, .dt = dt}, {}, devices[hand].limiter,
                                   flags);
    }
};

ServoLoop::ServoLoop(std::vector<DevicePort> ports, const ServoConfig& config)
    : ports_(std::move(ports)), config_(config), records_(config.ringCapacity * ports_.size()),
      checkpoints_(64 * ports_.size()) {
    if (ports_.empty() || ports_.size() > kMaxHands)
        throw Error("servo", "",
                    "is given " + std::to_string(ports_.size()) + " devices; it drives 1 to " +
                        std::to_string(kMaxHands),
                    "");
    for (const DevicePort& port : ports_)
        if (port.sample == nullptr || port.apply == nullptr)
            throw Error("servo", "", "the device port is incomplete", "");
    if (!(config.rateHz >= kMinServoRate && config.rateHz <= kMaxServoRate))
        throw Error("servo", "rate", "must be 100..4000 Hz", "1000 suits most devices");
}

ServoLoop::~ServoLoop() {
    stop();
}

void ServoLoop::start() {
    if (thread_.joinable())
        return;
    stopping_.store(false, std::memory_order_relaxed);
    findsApart_ = true;
    if (bodies_ != nullptr)
        bodies_->setFinding(body::BodyWorld::Finding::Apart);
    scheduled_.store(false, std::memory_order_relaxed);
    if (waiting_ != nullptr)
        waiting_->world.publishAhead(animationTime(offeredSettings_.back().settings, 0.0));
    waiting_.reset();
    for (auto& [scene, driven] : driven_)
        driven->forgetKept();
    thread_ = std::thread([this] { run(); });
    scheduled_.wait(false, std::memory_order_acquire);
}

void ServoLoop::stop() {
    if (!thread_.joinable())
        return;
    stopping_.store(true, std::memory_order_relaxed);
    thread_.join();
}

uint32_t ServoLoop::offerScene(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneSwap swap,
                               const HapticSettings* settings, std::shared_ptr<DrivenObjects> driven) {
    if (settings != nullptr)
        (void)number(*settings);
    if (scene == nullptr) {
        if (settings != nullptr)
            settings_.write(offeredSettings_.back());
        ++offeredGeometry_;
        scene_.offer(nullptr);
        waiting_.reset();
        lastScene_.reset();
        bodies_ = nullptr;
        soft_ = nullptr;
        return 0;
    }
    if (swap == SceneSwap::OtherPart && !canTakeUpPart(source.get(), *scene))
        swap = SceneSwap::Anew;
    const bool goesOn = swap != SceneSwap::Anew;
    WorldState world(std::move(source), *scene, WorldBodies::Simulated, goesOn ? bodies_ : nullptr,
                     goesOn ? newestTextures() : nullptr, driven);
    if (world.bodies() != nullptr && world.bodies() != bodies_ && findsApart_)
        world.bodies()->setFinding(body::BodyWorld::Finding::Apart);
    bodies_ = world.bodies();
    soft_ = world.soft();
    const uint32_t number = nextSceneNumber();
    holdTextures(number, world);
    if (driven != nullptr)
        driven_.emplace_back(number, std::move(driven));
    auto offer = std::make_shared<const Offer>(offerOf(std::move(scene), std::move(world), number, swap));
    // A stepped loop computes the vertices itself, so that it is deterministic.
    if (thread_.joinable())
        offer->world.publishAhead(animationTime(
            offeredSettings_.back().settings,
            1e-9 * static_cast<double>(monotonicNs() - startedNs_.load(std::memory_order_relaxed))));
    else
        waiting_ = offer;
    scene_.offer(std::move(offer));
    return number;
}

/// Owner thread: the offer of a scene that is its own root.
ServoLoop::Offer ServoLoop::offerOf(std::shared_ptr<const HapticScene> scene, WorldState world,
                                    uint32_t number, SceneSwap swap) {
    if (swap == SceneSwap::Anew)
        ++offeredGeometry_;
    const bool otherPart = swap == SceneSwap::OtherPart;
    if (otherPart)
        ++offeredPart_;
    Offer offer{.scene = std::move(scene),
                .world = std::move(world),
                .number = number,
                .geometry = offeredGeometry_,
                .root = number,
                .settings = offeredSettings_.back(), // a scene before it may have brought them
                .part = offeredPart_};
    if (otherPart) {
        offer.before = offeredLast_;
        offer.partBefore = std::move(lastScene_);
    }
    offeredLast_ = number;
    lastScene_ = offer.scene;
    return offer;
}

void ServoLoop::offerSculpted(ReshapedScene scene, SceneSwap swap) {
    if (swap == SceneSwap::OtherPart && !canTakeUpPart(scene.source.get(), *scene.scene))
        swap = SceneSwap::Anew;
    WorldState world(std::move(scene.source), *scene.scene, WorldBodies::Simulated, bodies_,
                     newestTextures());
    holdTextures(scene.root, world);
    Offer offer = offerOf(std::move(scene.scene), std::move(world), scene.number, swap);
    offeredLast_ = offer.root = scene.root;
    offer.reshaped = std::move(scene.reshaped);
    scene_.offer(std::make_shared<const Offer>(std::move(offer)));
}

void ServoLoop::offerEdited(ReshapedScene scene) {
    // Read where there are bodies alone: another thread may offer edits.
    const bool moves = scene.source != nullptr && scene.source->physics != nullptr;
    WorldState world(std::move(scene.source), *scene.scene, WorldBodies::Simulated, moves ? bodies_ : nullptr,
                     newestTextures());
    edited_.offer(std::make_shared<const Offer>(std::move(scene.scene), std::move(world), scene.number, 0u,
                                                scene.root, std::move(scene.reshaped), scene.oldestEdit));
}

/// The strokes of a scene's textures, which a world is about to give to the servo, can be popped.
void ServoLoop::holdTextures(uint32_t number, const WorldState& world) {
    const std::lock_guard lock(newestMutex_);
    newestTextures_ = world.textures();
    if (newestTextures_ == nullptr)
        return;
    newestTextures_->keepStrokes();
    textures_.emplace_back(number, newestTextures_);
}

std::shared_ptr<PersistentTextures> ServoLoop::newestTextures() {
    const std::lock_guard lock(newestMutex_);
    return newestTextures_;
}

std::shared_ptr<PersistentTextures> ServoLoop::texturesOf(uint32_t scene) const {
    return ofScene(textures_, scene);
}

const DrivenState* ServoLoop::drivenBefore(const TickRecord& record) const {
    const std::shared_ptr<DrivenObjects> driven = ofScene(driven_, record.root);
    return driven != nullptr ? driven->before(record.tick) : nullptr;
}

bool ServoLoop::drives(uint32_t root) const {
    return ofScene(driven_, root) != nullptr;
}

void ServoLoop::setTool(const LiveTool& tool) {
    offeredTools_.push_back({offeredTools_.back().number + 1, tool});
    tools_.write(offeredTools_.back());
}

const LiveTool& ServoLoop::toolOf(uint32_t number) const {
    const auto found = std::ranges::lower_bound(offeredTools_, number, {}, &NumberedTool::number);
    return (found != offeredTools_.end() ? *found : offeredTools_.back()).tool;
}

void ServoLoop::setSettings(const HapticSettings& settings) {
    settings_.write(number(settings));
}

/// The next number, and what a record of it stands for.
const ServoLoop::NumberedSettings& ServoLoop::number(const HapticSettings& settings) {
    HapticSettings withoutForce = settings;
    withoutForce.forceEnabled = false;
    return offeredSettings_.emplace_back(offeredSettings_.back().number + 1, settings, withoutForce);
}

const HapticSettings& ServoLoop::settingsOf(uint32_t number) const {
    const auto found = std::lower_bound(
        offeredSettings_.begin(), offeredSettings_.end(), number & ~kWithoutForce,
        [](const NumberedSettings& offered, uint32_t wanted) { return offered.number < wanted; });
    const NumberedSettings& offered = found != offeredSettings_.end() ? *found : offeredSettings_.back();
    return (number & kWithoutForce) != 0 ? offered.withoutForce : offered.settings;
}

bool ServoLoop::popRecord(TickRecord& record) {
    if (!records_.pop(record))
        return false;
    while (offeredSettings_.front().number < (record.settings & ~kWithoutForce))
        offeredSettings_.pop_front();
    while (offeredTools_.front().number < record.tool)
        offeredTools_.pop_front();
    while (textures_.size() > 1 && textures_[1].first <= record.root)
        textures_.pop_front();
    while (driven_.size() > 1 && driven_[1].first <= record.root)
        driven_.pop_front();
    return true;
}

bool ServoLoop::popBodyState(uint64_t& tick, std::vector<std::byte>& bytes) {
    if (soft_ != nullptr)
        return soft_->takeKept(tick, bytes);
    return bodies_ != nullptr && bodies_->takeKept(tick, bytes);
}

const body::BodyPoses* ServoLoop::bodyPoses() {
    if (bodies_ == nullptr)
        return nullptr;
    bodies_->publication()->update();
    return &bodies_->publication()->value();
}

ServoLoop::Counters ServoLoop::counters() const {
    return {ticks_.load(std::memory_order_relaxed), missed_.load(std::memory_order_relaxed),
            skipped_.load(std::memory_order_relaxed), records_.dropped()};
}

ServoScheduling ServoLoop::scheduling() const {
    return scheduled_.load(std::memory_order_acquire) ? scheduling_ : ServoScheduling{};
}

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
    if (goesOn) {
        // As in a replay that resumes here: the objects have their previous poses.
        if (std::isfinite(touch.previousTime))
            offer->world.advance(touch.previousTime);
        const ObjectMotions moved = offer->world.poses();
        const ObjectMotions motions = moved.empty() ? ObjectMotions(offer->scene->restMotions) : moved;
        for (DeviceState& device : touch.devices) {
            if (otherPart)
                takeUpPart(*offer->scene, offer->before == touch.root ? offer->partBefore.get() : nullptr,
                           motions, feltRadius(*touch.settings), device);
            else
                letGoOfEmptied(*offer->scene, motions, device);
            if (!offer->reshaped.empty())
                takeUpReshaped(*offer->scene, motions, offer->reshaped, device);
        }
        return;
    }
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

/// Start of a tick: the newest scene and settings, and checkpoints where they are due.
void ServoLoop::prepare(Touch& touch) noexcept {
    TickRecord& record = touch.record();
    // The scene first: settings that were sent before it was offered are there.
    const Offer* const root = scene_.adopt();
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
    if (const Offer* const edited = edited_.adopt();
        edited != nullptr && root != nullptr && edited->root == root->root)
        offer = edited;
    bool due = record.tick >= touch.nextCheckpoint;
    if (const uint32_t number = offer != nullptr ? offer->number : 0; number != touch.scene) {
        if (offer != root && record.root != touch.root)
            adopt(touch, root); // its first edit came before its first tick
        adopt(touch, offer);
        if (offer != nullptr && offer->oldestEdit > 0)
            record.editDelay = static_cast<uint32_t>(record.tick - offer->oldestEdit);
        touch.scene = number;
        touch.root = record.root;
        due = true;
    }
    record.scene = touch.scene;
    record.checkpoint = due || checkpointWanted_.load(std::memory_order_relaxed);
    if (record.checkpoint)
        takeCheckpoints(touch);
    if (offer != nullptr && offer->world.driven() != nullptr) [[unlikely]]
        offer->world.driven()->begin(record.tick, record.dt, record.checkpoint);
}

/// One of every hand, that of hand 0 the last.
void ServoLoop::takeCheckpoints(Touch& touch) noexcept {
    const TickRecord& record = touch.record();
    checkpointWanted_.store(false, std::memory_order_relaxed);
    touch.nextCheckpoint =
        record.tick + static_cast<uint64_t>(std::max(1.0, config_.checkpointSeconds * config_.rateHz));
    if (touch.offer != nullptr && touch.offer->world.bodies() != nullptr)
        touch.offer->world.bodies()->keep(record.tick);
    if (touch.offer != nullptr && touch.offer->world.soft() != nullptr)
        touch.offer->world.soft()->keep(record.tick);
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

/// Poses of this tick, then the sample of every hand: one that the program moves follows them.
void ServoLoop::sampleHands(Touch& touch, const TickRecord& record) noexcept {
    const ObjectMotions poses = touch.offer != nullptr
                                    ? touch.offer->world.advance(animationTime(*touch.settings, record.time))
                                    : ObjectMotions();
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        const DevicePort& port = ports_[hand];
        if (port.feel != nullptr) {
            touch.felt[hand].feedback.objects = poses;
            port.feel(port.context, touch.felt[hand].feedback);
        }
        touch.samples[hand] = port.sample(port.context, record.time);
        if (touch.offer != nullptr)
            refuseStale(touch.samples[hand]);
    }
}

/// One tick: read, step, write. The times are those of the step alone, as `step_ns` means everywhere.
void ServoLoop::tick(Touch& touch, uint64_t number, double dt) noexcept {
    TickRecord& record = touch.record();
    record = TickRecord{};
    record.tick = number;
    record.time = static_cast<double>(number) / config_.rateHz;
    record.dt = dt;
    record.late = touch.late;
    prepare(touch);
    sampleHands(touch, record);
    if (touch.offer == nullptr) {
        std::ranges::fill(touch.outputs, HapticOutput{});
        std::ranges::fill(touch.traces, StageTrace{});
        impact_.store(0.0, std::memory_order_relaxed);
    } else {
        const TickInput input{.tick = number,
                              .time = record.time,
                              .dt = dt,
                              .late = touch.late,
                              .hands = touch.samples,
                              .tool = touch.tool};
        WorldState& world = touch.offer->world;
        record.poses = world.poseHash();
        record.found = world.foundContacts();
        StageStopwatch clock;
        StageTracer tracer(touch.devices, touch.traces, config_.stageTimes ? &clock : nullptr);
        const long long begin = monotonicNs();
        hapticStep(*touch.offer->scene, *touch.settings, input, world, touch.devices, touch.outputs, tracer);
        record.stepNs = saturated(monotonicNs() - begin);
        std::ranges::transform(clock.nanoseconds, record.stageNs.begin(), saturated);
        touch.previousTime = animationTime(*touch.settings, record.time);
        if (touch.tool != nullptr)
            sculpt(touch, input, world.poses());
        if (world.textures() != nullptr)
            world.textures()->publishStrokes(number);
        if (world.bodies() != nullptr)
            impact_.store(world.bodies()->impact(), std::memory_order_relaxed);
        if (dented_ || touch.offer->scene->plan.deformation)
            publishDents(touch);
    }
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        if (touch.offer != nullptr)
            touch.feelFrom(hand);
        showLocation(touch, hand, dt);
        ports_[hand].apply(ports_[hand].context, touch.offer != nullptr ? touch.outputs[hand].command
                                                                        : touch.restCommand(hand, dt));
    }
}

/// A hand without a display pays a call.
void ServoLoop::showLocation(Touch& touch, size_t hand, double dt) noexcept {
    const DevicePort& port = ports_[hand];
    if (port.pad == nullptr)
        return;
    PadTick& shown = touch.shown[hand];
    LocationLimiterState& state = touch.pads[hand];
    shown = {.limits = port.pad(port.context), .before = state.last};
    // Also where there is no display: the next one begins in its middle, not where this one was.
    const PadCommand command = padStep(touch.samples[hand], touch.outputs[hand], touch.settings->forceEnabled,
                                       dt, shown.limits, state);
    shown.location = command.location();
    if (shown.limits.reach > 0.0 && port.applyPad != nullptr)
        port.applyPad(port.context, command);
}

/// Also when the scene has become another one, in which nothing gives way.
void ServoLoop::publishDents(const Touch& touch) noexcept {
    HandDents dents{};
    dented_ = false;
    for (size_t hand = 0; hand < touch.devices.size(); ++hand) {
        dents[hand] = touch.devices[hand].dents;
        dented_ = dented_ || dents[hand].any();
    }
    dents_.write(dents);
}

/// What the hands make with their tool, into the journal's ring.
void ServoLoop::sculpt(Touch& touch, const TickInput& input, ObjectMotions poses) noexcept {
    const HapticScene& scene = *touch.offer->scene;
    std::array<SculptEntry, ToolPath::kMost> made;
    for (size_t hand = 0; hand < ports_.size(); ++hand) {
        const bool pressed = touch.tool->held || (touch.samples[hand].buttons & kSculptButton) != 0;
        const size_t count = touch.paths[hand].advance(
            *touch.tool, pressed, scene, poses.empty() ? ObjectMotions(scene.restMotions) : poses, input,
            touch.outputs[hand], made);
        for (size_t i = 0; i < count; ++i) {
            made[i].root = touch.root;
            edits_.push(made[i]);
        }
    }
}

/// The records of the tick to the owner thread.
void ServoLoop::publish(Touch& touch) noexcept {
    TickRecord& record = touch.record();
    record.step = ticks_.fetch_add(1, std::memory_order_relaxed);
    const size_t count = touch.records.size();
    for (size_t i = 0; i < count; ++i) {
        const size_t hand = count - 1 - i;
        TickRecord& own = touch.records[i];
        if (hand > 0)
            own = record;
        own.hand = static_cast<uint32_t>(hand);
        own.sample = touch.samples[hand];
        own.trace = touch.traces[hand];
        own.output = touch.outputs[hand];
        own.pad = touch.shown[hand];
    }
    records_.push(touch.records);
    snapshot_.write(record);
}

TickRecord ServoLoop::step(uint64_t number) {
    if (stepped_ == nullptr)
        stepped_ = std::make_unique<Touch>(ports_.size());
    const uint64_t elapsed = number > lastStepped_ ? number - lastStepped_ : 1;
    lastStepped_ = number;
    tick(*stepped_, number, static_cast<double>(elapsed) / config_.rateHz);
    publish(*stepped_);
    return stepped_->record();
}

void ServoLoop::run() noexcept {
    enterFloatMode();
    if (config_.wantRealtime)
        scheduling_ = enterRealtime();
    else
        scheduling_ = {"normal", false, -1};
    scheduled_.store(true, std::memory_order_release);
    scheduled_.notify_all();

    const auto period = static_cast<long long>(1e9 / config_.rateHz + 0.5);
    const long long start = monotonicNs() + period;
    startedNs_.store(start, std::memory_order_relaxed);
    Touch touch(ports_.size());
    uint64_t number = 0, previous = 0;
    while (!stopping_.load(std::memory_order_relaxed)) {
        const long long deadline = start + static_cast<long long>(number) * period;
        sleepUntil(deadline);
        const long long awake = monotonicNs();
        const uint64_t elapsed = number == 0 ? 1 : number - previous;
        previous = number;
        {
            const realtime::TickScope scope;
            tick(touch, number, static_cast<double>(elapsed) / config_.rateHz);
            const long long done = monotonicNs();
            TickRecord& record = touch.record();
            record.wakeLatencyNs = saturated(awake - deadline);
            record.missed = touch.late = done > deadline + period;
            if (record.missed)
                missed_.fetch_add(1, std::memory_order_relaxed);
            publish(touch);

            // The next deadline still ahead: late ticks are dropped, never made up in a burst.
            const auto passed = static_cast<uint64_t>(std::max(0LL, (done - deadline) / period));
            if (passed > 0)
                skipped_.fetch_add(passed, std::memory_order_relaxed);
            number += 1 + passed;
        }
    }
    for (const DevicePort& port : ports_)
        port.apply(port.context, DeviceCommand{});
}

} // namespace touchstone
