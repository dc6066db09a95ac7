#include "session/session.h"

#include <utility>

namespace touchstone {

uint32_t Session::touch(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneIdentity identity,
                        SceneSwap swap, bool sculpted, std::shared_ptr<DrivenObjects> driven) {
    std::optional<uint32_t> root;
    if (sculpted && scene != nullptr)
        root = sculptor_.carryOver(scene, source, swap);
    if (!root)
        sculptor_.begin(0, nullptr, nullptr); // its worker reads what offerScene replaces
    const uint32_t number = root ? *root : servo_.offerScene(scene, source, swap, nullptr, std::move(driven));
    if (!root)
        sculptor_.begin(number, scene, source);
    begin({number, std::move(scene), std::move(source), std::move(identity)});
    return number;
}

uint32_t Session::touch(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneIdentity identity,
                        const HapticSettings& settings) {
    sculptor_.begin(0, nullptr, nullptr);
    const uint32_t number = servo_.offerScene(scene, source, SceneSwap::Anew, &*(settings_ = settings));
    sculptor_.begin(number, scene, source);
    begin({number, std::move(scene), std::move(source), std::move(identity)});
    return number;
}

/// It is the newest one from now on, and the subscribers know it.
void Session::begin(OfferedScene scene) {
    scene_ = std::move(scene);
    identify(scene_.identity);
}

void Session::identify(SceneIdentity identity) {
    scene_.identity = std::move(identity);
    for (TickSubscriber* subscriber : subscribers_)
        subscriber->sceneOffered(scene_);
}

/// Those that the worker published since the last call.
void Session::tellSculpted() {
    for (const SculptedScene& sculpted : sculptor_.take()) {
        told_ = sculpted.number;
        for (TickSubscriber* subscriber : subscribers_)
            subscriber->sceneSculpted(sculpted);
    }
}

void Session::set(const HapticSettings& settings) {
    if (settings_ != settings)
        servo_.setSettings(*(settings_ = settings));
}

void Session::pump(double now) {
    servo_.updateSnapshot();
    TickRecord record;
    while (servo_.popRecord(record)) {
        if (record.scene != record.root && record.scene > told_)
            tellSculpted(); // published before the servo was offered it
        for (TickSubscriber* subscriber : subscribers_)
            subscriber->take(record, servo_.settingsOf(record.settings));
    }
    tellSculpted();
    for (TickSubscriber* subscriber : subscribers_)
        subscriber->flush(now);
}

} // namespace touchstone
