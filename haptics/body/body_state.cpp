// The state of bodies as bytes, for checkpoints, replay and what follows an earlier tick.

#include "haptics/body/body_world.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <type_traits>

namespace touchstone::body {

namespace {

constexpr uint64_t kStateMagic = 0x31594430424f4459; // of this layout

struct StateHeader {
    uint64_t magic = kStateMagic, tick = 0, bodies = 0, joints = 0, contacts = 0, stirred = 0;
    double followed = 0.0;
    uint64_t stirs = 0;
};
struct StirredBody {
    BodyState state;
    uint32_t body = 0, settled = 0;
};
struct JointMemory {
    std::array<double, 8> impulse;
    std::array<double, 3> turns, lastAngle;
};
static_assert(std::is_trivially_copyable_v<StirredBody> && std::is_trivially_copyable_v<BodyContact> &&
              std::is_trivially_copyable_v<JointMemory>);

/// Of what was read from bytes: any value but 0 and 1 is no bool, and may not be looked at as one.
bool isFlag(const bool& read) {
    uint8_t byte = 0;
    std::memcpy(&byte, &read, sizeof(byte));
    return byte <= 1;
}

/// What follows the header: states, joints, contacts. A damaged one must not be looked at as one of bodies.
bool isSound(const StateHeader& header, const std::byte* from, size_t forms) {
    const auto get = [&](auto& value) {
        std::memcpy(&value, from, sizeof(value));
        from += sizeof(value);
    };
    for (size_t i = 0; i < header.stirred; ++i) {
        StirredBody stirred;
        get(stirred);
        const Pose& pose = stirred.state.pose;
        if (stirred.body >= header.bodies || !std::isfinite(glm::dot(pose.position, pose.position)) ||
            !(std::abs(glm::length(pose.rotation) - 1.0) < 1e-6) || !isFlag(stirred.state.awake) ||
            !isFlag(stirred.state.stirred))
            return false;
    }
    from += header.joints * sizeof(JointMemory);
    for (size_t i = 0; i < header.contacts; ++i) {
        BodyContact contact;
        get(contact);
        const auto count = static_cast<int32_t>(header.bodies);
        if (contact.a < 0 || contact.a >= count || contact.b < -1 || contact.b >= count ||
            contact.frame < -1 || contact.frame >= count || contact.pair >> 16 >= forms ||
            (contact.pair & 0xffff) >= forms || !isFlag(contact.roundA) || !isFlag(contact.roundB) ||
            !isFlag(contact.slides))
            return false;
    }
    return true;
}

} // namespace

size_t BodyWorld::stateCapacity() const noexcept {
    return sizeof(StateHeader) + states_.size() * sizeof(StirredBody) +
           solver_->joints().size() * sizeof(JointMemory) + solver_->contactCapacity() * sizeof(BodyContact);
}

size_t BodyWorld::save(std::span<std::byte> bytes) noexcept {
    earliest_ = tick_;
    StateHeader header{.tick = tick_,
                       .bodies = states_.size(),
                       .joints = solver_->joints().size(),
                       .contacts = solver_->contacts().size(),
                       .followed = followed_,
                       .stirs = stirs_ ? 1u : 0u};
    size_t at = sizeof(header);
    const auto put = [&](const auto& value) {
        std::memcpy(bytes.data() + at, &value, sizeof(value));
        at += sizeof(value);
    };
    for (size_t b = 0; b < states_.size(); ++b)
        if (states_[b].stirred) {
            StirredBody stirred;
            std::memset(static_cast<void*>(&stirred), 0, sizeof(stirred)); // padding, too
            stirred.state = states_[b];
            stirred.body = static_cast<uint32_t>(b);
            stirred.settled = std::ranges::find(settled_, static_cast<int>(b)) != settled_.end() ? 1 : 0;
            put(stirred);
            ++header.stirred;
        }
    for (const BodyJoint& joint : solver_->joints())
        put(JointMemory{joint.impulse, joint.turns, joint.lastAngle});
    for (const BodyContact& contact : solver_->contacts())
        put(contact);
    std::memcpy(bytes.data(), &header, sizeof(header));
    return at;
}

bool BodyWorld::restore(std::span<const std::byte> bytes) noexcept {
    StateHeader header;
    if (bytes.size() < sizeof(header))
        return false;
    std::memcpy(&header, bytes.data(), sizeof(header));
    if (header.magic != kStateMagic || header.bodies != states_.size() ||
        header.joints != solver_->joints().size() || header.stirred > header.bodies ||
        header.contacts > solver_->contactCapacity() ||
        bytes.size() != sizeof(header) + header.stirred * sizeof(StirredBody) +
                            header.joints * sizeof(JointMemory) + header.contacts * sizeof(BodyContact))
        return false;
    const std::byte* from = bytes.data() + sizeof(header);
    const auto get = [&](auto& value) {
        std::memcpy(&value, from, sizeof(value));
        from += sizeof(value);
    };
    if (!isSound(header, from, finder_->forms().size()))
        return false;
    states_ = initial_;
    for (BodyState& state : states_)
        state.awake = state.stirred = false;
    awake_.clear();
    settled_.clear();
    std::ranges::fill(active_, 0);
    for (size_t i = 0; i < header.stirred; ++i) {
        StirredBody stirred;
        get(stirred);
        states_[stirred.body] = stirred.state;
        if (stirred.state.awake && awake_.size() < kMaxAwake) {
            awake_.push_back(static_cast<int>(stirred.body));
            active_[stirred.body] = 1;
        }
        if (stirred.settled != 0)
            settled_.push_back(static_cast<int>(stirred.body));
    }
    for (BodyJoint& joint : solver_->joints()) {
        JointMemory memory;
        get(memory);
        joint.impulse = memory.impulse;
        joint.turns = memory.turns;
        joint.lastAngle = memory.lastAngle;
    }
    for (size_t i = 0; i < header.contacts; ++i)
        get(solver_->contactSlots()[i]);
    solver_->setContactCount(header.contacts);
    tick_ = earliest_ = header.tick;
    followed_ = header.followed;
    stirs_ = header.stirs != 0;
    return true;
}

void BodyWorld::addTo(Hash64& hash) const noexcept {
    for (size_t b = 0; b < states_.size(); ++b) {
        if (!states_[b].awake)
            continue;
        const Pose& pose = states_[b].pose;
        for (const double number : {pose.position.x, pose.position.y, pose.position.z, pose.rotation.x,
                                    pose.rotation.y, pose.rotation.z, pose.rotation.w})
            hash.add(number);
    }
}

} // namespace touchstone::body
