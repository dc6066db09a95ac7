#include "session/session.h"

#include <utility>

namespace touchstone {

uint32_t Session::touch(std::shared_ptr<const HapticScene> scene, ScenePtr source, SceneIdentity identity,
                        SceneSwap swap) {
    const uint32_t number = servo_.offerScene(scene, source, swap);
    scene_ = {number, std::move(scene), std::move(source), {}};
    identify(std::move(identity));
    return number;
}

void Session::identify(SceneIdentity identity) {
    scene_.identity = std::move(identity);
    for (TickSubscriber* subscriber : subscribers_)
        subscriber->sceneOffered(scene_);
}

void Session::set(const HapticSettings& settings) {
    if (settings_ != settings)
        servo_.setSettings(*(settings_ = settings));
}

void Session::pump(double now) {
    servo_.updateSnapshot();
    TickRecord record;
    while (servo_.popRecord(record))
        for (TickSubscriber* subscriber : subscribers_)
            subscriber->take(record, servo_.settingsOf(record.settings));
    for (TickSubscriber* subscriber : subscribers_)
        subscriber->flush(now);
}

} // namespace touchstone
