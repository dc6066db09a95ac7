#include "workbench/touch/live_touch.h"

#include "engine/time/seconds_now.h"
#include "session/device_port.h"

#include <utility>

namespace touchstone {

LiveTouch::LiveTouch(const WindowOptions& options, std::function<void(const std::string&)> tell)
    : session_({portOf(sound_.hand())}, {.rateHz = options.rateHz, .stageTimes = true}),
      controller_(session_.servo(), options.recording, "window", std::move(tell)),
      readings_(session_.servo(), controller_.recorder()) {
    session_.subscribe(controller_);
    session_.subscribe(readings_);
}

LiveTouch::~LiveTouch() {
    session_.stop();
    session_.pump(secondsNow());
    controller_.finish();
}

void LiveTouch::show(LoadedModel loaded, bool generated) {
    shown_ = std::move(loaded);
    shown_.identity.generated = generated;
    offerScene();
    hand_.offerPath(shown_.path);
    strokes_.show(shown_.model.scene, shown_.model.workspaceFromScene, shown_.path);
    readings_.clearForces();
}

void LiveTouch::change(const MadeMaterials& made) {
    if (made.scene != nullptr)
        shown_.model.scene = made.scene;
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
    session_.identify(shown_.identity);
}

void LiveTouch::update(double now) {
    session_.pump(now);
}

void LiveTouch::prepare(const HapticSettings& settings) {
    if (hasModel())
        build_.update(shown_.model.haptic, settings);
}

void LiveTouch::hold(std::string& choice) {
    hand_.collect();
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
        hand_.offerPath(std::move(path));
}

/// To the session, the pointer and the sound.
void LiveTouch::offerScene(SceneSwap swap) {
    picker_.show(shown_.model.haptic, shown_.model.scene);
    if (swap == SceneSwap::Anew) {
        sound_.interrupt();
        hand_.leave();
        builtAgain_ = true;
    }
    (void)session_.touch(shown_.model.haptic, shown_.model.scene, shown_.identity, swap);
}

} // namespace touchstone
