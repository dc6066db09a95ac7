// The owner's side of the servo: scenes, settings and tools that it offers under numbers, and the records
// that name them.

#include "haptics/body/body_world.h"
#include "haptics/proxy/take_up_part.h"
#include "haptics/servo/servo_loop.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/world/soft_states.h"

#include <algorithm>
#include <utility>

namespace touchstone {

namespace {

/// What goes with a scene; null: nothing, or it is no longer kept.
template <class Kept>
std::shared_ptr<Kept> ofScene(const std::deque<std::pair<uint32_t, std::shared_ptr<Kept>>>& kept,
                              uint32_t scene) {
    const auto found = std::ranges::find(kept, scene, [](const auto& each) { return each.first; });
    return found != kept.end() ? found->second : nullptr;
}

} // namespace

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
        setNewest({});
        return 0;
    }
    if (swap == SceneSwap::OtherPart && !canTakeUpPart(source.get()))
        swap = SceneSwap::Anew;
    if (!softGoOn(newest_.soft.get(), source.get(), *scene))
        swap = SceneSwap::Anew; // one is hidden, or shown again
    CarriedOver goesOn = swap != SceneSwap::Anew ? newest_ : CarriedOver{};
    goesOn.driven = driven;
    WorldState world(std::move(source), *scene, WorldBodies::Simulated, std::move(goesOn));
    if (world.bodies() != nullptr && world.bodies() != newest_.bodies && findsApart_)
        world.bodies()->setFinding(body::BodyWorld::Finding::Apart);
    setNewest(world);
    const uint32_t number = nextSceneNumber();
    holdTextures(number, world);
    if (driven != nullptr)
        driven_.emplace_back(number, std::move(driven));
    auto offer = std::make_shared<const Offer>(offerOf(std::move(scene), std::move(world), number, swap));
    offerWorld(std::move(offer));
    return number;
}

/// Owner thread. A stepped loop computes the vertices itself, so that it is deterministic.
void ServoLoop::offerWorld(std::shared_ptr<const Offer> offer) {
    if (thread_.joinable()) // from two ticks ago: where the vertices are as the servo takes it up
        offer->world.publishAhead(animationTime(
            offeredSettings_.back().settings,
            1e-9 * static_cast<double>(monotonicNs() - startedNs_.load(std::memory_order_relaxed)) -
                2.0 / config_.rateHz));
    else
        waiting_ = offer;
    scene_.offer(std::move(offer));
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
    if (swap == SceneSwap::OtherPart && !canTakeUpPart(scene.source.get()))
        swap = SceneSwap::Anew;
    if (!softGoOn(newest_.soft.get(), scene.source.get(), *scene.scene))
        swap = SceneSwap::Anew;
    WorldState world(std::move(scene.source), *scene.scene, WorldBodies::Simulated, newest_);
    setNewest(world);
    holdTextures(scene.root, world);
    if (newest_.driven != nullptr)
        driven_.emplace_back(scene.root, newest_.driven);
    Offer offer = offerOf(std::move(scene.scene), std::move(world), scene.number, swap);
    offeredLast_ = offer.root = scene.root;
    offer.reshaped = std::move(scene.reshaped);
    offerWorld(std::make_shared<const Offer>(std::move(offer)));
}

void ServoLoop::offerEdited(ReshapedScene scene) {
    WorldState world(std::move(scene.source), *scene.scene, WorldBodies::Simulated, newest());
    edited_.offer(std::make_shared<const Offer>(std::move(scene.scene), std::move(world), scene.number, 0u,
                                                scene.root, std::move(scene.reshaped), scene.oldestEdit));
}

void ServoLoop::setNewest(const WorldState& world) {
    const std::lock_guard lock(newestMutex_);
    newest_ = world.carriedOver();
}

CarriedOver ServoLoop::newest() {
    const std::lock_guard lock(newestMutex_);
    return newest_;
}

/// The strokes of a scene's textures, which a world is about to give to the servo, can be popped.
void ServoLoop::holdTextures(uint32_t number, const WorldState& world) {
    if (world.textures() == nullptr)
        return;
    world.textures()->keepStrokes();
    textures_.emplace_back(number, world.textures());
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
    if (newest_.soft != nullptr)
        return newest_.soft->takeKept(tick, bytes);
    return newest_.bodies != nullptr && newest_.bodies->takeKept(tick, bytes);
}

const body::BodyPoses* ServoLoop::bodyPoses() {
    if (newest_.bodies == nullptr)
        return nullptr;
    newest_.bodies->publication()->update();
    return &newest_.bodies->publication()->value();
}

} // namespace touchstone
