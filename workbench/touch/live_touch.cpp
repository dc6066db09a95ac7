#include "workbench/touch/live_touch.h"

#include "workbench/hand/device_port.h"

#include <chrono>
#include <new>
#include <utility>

namespace touchstone {

namespace {
constexpr double kChartSeconds = 10.0;
}

LiveTouch::LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell)
    : servo_(portOf(sound_.hand()), {.rateHz = options.rateHz, .stageTimes = true}),
      controller_(servo_, options.recording, "window", std::move(tell)), liveError_(options.rateHz),
      forces_(static_cast<size_t>(kChartSeconds * options.rateHz)) {}

LiveTouch::~LiveTouch() {
    servo_.stop();
    servoView_.drain(
        servo_, forces_, controller_.recorder(), liveError_,
        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count());
    controller_.finish();
}

void LiveTouch::show(LoadedModel loaded, bool generated) {
    loaded.model.haptic = limited(*loaded.model.haptic); // another hand may be in use than when loading
                                                         // started
    shown_ = std::move(loaded);
    shown_.identity.generated = generated;
    offerScene();
    hand_.offerPath(shown_.path);
    strokes_.show(shown_.model.scene, shown_.model.workspaceFromScene, shown_.path);
    forces_.clear();
}

void LiveTouch::change(const MadeMaterials& made) {
    if (made.scene != nullptr)
        shown_.model.scene = made.scene;
    made.haptic->limits = limits();
    shown_.model.haptic = made.haptic;
    shown_.identity.feltHash = made.feltHash;
    shown_.identity.edits = made.edits;
    offerScene(made.touchGoesOn ? SceneSwap::SameGeometry : SceneSwap::Anew);
}

void LiveTouch::saved(const std::filesystem::path& path, const FileStamp& stamp, std::string edits) {
    shown_.identity.path = path.string();
    shown_.identity.absolutePath = std::filesystem::absolute(path).string();
    shown_.identity.generated = false;
    shown_.identity.fileSize = stamp.size;
    shown_.identity.fileHash = stamp.hash;
    shown_.identity.edits = std::move(edits);
    controller_.recorder().sceneOffered(offered_, shown_.identity);
}

void LiveTouch::update(double now) {
    servo_.updateSnapshot();
    servoView_.drain(servo_, forces_, controller_.recorder(), liveError_, now);
    controller_.update();
}

void LiveTouch::send(const HapticSettings& settings) {
    if (sent_ != settings)
        servo_.setSettings(*(sent_ = settings));
}

void LiveTouch::prepare(const HapticSettings& settings) {
    if (hasModel())
        build_.update(shown_.model.haptic, settings);
}

bool LiveTouch::hold(std::string& choice) {
    bool held = true;
    if (held_.choose(choice) && hasModel())
        try {
            shown_.model.haptic = limited(*shown_.model.haptic);
            offerScene();
        } catch (const std::bad_alloc&) {
            held_.drop(choice);
            held = false;
        }
    if (!hasModel() || tick().scene == offered_)
        held_.limitsHold();
    return held;
}

void LiveTouch::layStroke(const StrokeRequest& stroke, const glm::dvec3& facing, bool simulated) {
    const HapticOutput& felt = tick().output;
    // Not what a glide or a replayed recording touches: nothing is coupled then.
    if (felt.contacts > 0 && tick().scene == offered_ && tick().sample.mapping.coupling > 0.0) {
        const Similarity rest = picker_.restFromNow(felt.object, tick().time); // strokes are laid on the rest
                                                                               // pose
        strokes_.touched({rest.point(felt.proxy), rest.direction(felt.normal)});
    }
    if (auto path = strokes_.update(stroke, facing, simulated))
        hand_.offerPath(std::move(path));
}

/// The same scene with the hand's limits.
std::shared_ptr<HapticScene> LiveTouch::limited(const HapticScene& scene) const {
    std::shared_ptr<HapticScene> copy = copyOf(scene);
    copy->limits = limits();
    copy->warnings = scene.warnings;
    return copy;
}

/// To the servo, and to recorder, sound and live error.
void LiveTouch::offerScene(SceneSwap swap) {
    shown_.identity.limits = shown_.model.haptic->limits;
    picker_.show(shown_.model.haptic, shown_.model.scene);
    if (swap == SceneSwap::Anew) {
        sound_.interrupt();
        hand_.leave();
        builtAgain_ = true;
    }
    offered_ = servo_.offerScene(shown_.model.haptic, shown_.model.scene, swap);
    controller_.recorder().sceneOffered(offered_, shown_.identity);
    liveError_.sceneOffered(offered_, shown_.model.haptic, shown_.model.scene);
}

} // namespace touchstone
