// Where a replay begins or goes on: the recorded state of the hands and of what changes in their world.

#include "engine/core/error.h"
#include "haptics/body/body_world.h"
#include "haptics/proxy/place_proxy.h"
#include "haptics/recording/replayer.h"
#include "haptics/texture/persistent_textures.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace touchstone {

/// With other settings, the scene's next edit: the hands' own state goes on as on the servo (adopt). False
/// where it is another scene.
bool Replayer::takeUp(const RecordedTick& tick) {
    if (rootOf(tick.scene) != rootOf(scene_) || tick.scene == 0)
        return false;
    Touched* const touched = this->touched(tick.scene);
    putDriven(tick, *touched);
    touched->world.begin(previousTime_);
    const HapticScene& scene = *touched->scene.haptic;
    const ObjectMotions moved = touched->world.poses();
    const auto edited = edited_.find(rootOf(tick.scene));
    const std::vector<int> reshaped =
        edited != edited_.end() ? edited->second->sculptor.sculpted() : std::vector<int>();
    for (DeviceState& device : devices_)
        takeUpReshaped(scene, moved.empty() ? ObjectMotions(scene.restMotions) : moved, reshaped, device);
    scene_ = tick.scene;
    return true;
}

/// Where the recording says what a caller moved before `tick`, the objects are there.
void Replayer::putDriven(const RecordedTick& tick, Touched& touched) const {
    const auto state = driven_.find(tick.tick);
    if (state == driven_.end())
        return;
    const size_t objects = touched.scene.haptic->objects.size();
    for (const DrivenPose& pose : state->second.poses())
        if (static_cast<size_t>(pose.object) >= objects)
            throw Error("recording", "", "moves an object that its scene does not have",
                        "the file is damaged, or its scene is another one now");
    const auto give = [](Touched& of, std::shared_ptr<DrivenObjects> driven) {
        CarriedOver goesOn = of.world.carriedOver();
        goesOn.driven = std::move(driven);
        of.world = WorldState(of.scene.source, *of.scene.haptic, WorldBodies::Simulated, std::move(goesOn));
    };
    // An edited scene has those of its root, which tells where they are (`moved`).
    Touched& root = *loaded_.at(rootOf(tick.scene));
    if (root.world.driven() == nullptr)
        give(root, std::make_shared<DrivenObjects>());
    if (touched.world.driven() == nullptr)
        give(touched, root.world.driven());
    touched.world.driven()->restore(state->second);
}

/// Restores the state of every hand at the checkpoint before `tick`.
void Replayer::resume(const RecordedTick& tick) {
    Touched* const touched = this->touched(tick.scene);
    const HapticScene* const scene = touched != nullptr ? touched->scene.haptic.get() : nullptr;
    const double came = checkpoint_->previousTime;
    otherStates_[0] = *checkpoint_;
    // Without a gap before it, it must equal the state after the preceding ticks.
    const bool goesOn = known_ && scene_ == tick.scene && came == previousTime_;
    // What moves goes on in an edit of the scene, which shares it (CarriedOver): its state need not be there.
    const bool edited = known_ && scene_ != 0 && tick.scene != 0 && rootOf(tick.scene) == rootOf(scene_) &&
                        came == previousTime_;
    devices_.resize(ticks_.size());
    pads_.resize(ticks_.size());
    samples_.resize(ticks_.size());
    outputs_.resize(ticks_.size());
    traces_.resize(ticks_.size());
    known_ = true;
    for (uint32_t hand = 0; hand < devices_.size(); ++hand) {
        const auto state = otherStates_.find(hand);
        if (state == otherStates_.end() || state->second.tick != tick.tick) {
            known_ = false;
            continue;
        }
        if (goesOn && !change_) {
            TouchCheckpoint own;
            takeCheckpoint(devices_[hand], own);
            const bool displays = ticks_[hand].pad.limits.reach > 0.0;
            if (!std::ranges::equal(own.state(), state->second.state()) ||
                (displays && pads_[hand].last != ticks_[hand].pad.before))
                differs({.tick = tick.tick, .time = tick.time, .hand = hand, .stage = "state"});
        }
        pads_[hand].last = ticks_[hand].pad.before;
        known_ &= restoreCheckpoint(state->second.state(), scene, devices_[hand]);
    }
    scene_ = tick.scene;
    if (!known_ || touched == nullptr)
        return;
    // A virtual point on a field is watched, too, and walks on no neighbours.
    if (std::ranges::any_of(devices_, [&](const DeviceState& device) {
            return device.watch.touching &&
                   scene->objects[static_cast<size_t>(device.reference)]->shape == nullptr;
        }))
        scene->buildNeighbourhoods();
    putDriven(tick, *touched);
    if (!goesOn)
        touched->world.begin(came);
    if (touched->world.textures() != nullptr && !goesOn)
        known_ &= restoreTextures(tick, *touched->world.textures());
    if (!known_)
        return;
    // A scene with bodies is known where their state is recorded, or was known and went on.
    if ((touched->world.bodies() != nullptr || touched->world.soft() != nullptr) && !(goesOn && change_))
        known_ = bodies_ && bodies_->tick == tick.tick ? touched->world.restoreBodies(bodies_->bytes)
                                                       : goesOn || edited;
}

/// The state before `tick`: the last whole one and the strokes since. False where that does not fit.
bool Replayer::restoreTextures(const RecordedTick& tick, PersistentTextures& textures) const {
    if (textures_.empty() || textures_[0].tick > tick.tick)
        return false;
    textures.reset();
    for (const RecordedTextures& part : textures_)
        for (const RecordedTextures::Tile& tile : part.tiles) {
            PersistentTexture* const texture = textures.at(static_cast<int>(tile.object));
            if (texture == nullptr || tile.tile >= texture->tiles())
                return false;
            const PersistentTexture::Place place = texture->placeOf(tile.tile);
            std::vector<float> values = tile.values;
            if (values.size() == 1)
                values.resize(size_t{place.width} * place.height, tile.values[0]);
            if (!texture->setTile(tile.tile, values))
                return false;
        }
    for (size_t k = 0; k < textures.objects(); ++k)
        if (PersistentTexture* const texture = textures.at(static_cast<int>(k)))
            texture->settle();
    for (const BrushStroke& stroke : strokes_)
        if (stroke.tick < tick.tick)
            textures.apply({&stroke, 1});
    return true;
}

} // namespace touchstone
