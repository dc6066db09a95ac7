#include "api/c/live_session.h"

#include "api/c/calls.h"
#include "api/c/live_structs.h"
#include "engine/time/seconds_now.h"
#include "haptics/scene/built_for.h"
#include "session/device_port.h"

#include <algorithm>
#include <chrono>
#include <thread>

namespace touchstone::api {

LiveSession::LiveSession(const ts_session_options& options)
    : rate_(options.rate != 0.0 ? options.rate : 1000.0), keep_(options.keep) {
    constexpr size_t kMostKept = 10'000'000;
    if (!(rate_ >= kMinServoRate && rate_ <= kMaxServoRate))
        refuseArgument("options.rate", "is not within 100 .. 4000 Hz");
    if (keep_ > kMostKept)
        refuseArgument("options.keep", "is above " + std::to_string(kMostKept));
    if (options.control != 0.0)
        controlled_ = controlOf(options);
    hands_.push_back(std::make_unique<LiveHand>(options.device, options.own, "options"));
    if (options.other_count >= kMaxHands)
        refuseArgument("options.other_count", "is above " + std::to_string(kMaxHands - 1));
    if (controlled_ && options.other_count > 0)
        refuseArgument("options.other_count", "is above 0: a control loop has one hand");
    const std::vector<ts_other_hand> others =
        structsOf(options.others, options.other_count, "options.others");
    for (size_t i = 0; i < others.size(); ++i)
        hands_.push_back(
            std::make_unique<LiveHand>(others[i].device, others[i].own, entry("options.others", i)));
}

LiveSession::~LiveSession() {
    if (session_ != nullptr && running_)
        session_->stop();
    if (control_ != nullptr)
        control_->stop();
}

void LiveSession::requireOpen() const {
    if (closed_.load(std::memory_order_acquire))
        throw Refused(TS_CLOSED, "session: this handle was closed");
}

void LiveSession::makeSession() {
    size_t simulated = 0, before = 0;
    for (const auto& hand : hands_)
        simulated += hand->simulated() ? 1 : 0;
    std::vector<DevicePort> ports;
    for (const auto& hand : hands_) {
        const double late =
            hand->simulated() ? static_cast<double>(before++) / static_cast<double>(simulated) : 0.0;
        Device* device = &hand->connect(*scene_, late);
        if (controlled_) {
            control_ = std::make_unique<ControlLoop>(*device, *controlled_);
            enableControl();
            device = control_.get();
        }
        ports.push_back(portOf(*device));
    }
    session_ = std::make_unique<Session>(std::move(ports), ServoConfig{.rateHz = rate_});
    recorder_.emplace(session_->servo());
    session_->subscribe(*this);
    session_->set(settings_);
}

void LiveSession::touch(std::shared_ptr<TouchedScene> scene) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    scene->prepareFor(settings_);
    for (const auto& hand : hands_) // where none can be laid, the old scene stays
        (void)hand->layStroke(*scene);
    scene_ = std::move(scene);
    changed_.reset();
    driven_.reset();
    hashed_ = true;
    const bool strokes = std::ranges::any_of(hands_, [](const auto& hand) { return hand->simulated(); });
    if (session_ == nullptr || (!running_ && strokes)) {
        recorder_.reset();
        session_.reset();
        control_.reset(); // before the device that it calls
        makeSession();
    }
    (void)session_->touch(scene_->haptic(), scene_->source(), scene_->identity());
}

void LiveSession::set(std::string_view name, std::string_view value) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    if (const std::string problem = setSetting(settings_, name, value); !problem.empty())
        refuseArgument("value", problem);
    if (scene_ != nullptr)
        scene_->prepareFor(settings_);
    if (changed_)
        buildFor(*changed_->haptic(), settings_);
    if (session_ != nullptr)
        session_->set(settings_);
    enableControl();
}

/// `force` and the setting forceEnabled hold for whoever renders.
void LiveSession::enableControl() {
    if (control_ != nullptr)
        control_->enableForce(forceOn_ && settings_.forceEnabled);
}

void LiveSession::material(uint64_t material, std::string_view name, double value) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    if (!changed_)
        changed_.emplace(scene_);
    changed_->set(material, name, value);
    buildFor(*changed_->haptic(), settings_);
    offerAgain();
}

double LiveSession::materialNumber(uint64_t material, std::string_view name) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    return feltNumber(changed_ ? changed_->materials() : scene_->source()->materials, material, name);
}

void LiveSession::requireScene() const {
    if (session_ == nullptr)
        throw Refused(TS_STATE, "session: it has no scene; call ts_session_touch first");
}

/// The same geometry with what has been changed. Only recordings need its hash, for which every vertex is
/// read.
void LiveSession::offerAgain() {
    hashed_ = !changed_ || recorder_->recording();
    (void)session_->touch(changed_ ? changed_->haptic() : scene_->haptic(), scene_->source(),
                          changed_ ? changed_->identity(hashed_) : scene_->identity(),
                          SceneSwap::SameGeometry, false, driven_);
}

void LiveSession::pumpSession() {
    unpumped_ = 0;
    session_->pump(secondsNow());
}

/// A tick that takes a goal leaves a state for recordings, of which there is room for 2048 (DrivenObjects).
void LiveSession::pumpGoals() {
    constexpr int kMost = 1000;
    if (++unpumped_ > kMost)
        pumpSession();
}

void LiveSession::move(uint64_t object, const ts_pose* pose) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    pumpGoals();
    if (pose == nullptr) {
        if (driven_ != nullptr)
            driven_->halt();
        return;
    }
    const HapticScene& haptic = *scene_->haptic();
    if (const std::string problem = drivenProblem(*scene_->source(), haptic, object); !problem.empty())
        refuseArgument("object", problem);
    const Similarity& rest = haptic.restMotions[static_cast<size_t>(object)].workspaceFromObject;
    const DrivenPose goal = goalOf(*pose, rest);
    const bool first = driven_ == nullptr;
    if (first)
        driven_ = std::make_shared<DrivenObjects>();
    if (!driven_->drive(static_cast<int>(object), rest, goal.goal, goal.speed, goal.turn))
        throw Refused(TS_STATE, "object: " + std::to_string(kMostDriven) + " others are moved already");
    if (first)
        offerAgain();
}

ts_pose LiveSession::pose(uint64_t object) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    const HapticScene& haptic = *scene_->haptic();
    requireBelow(object, haptic.objects.size(), "object");
    const Similarity& rest = haptic.restMotions[static_cast<size_t>(object)].workspaceFromObject;
    DrivenPose now;
    now.now = rest;
    if (driven_ != nullptr)
        for (const DrivenPose& pose : driven_->newest().poses())
            if (static_cast<uint64_t>(pose.object) == object)
                now = pose;
    return poseOf(now, rest);
}

void LiveSession::force(bool on) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    forceOn_ = on;
    enableControl();
    ForceSwitch& force = session_->forceSwitch();
    if (on)
        (void)force.giveBack(force.state());
    else
        force.takeAway(false);
}

void LiveSession::record(const char* file) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    if (!recorder_)
        throw Refused(TS_STATE, "session: it has no scene; call ts_session_touch first");
    if (file != nullptr) {
        nameWholly();
        recorder_->start(file, "api");
        return;
    }
    if (running_)
        pumpSession();
    recorder_->stop();
    if (const std::string problem = recorder_->takeProblem(); !problem.empty())
        throw Refused(TS_INPUT, problem);
}

/// The scene's identity with its hash, before the first tick that is recorded: those of the scene before it
/// have none.
void LiveSession::nameWholly() {
    if (hashed_)
        return;
    for (int i = 0; i < 1000 && running_ && !session_->touching(); ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
        pumpSession();
    }
    session_->identify(changed_->identity(true));
    hashed_ = true;
}

void LiveSession::start() {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    if (!running_) {
        if (control_ != nullptr)
            control_->start();
        session_->start();
    }
    running_ = true;
}

void LiveSession::stop() {
    const std::lock_guard lock(mutex_);
    if (session_ == nullptr || !running_)
        return;
    session_->stop();
    if (control_ != nullptr)
        control_->stop();
    running_ = false;
    pumpSession();
}

ControlLoop& LiveSession::controlLoop() {
    requireOpen();
    if (!controlled_)
        throw Refused(TS_STATE, "session: it has no control loop; give options.control");
    if (control_ == nullptr)
        throw Refused(TS_STATE, "session: it has no scene; call ts_session_touch first");
    return *control_;
}

void LiveSession::render(bool byCaller) {
    const std::lock_guard lock(mutex_);
    controlLoop().follow(byCaller ? GoalSource::Caller : GoalSource::Servo);
}

void LiveSession::goal(const ts_goal& given) {
    const std::lock_guard lock(mutex_);
    ControlLoop& control = controlLoop();
    if (const char* problem = control.hear(goalOf(given, control.stiffness())); problem != nullptr)
        refuseArgument("goal", problem);
}

ts_state LiveSession::state() {
    ts_state state = stateOf(session_->tick(), *session_, running_);
    if (control_ != nullptr)
        addControl(control_->state(), state);
    return state;
}

LiveHand& LiveSession::hand(size_t number) {
    requireBelow(number, hands_.size(), "hand");
    return *hands_[number];
}

ts_state LiveSession::handState(size_t number) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    LiveHand& of = hand(number);
    requireScene();
    return number == 0 ? state() : stateOf(of.newest(), *session_, running_);
}

ts_state LiveSession::pump() {
    const std::lock_guard lock(mutex_);
    requireOpen();
    requireScene();
    pumpSession();
    return state();
}

void LiveSession::run(double seconds, double rate, Callback callback, void* context) {
    if (!(seconds >= 0.0 && seconds <= 1e9))
        refuseArgument("seconds", "is not within 0 .. 1e9");
    if (rate != 0.0 && !(rate >= 1.0 && rate <= 1000.0))
        refuseArgument("rate", "is not within 1 .. 1000 Hz");
    if (callback == nullptr)
        refuseArgument("callback", "is null");
    bool starts = false;
    {
        const std::lock_guard lock(mutex_);
        starts = !running_;
        start();
    }
    using Clock = std::chrono::steady_clock;
    const auto period = std::chrono::duration_cast<Clock::duration>(
        std::chrono::duration<double>(1.0 / (rate != 0.0 ? rate : 60.0)));
    const Clock::time_point begin = Clock::now();
    const Clock::time_point end =
        begin + std::chrono::duration_cast<Clock::duration>(std::chrono::duration<double>(seconds));
    for (Clock::time_point next = begin + period; Clock::now() < end; next += period) {
        next = std::max(next, Clock::now()); // late callbacks do not come in bursts
        std::this_thread::sleep_until(std::min(next, end));
        ts_state now = pump();
        now.size = sizeof now;
        if (callback(context, &now) != 0)
            break;
    }
    if (starts)
        stop();
    requireOpen();
}

size_t LiveSession::takeKept(size_t number, const TickArrays& ticks) {
    const std::lock_guard lock(mutex_);
    requireOpen();
    return hand(number).takeKept(ticks);
}

void LiveSession::closed() {
    closed_.store(true, std::memory_order_release);
    stop();
}

void LiveSession::sceneOffered(const OfferedScene& scene) {
    recorder_->sceneOffered(scene.number, scene.identity);
}

void LiveSession::take(const TickRecord& record, const HapticSettings&) {
    recorder_->take(record);
    hands_[record.hand]->take(record, keep_);
}

void LiveSession::flush(double) {
    recorder_->flush();
}

} // namespace touchstone::api
