#include "workbench/touch/live_touch.h"

#include "engine/import/volume_file/volume_edits.h"
#include "engine/time/seconds_now.h"
#include "haptics/proxy/take_up_part.h"
#include "session/device_port.h"
#include "workbench/model/animate.h"

#include <algorithm>
#include <utility>

namespace touchstone {

LiveTouch::LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell)
    : others_(options.otherDevices, options.zoom),
      session_(ports(), {.rateHz = options.rateHz, .stageTimes = true}),
      controller_(session_.servo(), options.recording, "window", std::move(tell)),
      readings_(session_.servo(), controller_.recorder()) {
    session_.subscribe(controller_);
    session_.subscribe(readings_);
    session_.subscribe(failing_);
    session_.subscribe(sculpt_);
    session_.subscribe(others_);
    sound_.hear(session_.servo().impact());
}

std::vector<DevicePort> LiveTouch::ports() {
    std::vector<DevicePort> ports = others_.ports();
    ports.insert(ports.begin(), portOf(sound_.hand()));
    return ports;
}

LiveTouch::~LiveTouch() {
    session_.stop();
    session_.pump(secondsNow());
    controller_.finish();
}

void LiveTouch::show(LoadedModel loaded, bool generated) {
    shown_ = std::move(loaded);
    shown_.identity.generated = generated;
    whole_ = shown_.model;
    felt_ = whole_.haptic;
    partBuild_.wholeIsFelt();
    wholeEdits_ = shown_.identity.edits;
    offerScene(SceneSwap::Anew, true);
    offerPath(shown_.path);
    strokes_.show(shown_.model.scene, shown_.model.workspaceFromScene, shown_.path);
    readings_.clearForces();
}

void LiveTouch::change(const MadeMaterials& made) {
    const SceneSwap swap = made.touchGoesOn ? SceneSwap::SameGeometry : SceneSwap::Anew;
    if (made.scene != nullptr)
        shown_.model.scene = whole_.scene = made.scene;
    whole_.haptic = made.haptic;
    wholeEdits_ = withChoices(made.edits, *shown_.model.scene);
    const bool whole = shown_.model.part.whole();
    if (swap == SceneSwap::Anew && whole)
        partBuild_.wholeIsFelt();
    else if (swap == SceneSwap::Anew)
        partBuild_.geometryChanged();
    if (!whole)
        return; // a part of it follows (showPart)
    felt_ = made.haptic;
    shown_.identity.edits = wholeEdits_;
    shown_.model.haptic = made.haptic;
    shown_.identity.feltHash = made.feltHash;
    offerScene(swap, false);
}

void LiveTouch::showPart(const ScenePart& part) {
    if (!hasModel())
        return;
    if (const std::optional<FeltPart> made = partBuild_.take())
        takePart(*made);
    const bool missing = part != shown_.model.part || felt_ != whole_.haptic;
    if (missing && partBuild_.start(whole_, part))
        partEdits_ = wholeEdits_;
}

void LiveTouch::takePart(const FeltPart& made) {
    const ScenePart& before = shown_.model.part;
    const bool onlyLess =
        made.part.clip == before.clip && std::ranges::includes(made.part.hidden, before.hidden);
    SceneSwap swap = partBuild_.swap();
    if (swap != SceneSwap::Anew && !onlyLess)
        swap = canTakeUpPart(shown_.model.scene.get()) ? SceneSwap::OtherPart : SceneSwap::Anew;
    const bool same = made.part == before;
    felt_ = made.whole;
    shown_.model.part = shown_.identity.part = made.part;
    shown_.model.haptic = made.haptic;
    shown_.identity.feltHash = made.feltHash;
    shown_.identity.edits = partEdits_;
    offerScene(swap, false);
    if (same) // other materials
        return;
    builtAgain_ = true; // the mouse may have pressed on what is gone
    shown_.path = made.path;
    offerPath(shown_.path);
    strokes_.show(made.strokes, shown_.model.workspaceFromScene, shown_.path);
}

void LiveTouch::saved(const std::filesystem::path& path, const FileStamp& stamp, std::string edits) {
    shown_.identity.path = path.string();
    shown_.identity.absolutePath = std::filesystem::absolute(path).string();
    shown_.identity.generated = false;
    shown_.identity.fileSize = stamp.size;
    shown_.identity.fileHash = stamp.hash;
    wholeEdits_ = partEdits_ = edits;
    shown_.identity.edits = std::move(edits);
    session_.identify(shown_.identity);
}

void LiveTouch::update(double now) {
    session_.pump(now);
    if (const body::BodyPoses* poses = session_.servo().bodyPoses())
        picker_.showBodies(*poses);
}

void LiveTouch::operate(HapticSettings& settings) {
    const body::BodyPoses* poses = controls_.empty() ? nullptr : session_.servo().bodyPoses();
    if (poses != nullptr && session_.touching())
        (void)controls_.apply(poses->workspaceFromBody, settings);
}

void LiveTouch::pose(double time, SceneRenderer& renderer, std::span<const body::Pose> recorded,
                     std::span<const DrivenPose> moved) {
    const body::BodyPoses* const poses = session_.servo().bodyPoses();
    if (poses != nullptr && poses->workspaceFromBody.size() == recorded.size()) {
        body::BodyPoses then(*poses);
        then.workspaceFromBody.assign(recorded.begin(), recorded.end());
        poseBodies(then, time, picker_.world(), renderer);
    } else if (poses != nullptr)
        poseBodies(*poses, time, picker_.world(), renderer);
    else if (drawnMoved_ || !moved.empty()) {
        poseMoved(time, *shown_.model.scene, *shown_.model.haptic, moved, renderer);
        drawnMoved_ = !moved.empty();
    } else
        poseAt(time, *shown_.model.scene, renderer);
    if (SoftStates* const soft = session_.servo().soft())
        soft_.show(*soft, *shown_.model.scene, *shown_.model.haptic, renderer);
    textures_.show(*shown_.model.haptic, controller_.recorder().textures(), renderer);
    dented_.show(session_.servo().dents(), *shown_.model.scene, *shown_.model.haptic, renderer);
}

void LiveTouch::prepare(const HapticSettings& settings) {
    if (hasModel())
        build_.update(shown_.model.haptic, settings);
}

void LiveTouch::hold(std::string& choice) {
    hand_.collect();
    others_.collect();
    if (choice == menu_.chosen())
        return;
    hand_.hold(nullptr); // before another is opened: it may be the same one
    hand_.hold(menu_.choose(choice));
    choice = menu_.chosen();
}

void LiveTouch::layStroke(const StrokeRequest& stroke, const glm::dvec3& facing, bool simulated) {
    const HapticOutput& felt = tick().output;
    // Not what a glide or a replayed recording touches: nothing is coupled then.
    if (felt.contacts > 0 && session_.touching() && tick().sample.mapping.coupling > 0.0) {
        const Similarity rest = picker_.restFromNow(felt.object, tick().time); // strokes are laid on the rest
                                                                               // pose
        strokes_.touched({rest.point(felt.proxy), rest.direction(felt.normal)});
    }
    if (auto path = strokes_.update(stroke, facing, simulated))
        offerPath(std::move(path));
}

void LiveTouch::offerPath(const std::shared_ptr<const StrokePath>& path) {
    hand_.offerPath(path);
    others_.offerPath(path);
}

int LiveTouch::nodeAt(const Ray& ray) {
    const int instance = picker_.instanceAt(ray, tick().time);
    return instance >= 0 ? shown_.model.scene->instances[static_cast<size_t>(instance)].node : -1;
}

/// To the session, the pointer and the sound. `another`: model than before; else it stays as it was sculpted.
void LiveTouch::offerScene(SceneSwap swap, bool another) {
    picker_.show(shown_.model.haptic, shown_.model.scene);
    const auto& bodies = picker_.world().bodies();
    controls_ = bodies != nullptr ? body::JointSettings(*bodies) : body::JointSettings();
    sculpt_.show(shown_.model, another);
    if (swap == SceneSwap::Anew) {
        sound_.interrupt();
        hand_.leave();
        others_.leave();
        builtAgain_ = true;
    }
    (void)session_.touch(shown_.model.haptic, shown_.model.scene, shown_.identity, swap, !another);
}

} // namespace touchstone
