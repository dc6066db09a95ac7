#include "haptics/world/deforming_states.h"

#include "haptics/world/deformation_of.h"

#include <algorithm>
#include <chrono>
#include <cmath>

namespace touchstone {

namespace {

/// Slots: the tick's, that of the tick before, and one to fill; with a publisher those ahead, 21 ms of them.
constexpr size_t kSlots = 3, kSlotsAhead = 8;
/// Object units: an animation that ends farther than this from where it begins jumps there.
constexpr double kClosed = 1e-3;
constexpr auto kIdle = std::chrono::milliseconds(1);

} // namespace

std::vector<size_t> deformingObjects(const Scene* source, const HapticScene& haptic) {
    std::vector<size_t> objects;
    const Animation* animation = source != nullptr ? playedAnimation(*source) : nullptr;
    if (animation == nullptr)
        return objects;
    const std::vector<bool> moved = movedNodes(*source, *animation);
    for (size_t k = 0; k < haptic.objects.size(); ++k) {
        const MeshDeformation* const deformation = deformationOf(*source, *haptic.objects[k]);
        if (deformation != nullptr && deformation->drivenBy(*animation, moved))
            objects.push_back(k);
    }
    return objects;
}

DeformingStates::DeformingStates(ScenePtr source, const HapticScene& haptic,
                                 const std::vector<size_t>& objects)
    : source_(std::move(source)), animation_(playedAnimation(*source_)), pose_(*source_) {
    intervals_ =
        std::max<int64_t>(static_cast<int64_t>(std::ceil(animation_->duration * kPublicationRate - 1e-9)), 1);
    for (const size_t k : objects)
        add(haptic, k);
    addSlots(kSlots);
    Slot& first = *slots_.front();
    fill(first, intervals_ - 1); // where a lap ends
    std::vector<std::vector<glm::vec3>> last;
    for (const Part& part : first.parts)
        last.push_back(part.to);
    fill(first, 0);
    for (size_t p = 0; p < deformed_.size(); ++p)
        for (size_t v = 0; v < last[p].size() && !deformed_[p].jumps; ++v)
            deformed_[p].jumps =
                glm::distance(glm::dvec3(last[p][v]), glm::dvec3(first.parts[p].from[v])) > kClosed;
    first.use.store(Use::Held, std::memory_order_relaxed);
    now_ = before_ = &first;
    moment_ = previous_ = {0, 0.0};
}

DeformingStates::~DeformingStates() = default;

void DeformingStates::add(const HapticScene& haptic, size_t k) {
    const std::shared_ptr<const HapticObject>& rest = haptic.objects[k];
    const Mesh& mesh =
        source_->meshes[static_cast<size_t>(source_->instances[static_cast<size_t>(rest->instance)].mesh)];
    std::vector<uint32_t> source(rest->vertices.size() - 1, 0); // without the spare one
    for (size_t i = rest->indices.size(); i-- > 0;)
        source[rest->indices[i]] = mesh.sources[rest->sourceIndices[i]];
    const glm::dmat3 linear(rest->objectFromMesh);
    const bool invertible = std::abs(glm::determinant(linear)) > 0.0;
    deformed_.push_back(
        {.object = k,
         .rest = rest,
         .source = std::move(source),
         .mesh = &mesh,
         .vertices = DeformedVertices(*mesh.deformation),
         .normalFromMesh = invertible ? glm::transpose(glm::inverse(linear)) : glm::dmat3(1.0)});
}

bool DeformingStates::fit(const ScenePtr& source, const HapticScene& haptic,
                          const std::vector<size_t>& objects) const {
    return source == source_ &&
           std::ranges::equal(objects, deformed_, [&](size_t k, const Deformed& deformed) {
               return k == deformed.object && haptic.objects[k] == deformed.rest;
           });
}

void DeformingStates::addSlots(size_t count) {
    while (slots_.size() < count) {
        auto slot = std::make_unique<Slot>();
        for (const Deformed& deformed : deformed_) {
            Part& part = slot->parts.emplace_back();
            const size_t normals = deformed.rest->anySmooth && deformed.mesh->normalsFromFile
                                       ? deformed.rest->normals.size()
                                       : 0;
            for (auto* positions : {&part.from, &part.to})
                positions->resize(deformed.source.size());
            for (auto* directions : {&part.normalsFrom, &part.normalsTo})
                directions->resize(normals);
            part.interval.tree = deformed.rest->tree;
        }
        slots_.push_back(std::move(slot));
    }
}

double DeformingStates::gridTime(int64_t index) const noexcept {
    return std::min(static_cast<double>(index) / kPublicationRate, animation_->duration);
}

DeformingStates::Moment DeformingStates::momentAt(double time) const noexcept {
    const double looped = loopedTime(*animation_, time);
    const auto interval =
        std::clamp<int64_t>(static_cast<int64_t>(looped * kPublicationRate), 0, intervals_ - 1);
    const double begin = gridTime(interval), end = gridTime(interval + 1);
    return {interval, end > begin ? std::clamp((looped - begin) / (end - begin), 0.0, 1.0) : 0.0};
}

/// The vertices of a part where the pose is.
void DeformingStates::evaluate(double time, size_t p, std::vector<glm::vec3>& positions,
                               std::vector<glm::vec3>& normals) noexcept {
    Deformed& deformed = deformed_[p];
    pose_.evaluate(*source_, animation_, time);
    deformed.vertices.pose(pose_);
    const glm::dmat4& objectFromMesh = deformed.rest->objectFromMesh;
    for (size_t v = 0; v < positions.size(); ++v)
        positions[v] = glm::vec3(
            glm::dvec3(objectFromMesh * glm::dvec4(deformed.vertices.position(deformed.source[v]), 1.0)));
    for (size_t v = 0; v < normals.size(); ++v) {
        const glm::dvec3 normal =
            deformed.normalFromMesh * deformed.vertices.frame(deformed.mesh->sources[v]).normal;
        const double length = glm::length(normal);
        normals[v] = length > 0.0 ? glm::vec3(normal / length) : glm::vec3(0.0f);
    }
}

const DeformingStates::Slot* DeformingStates::published(int64_t interval) const noexcept {
    for (const auto& slot : slots_) {
        const Use use = slot->use.load(std::memory_order_relaxed);
        if ((use == Use::Ready || use == Use::Held) &&
            slot->interval.load(std::memory_order_relaxed) == interval)
            return slot.get();
    }
    return nullptr;
}

void DeformingStates::fill(Slot& slot, int64_t interval) noexcept {
    // A neighbour's end is this one's beginning: the same numbers.
    const Slot* const behind = published(interval - 1);
    const Slot* const ahead = published(interval + 1);
    for (size_t p = 0; p < deformed_.size(); ++p) {
        Part& part = slot.parts[p];
        if (behind != nullptr) {
            std::ranges::copy(behind->parts[p].to, part.from.begin());
            std::ranges::copy(behind->parts[p].normalsTo, part.normalsFrom.begin());
        } else {
            evaluate(gridTime(interval), p, part.from, part.normalsFrom);
        }
        if (ahead != nullptr) {
            std::ranges::copy(ahead->parts[p].from, part.to.begin());
            std::ranges::copy(ahead->parts[p].normalsFrom, part.normalsTo.begin());
        } else {
            evaluate(gridTime(interval + 1), p, part.to, part.normalsTo);
        }
        part.interval.fit(part.from, part.to, deformed_[p].rest->indices);
    }
    slot.interval.store(interval, std::memory_order_relaxed);
}

/// The slot of an interval, held; null where a publisher has not filled it yet.
DeformingStates::Slot* DeformingStates::obtain(int64_t interval) noexcept {
    for (Slot* const own : {now_, before_})
        if (own->interval.load(std::memory_order_relaxed) == interval)
            return own;
    for (const auto& slot : slots_) {
        Use ready = Use::Ready;
        if (slot->interval.load(std::memory_order_relaxed) != interval ||
            !slot->use.compare_exchange_strong(ready, Use::Held, std::memory_order_acquire))
            continue;
        if (slot->interval.load(std::memory_order_relaxed) == interval)
            return slot.get();
        slot->use.store(Use::Ready, std::memory_order_release);
    }
    if (ahead_.load(std::memory_order_relaxed))
        return nullptr;
    for (const auto& slot : slots_)
        if (slot->use.load(std::memory_order_relaxed) != Use::Held) {
            slot->use.store(Use::Writing, std::memory_order_relaxed);
            fill(*slot, interval);
            slot->use.store(Use::Held, std::memory_order_relaxed);
            return slot.get();
        }
    return nullptr;
}

double DeformingStates::travel(size_t p) const noexcept {
    if (still(p))
        return 0.0;
    const Part &from = before_->parts[p], &to = now_->parts[p];
    const int64_t step = moment_.interval - previous_.interval;
    if (step == 0)
        return std::abs(moment_.fraction - previous_.fraction) * to.interval.longest;
    if (step == 1)
        return (1.0 - previous_.fraction) * from.interval.longest + moment_.fraction * to.interval.longest;
    if (step == -1)
        return previous_.fraction * from.interval.longest + (1.0 - moment_.fraction) * to.interval.longest;
    const VertexBlend before = from.at(previous_.fraction).places, now = to.at(moment_.fraction).places;
    double longest = 0.0;
    for (size_t v = 0; v < to.from.size(); ++v)
        longest = std::max(longest, glm::distance(before.at(v), now.at(v)));
    return longest;
}

void DeformingStates::advance(double time, bool begins, bool hold) noexcept {
    const double lap = animation_->duration > 0.0 ? std::floor(time / animation_->duration) : 0.0;
    const bool restarts = !begins && lap != lap_;
    const Moment moment = momentAt(time);
    // What was now is before; what was before is free unless it is the same slot.
    if (before_ != now_) {
        before_->use.store(Use::Ready, std::memory_order_release);
        before_ = now_;
    }
    previous_ = moment_;
    wanted_.store(moment.interval, std::memory_order_relaxed);
    if (moment.interval != previous_.interval)
        direction_.store(moment.interval > previous_.interval || restarts ? 1 : -1,
                         std::memory_order_relaxed);
    Slot* const slot = hold ? nullptr : obtain(moment.interval);
    held_ = slot == nullptr;
    begins_ = begins;
    restarts_ = late_ = false;
    if (held_) {
        placed_ = placed_ && !begins;
        return;
    }
    late_ = !placed_ && !begins;
    begins_ = begins || late_;
    restarts_ = restarts;
    placed_ = true;
    lap_ = lap;
    now_ = slot;
    moment_ = moment;
}

void DeformingStates::addTo(Hash64& hash) const noexcept {
    hash.add(moment_.interval);
    hash.add(moment_.fraction);
    hash.add(held_);
}

/// Fills one interval that the servo will reach next; false where all are there.
bool DeformingStates::publishNext() noexcept {
    const int64_t here = wanted_.load(std::memory_order_relaxed);
    const int direction = direction_.load(std::memory_order_relaxed);
    const auto window = static_cast<int64_t>(slots_.size()) - 2; // two are the servo's
    const auto ahead = [&](int64_t step) {
        return ((here + direction * step) % intervals_ + intervals_) % intervals_;
    };
    for (int64_t step = 0; step < std::min(window, intervals_); ++step) {
        const int64_t interval = ahead(step);
        if (published(interval) != nullptr)
            continue;
        for (const auto& slot : slots_) {
            Use use = slot->use.load(std::memory_order_relaxed);
            if (use != Use::Empty && use != Use::Ready)
                continue;
            bool soon = false;
            for (int64_t other = -1; use == Use::Ready && other < window; ++other)
                soon |= slot->interval.load(std::memory_order_relaxed) == ahead(other);
            if (soon || !slot->use.compare_exchange_strong(use, Use::Writing, std::memory_order_acquire))
                continue;
            fill(*slot, interval);
            slot->use.store(Use::Ready, std::memory_order_release);
            return true;
        }
        return false;
    }
    return false;
}

void DeformingStates::publish(const std::stop_token& stop) noexcept {
    while (!stop.stop_requested())
        if (!publishNext())
            std::this_thread::sleep_for(kIdle);
}

void DeformingStates::publishAhead(double time) {
    if (publisher_.joinable())
        return;
    wanted_.store(momentAt(time).interval, std::memory_order_relaxed);
    addSlots(kSlotsAhead);
    while (publishNext()) {
    }
    ahead_.store(true, std::memory_order_relaxed);
    publisher_ = std::jthread([this](const std::stop_token& stop) { publish(stop); });
}

} // namespace touchstone
