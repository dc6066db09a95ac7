#include "haptics/friction/friction_cone.h"

#include <algorithm>

namespace touchstone {

FrictionCone::FrictionCone(const SurfaceSample& feel, const glm::dvec3& velocity,
                           double workspacePerReference) noexcept
    : count_(1), rough_(feel.touching && feel.staticFriction > 0.0), stiffness_(feel.stiffness),
      workspacePerReference_(workspacePerReference) {
    single_ = {.depth = feel.depth / workspacePerReference,
               .staticFriction = feel.staticFriction,
               .dynamicFriction = feel.dynamicFriction};
    down_ = -single_.depth * feel.normal;
    if (!(feel.viscousFriction > 0.0))
        return;
    const double load = feel.stiffness * feel.depth;
    addViscous(feel, feel.normal, load, 1.0, velocity);
    const double taken = load > 0.0 ? viscous_ / load : 0.0;
    single_.staticFriction = std::max(single_.staticFriction - taken, 0.0);
    single_.dynamicFriction = std::max(single_.dynamicFriction - taken, 0.0);
}

FrictionCone::FrictionCone(const ContactLoads& loads, const glm::dvec3& velocity,
                           double workspacePerReference) noexcept
    : count_(loads.count), stiffness_(loads.stiffness), workspacePerReference_(workspacePerReference),
      down_(-loads.offset / workspacePerReference) {
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
        const ContactLoad& contact = loads.contacts[i];
        const SurfaceSample& feel = contact.feel;
        const double load = loads.bounding * feel.stiffness * feel.depth;
        disks_[i] = {.normal = contact.surface,
                     .load = load,
                     .staticFriction = feel.staticFriction,
                     .dynamicFriction = feel.dynamicFriction};
        rough_ |= feel.staticFriction > 0.0;
        addViscous(feel, feel.normal, load, partOf(contact), velocity);
    }
}

void FrictionCone::addViscous(const SurfaceSample& feel, const glm::dvec3& normal, double load, double part,
                              const glm::dvec3& velocity) noexcept {
    if (!(feel.viscousFriction > 0.0))
        return;
    const glm::dvec3 along = velocity - glm::dot(velocity, normal) * normal;
    glm::dvec3 force = -feel.viscousFriction * part * along;
    if (feel.coulomb) {
        const double whole = glm::length(force), most = feel.dynamicFriction * load;
        if (whole > most)
            force *= most / whole;
        viscous_ += std::min(whole, most);
    }
    viscousForce_ += force;
}

FrictionCone::Limit FrictionCone::along(const glm::dvec3& stretch) const noexcept {
    if (count_ <= 1)
        return single_;
    const double length = glm::length(stretch);
    double load = 0.0, stays = -viscous_, slides = -viscous_;
    for (size_t i = 0; i < static_cast<size_t>(count_); ++i) {
        const Disk& disk = disks_[i];
        const glm::dvec3 tangential = stretch - glm::dot(stretch, disk.normal) * disk.normal;
        const double extent = length > 0.0 ? disk.load * glm::length(tangential) / length : disk.load;
        load += extent;
        stays += disk.staticFriction * extent;
        slides += disk.dynamicFriction * extent;
    }
    if (!(load > 0.0) || !(stiffness_ > 0.0))
        return {};
    return {.depth = load / (stiffness_ * workspacePerReference_),
            .staticFriction = std::max(stays, 0.0) / load,
            .dynamicFriction = std::max(slides, 0.0) / load};
}

} // namespace touchstone
