#include "haptics/world/world_state.h"

#include "engine/core/checksum.h"
#include "engine/math/nearest_similarity.h"
#include "haptics/body/body_world.h"
#include "haptics/scene/scene_programs.h"
#include "haptics/texture/persistent_textures.h"
#include "haptics/world/driven_objects.h"
#include "haptics/world/soft_objects.h"

#include <algorithm>
#include <cmath>
#include <string>

namespace touchstone {

namespace {

/// True where two poses are equal up to the rounding of keys in a file: a thousandth of the object.
bool meet(const Similarity& a, const Similarity& b) {
    constexpr double kSame = 1e-3;
    return glm::length(a.translation - b.translation) < kSame * a.scale &&
           std::abs(a.scale - b.scale) < kSame * a.scale &&
           std::abs(glm::dot(a.rotation, b.rotation)) > 1.0 - 0.125 * kSame * kSame;
}

} // namespace

std::vector<Warning> animationWarnings(const Scene& scene) {
    const Animation* animation = playedAnimation(scene);
    std::vector<Warning> warnings;
    if (animation == nullptr)
        return warnings;
    const auto played = static_cast<size_t>(animation - scene.animations.data());
    if (scene.animations.size() > 1 && scene.animation < 0)
        warnings.push_back({"animations", "only one of " + std::to_string(scene.animations.size()) +
                                              " plays, the first that moves a mesh: '" + animation->name +
                                              "' (--animation NAME plays another)"});
    for (const AnimationChannel& channel : animation->channels) {
        if (channel.path != AnimatedPath::Scale)
            continue;
        for (const glm::vec4& scale : channel.values)
            if (std::abs(scale.x - scale.y) + std::abs(scale.y - scale.z) > 1e-4f * std::abs(scale.x)) {
                warnings.push_back(
                    {"animations[" + std::to_string(played) + "]",
                     "scales node " + std::to_string(channel.node) + " unevenly: it is felt scaled evenly"});
                return warnings;
            }
    }
    return warnings;
}

WorldState::WorldState() noexcept = default;
WorldState::~WorldState() = default;
WorldState::WorldState(WorldState&&) noexcept = default;
WorldState& WorldState::operator=(WorldState&&) noexcept = default;

WorldState::WorldState(ScenePtr source, const HapticScene& haptic, WorldBodies bodies, CarriedOver goesOn)
    : scene_(std::move(source)), animation_(scene_ != nullptr ? playedAnimation(*scene_) : nullptr),
      workspaceFromScene_(haptic.workspaceFromScene), driven_(std::move(goesOn.driven)) {
    if (animation_ != nullptr)
        findMovers(haptic, std::move(goesOn.deforming));
    if (driven_ != nullptr)
        motions_ = haptic.restMotions;
    if (bodies == WorldBodies::Simulated)
        textures_ = persistentTextures(haptic, std::move(goesOn.textures));
    if (deforming_ != nullptr)
        own_ = &deforming_->scene();
    else if (bodies == WorldBodies::Simulated)
        soft_ = SoftObjects::of(scene_, haptic, std::move(goesOn.soft));
    if (soft_ != nullptr) {
        softStates_ = soft_->states();
        own_ = &soft_->scene();
        motions_ = haptic.restMotions;
        collects_ = true;
    }
    if (scene_ == nullptr || scene_->physics == nullptr)
        return;
    bodies_ = goesOn.bodies != nullptr ? std::move(goesOn.bodies) : body::BodyWorld::make(*scene_, haptic);
    if (bodies_ == nullptr)
        return;
    motions_ = haptic.restMotions;
    if (bodies == WorldBodies::Shown)
        shown_ = std::make_unique<body::BodyPoses>(bodies_->publication()->value());
    else
        collects_ = true;
    animated_.assign(haptic.objects.size(), 0);
    for (const Mover& mover : movers_)
        animated_[mover.object] = 1;
    for (const auto& object : haptic.objects) {
        objectFromMesh_.push_back(object->objectFromMesh);
        instanceOf_.push_back(object->instance);
    }
}

/// Objects that the animation moves.
void WorldState::findMovers(const HapticScene& haptic, std::shared_ptr<DeformingStates> deforming) {
    const std::vector<bool> moved = movedNodes(*scene_, *animation_);
    for (size_t k = 0; k < haptic.objects.size(); ++k) {
        if (haptic.objects[k]->instance < 0)
            continue; // a shape that is not in a file
        const auto instance = static_cast<size_t>(haptic.objects[k]->instance);
        const glm::dmat4& objectFromMesh = haptic.objects[k]->objectFromMesh;
        const Instance& placed = scene_->instances[instance];
        if (!placed.followsNode || placed.node < 0 || !moved[static_cast<size_t>(placed.node)] ||
            glm::determinant(glm::dmat3(objectFromMesh)) == 0.0)
            continue;
        movers_.push_back({k, instance, glm::inverse(objectFromMesh)});
    }
    deforming_ = DeformingObjects::of(scene_, haptic, std::move(deforming));
    if (!movers_.empty() || deforming_ != nullptr)
        motions_ = haptic.restMotions;
    if (movers_.empty())
        return;
    ScenePose& pose = pose_.emplace_back(*scene_);
    const glm::dmat4 workspaceFromScene = matrixOf(workspaceFromScene_);
    const auto posesAt = [&](double time) {
        pose.evaluate(*scene_, animation_, time);
        std::vector<Similarity> poses;
        for (const Mover& mover : movers_)
            nearestSimilarity(workspaceFromScene * pose.sceneFromMesh()[mover.instance] *
                                  mover.meshFromObject,
                              poses.emplace_back(motions_[mover.object].workspaceFromObject));
        return poses;
    };
    const std::vector<Similarity> first = posesAt(0.0), last = posesAt(animation_->duration);
    for (size_t m = 0; m < movers_.size(); ++m)
        movers_[m].jumps = !meet(first[m], last[m]);
}

/// All but the rigid bodies.
void WorldState::moveObjects(double time, bool hold) noexcept {
    if (deforming_ != nullptr) [[unlikely]]
        for (ObjectMotion& motion : motions_)
            motion.jumped = false; // also of objects that deform and do not move
    if (!movers_.empty())
        movePoses(time);
    if (driven_ != nullptr) [[unlikely]]
        driven_->advance(motions_, !sampled_);
    if (deforming_ != nullptr) [[unlikely]]
        deforming_->advance(time, !sampled_, hold, motions_);
    if (soft_ != nullptr) [[unlikely]]
        advanceSoft(hold);
}

ObjectMotions WorldState::advance(double time, bool hold) noexcept {
    if (!moving())
        return poses_;
    moveObjects(time, hold);
    if (bodies_ != nullptr)
        advanceBodies(time);
    sampled_ = true;
    return poses_ = motions_;
}

void WorldState::begin(double time) noexcept {
    forget();
    if (!moving() || !std::isfinite(time))
        return;
    moveObjects(time, false);
    if (bodies_ != nullptr)
        bodies_->showPublished(motions_);
    sampled_ = true;
    poses_ = motions_;
}

void WorldState::movePoses(double time) noexcept {
    ScenePose& pose = pose_.front();
    pose.evaluate(*scene_, animation_, loopedTime(*animation_, time));
    const double lap = animation_->duration > 0.0 ? std::floor(time / animation_->duration) : 0.0;
    const bool again = sampled_ && lap != lap_;
    lap_ = lap;
    const glm::dmat4 workspaceFromScene = matrixOf(workspaceFromScene_);
    for (const Mover& mover : movers_) {
        ObjectMotion& motion = motions_[mover.object];
        motion.before = motion.workspaceFromObject;
        motion.jumped = again && mover.jumps;
        nearestSimilarity(workspaceFromScene * pose.sceneFromMesh()[mover.instance] * mover.meshFromObject,
                          motion.workspaceFromObject);
        if (!sampled_)
            motion.before = motion.workspaceFromObject;
    }
}

void WorldState::advanceBodies(double time) noexcept {
    if (shown_ != nullptr) {
        for (const body::BodyObject& of : bodies_->objects()) {
            ObjectMotion& motion = motions_[of.object];
            motion.before = motion.workspaceFromObject;
            motion.workspaceFromObject =
                shown_->workspaceFromBody[static_cast<size_t>(of.body)].similarity() * of.bodyFromObject;
            if (!sampled_)
                motion.before = motion.workspaceFromObject;
        }
        return;
    }
    if (!movers_.empty())
        bodies_->followAnimation(motions_, animated_, time);
    bodies_->beginTick();
    const bool moved = bodies_->writePoses(motions_, !sampled_);
    still_ = !moved && movers_.empty() && deforming_ == nullptr && sampled_;
}

void WorldState::advanceSoft(bool hold) noexcept {
    soft_->advance(!sampled_, hold, motions_);
    still_ = soft_->still() && movers_.empty() && driven_ == nullptr;
}

void WorldState::showBodies(const body::BodyPoses& poses) {
    if (shown_ != nullptr)
        *shown_ = poses;
}

void WorldState::pushBody(int object, const body::HandPush& push) noexcept {
    bodies_->push(object, push);
}

void WorldState::integrateBodies(const HapticSettings& settings, double dt) noexcept {
    if (shown_ == nullptr)
        bodies_->integrate(settings.integrator, settings.gravity, dt);
}

void WorldState::pushSoft(int object, const body::HandPush& push) noexcept {
    softStates_->push(object, push);
}

void WorldState::integrateSoft(const HapticSettings& settings, double dt) noexcept {
    softStates_->integrate(settings.gravity, dt);
}

void WorldState::stepSoftApart() const {
    softStates_->stepApart();
}

bool WorldState::keepState(uint64_t tick) noexcept {
    if (bodies_ != nullptr)
        return bodies_->keep(tick);
    if (softStates_ == nullptr || !softStates_->keep(tick))
        return false;
    soft_->showRestored();
    return true;
}

bool WorldState::softHeld() const noexcept {
    return softStates_->held();
}

std::vector<std::byte> WorldState::bodyState() const {
    std::vector<std::byte> bytes;
    if (soft_ != nullptr) {
        bytes.resize(softStates_->stateSize());
        softStates_->save(bytes);
    } else if (bodies_ != nullptr) {
        bytes.resize(bodies_->stateCapacity());
        bytes.resize(bodies_->save(bytes));
    }
    return bytes;
}

CarriedOver WorldState::carriedOver() const {
    return {.bodies = bodies_,
            .deforming = deforming_ != nullptr ? deforming_->states() : nullptr,
            .soft = softStates_,
            .textures = textures_,
            .driven = driven_};
}

void WorldState::applyStrokes() noexcept {
    textures_->applyQueued();
}

void WorldState::shareTextures(std::shared_ptr<PersistentTextures> textures) noexcept {
    textures_ = std::move(textures);
}

bool WorldState::restoreBodies(std::span<const std::byte> bytes) noexcept {
    if (soft_ != nullptr) {
        const bool sound = softStates_->restore(bytes);
        soft_->showRestored();
        return sound;
    }
    if (bodies_ == nullptr || !bodies_->restore(bytes))
        return false;
    bodies_->showPublished(motions_);
    return true;
}

uint32_t WorldState::foundContacts() const noexcept {
    return bodies_ != nullptr ? bodies_->found() : 0;
}

std::vector<glm::dmat4> WorldState::sceneFromMesh() const {
    std::vector<glm::dmat4> poses;
    for (const Instance& instance : scene_->instances)
        poses.push_back(instance.sceneFromMesh);
    if (!pose_.empty())
        std::ranges::copy(pose_.front().sceneFromMesh(), poses.begin());
    if (bodies_ == nullptr)
        return poses;
    const glm::dmat4 sceneFromWorkspace = matrixOf(workspaceFromScene_.inverse());
    for (const body::BodyObject& of : bodies_->objects())
        poses[static_cast<size_t>(instanceOf_[of.object])] =
            sceneFromWorkspace * matrixOf(motions_[of.object].workspaceFromObject) *
            objectFromMesh_[of.object];
    return poses;
}

uint32_t WorldState::poseHash() const noexcept {
    if (!moving())
        return 0;
    Hash64 hash;
    if (deforming_ != nullptr)
        deforming_->states()->addTo(hash);
    if (soft_ != nullptr)
        softStates_->addTo(hash);
    for (const Mover& mover : movers_) {
        const ObjectMotion& motion = motions_[mover.object];
        const Similarity& pose = motion.workspaceFromObject;
        for (const double number :
             {pose.scale, pose.rotation.x, pose.rotation.y, pose.rotation.z, pose.rotation.w,
              pose.translation.x, pose.translation.y, pose.translation.z})
            hash.add(number);
        hash.add(motion.jumped);
    }
    if (driven_ != nullptr)
        driven_->addTo(hash);
    if (bodies_ != nullptr)
        bodies_->addTo(hash);
    return hash.folded();
}

} // namespace touchstone
