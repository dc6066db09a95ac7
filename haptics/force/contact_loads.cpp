#include "haptics/force/contact_loads.h"

#include "haptics/force/spring_damper.h"
#include "haptics/shading/turned_normal.h"
#include "haptics/surface/press_dents.h"
#include "haptics/surface/program_surface.h"

#include <algorithm>
#include <span>

namespace touchstone {

namespace {

std::span<const ContactLoad> held(const ContactLoads& loads) {
    return {loads.contacts.data(), static_cast<size_t>(loads.count)};
}

/// The depth for which the force of a contact is made, of which it bears feel.depth.
double reachOf(const ContactLoad& contact) {
    return std::max(contact.depth, contact.feel.depth);
}

/// f_i without a program. Along a projected normal feel.depth is longer than lambda_i.
glm::dvec3 materialForce(const ContactLoad& contact) {
    const SurfaceSample& feel = contact.feel;
    if (feel.bump != 0.0) {
        const double below = reachOf(contact);
        const double raised = below > 0.0 ? std::max(below + feel.bump, 0.0) / below : 1.0;
        return feel.stiffness * feel.depth * raised * feel.textured;
    }
    if (!feel.hasHeight)
        return feel.stiffness * feel.depth * feel.lengthening * feel.textured;
    const double reach = reachOf(contact);
    const double tilt = reach > feel.height ? feel.height / reach : 1.0;
    return feel.stiffness * feel.depth * (feel.normal + tilt * (feel.textured - feel.normal));
}

/// f_i.
glm::dvec3 contactForce(const ContactLoad& contact) {
    const SurfaceSample& feel = contact.feel;
    glm::dvec3 force = materialForce(contact);
    if (feel.programmed) [[unlikely]] {
        const double reach = reachOf(contact);
        force = withProgram(feel, force, reach > 0.0 ? feel.depth / reach : 1.0);
    }
    if (feel.dent > 0.0) [[unlikely]]
        force += feel.stiffness * feel.depth * feel.dentSlope;
    return force;
}

/// -c_i min(1, lambda_i / d_i) (v . n_i) n_i, without pulling.
glm::dvec3 contactDamping(const ContactLoads& loads, const ContactLoad& contact, const glm::dvec3& velocity) {
    const glm::dvec3& n = contact.feel.normal;
    const double push = std::max(loads.bounding * glm::dot(contactForce(contact), n), 0.0);
    return std::max(-contact.feel.damping * partOf(contact) * glm::dot(velocity, n), -push) * n;
}

/// True where F is K (p - h), to the last bit.
bool alike(const ContactLoads& loads) {
    return std::ranges::all_of(held(loads), [&](const ContactLoad& contact) {
        const SurfaceSample& feel = contact.feel;
        return feel.stiffness == loads.contacts[0].feel.stiffness && feel.depth == contact.length &&
               feel.normal == contact.plane && feel.textured == contact.plane && feel.lengthening == 1.0 &&
               feel.bump == 0.0 && !feel.programmed;
    });
}

} // namespace

void readLoads(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
               const DeviceLimits& limits, int reference, const SolveResult& rest, const SubGoal& activeSet,
               bool twoPass, const glm::dvec3& offset, double workspacePerReference,
               const glm::dvec3& velocity, double zoom, double dt, ProgramRun* programs, DentPress* dents,
               ContactLoads& loads) noexcept {
    loads.count = activeSet.count;
    loads.offset = workspacePerReference * offset;
    loads.loaded = 0;
    double sum = 0.0, weighted = 0.0, most = -1.0;
    for (size_t i = 0; i < static_cast<size_t>(activeSet.count); ++i) {
        const auto at = static_cast<size_t>(activeSet.active[i]);
        const Contact& contact = rest.contacts[at];
        ContactLoad& load = loads.contacts[i];
        load.surface = contact.normal;
        load.plane = twoPass ? rest.shadedPlanes[at].normal : contact.normal;
        load.length = workspacePerReference * activeSet.multiplier[i];
        const TurnedNormal turned = turnedNormal(scene, motions, settings, reference, contact, load.plane);
        load.depth = glm::dot(load.plane, loads.offset) / turned.cosine;
        const double speed = glm::length(velocity - glm::dot(velocity, turned.normal) * turned.normal);
        load.feel = readSurface(scene, motions, settings, limits, reference, contact, turned.normal,
                                load.length / turned.cosine, speed, dt);
        if (programs != nullptr) {
            const double reach = reachOf(load);
            programs->part = reach > 0.0 ? load.feel.depth / reach : 1.0;
            runProgram(scene, motions, settings, limits, reference, contact, reach, *programs, load.feel);
        }
        if (dents != nullptr) [[unlikely]] {
            const double whole = load.feel.depth;
            pressDents(scene, motions, reference, contact, speed, *dents, load.feel);
            load.depth *= whole > 0.0 ? load.feel.depth / whole : 1.0;
        }
        if (zoom > 1.0) {
            const double share = bearableShare(load.feel.stiffness, zoom, settings, limits);
            load.feel.stiffness *= share;
            load.feel.programForce *= share;
            load.feel.damping *= share;
            load.feel.viscousFriction *= share;
        }
        const double carried = load.feel.stiffness * load.length;
        sum += load.length;
        weighted += carried;
        if (carried > most) {
            most = carried;
            loads.loaded = static_cast<int>(i);
        }
    }
    const double resultant = glm::length(loads.offset);
    loads.stiffness = sum > 0.0 ? weighted / sum : loads.contacts[0].feel.stiffness;
    loads.bounding = sum > kMaxLoad * resultant ? kMaxLoad * resultant / sum : 1.0;
}

glm::dvec3 elasticForce(const ContactLoads& loads) noexcept {
    if (alike(loads))
        return loads.contacts[0].feel.stiffness * loads.offset;
    glm::dvec3 differences(0.0);
    for (const ContactLoad& contact : held(loads))
        differences += contactForce(contact) - loads.stiffness * contact.length * contact.plane;
    return loads.stiffness * loads.offset + loads.bounding * differences;
}

glm::dvec3 dampingForce(const ContactLoads& loads, const glm::dvec3& velocity) noexcept {
    glm::dvec3 force(0.0);
    for (const ContactLoad& contact : held(loads))
        force += contactDamping(loads, contact, velocity);
    return force;
}

void splitForces(const ContactLoads& loads, const glm::dvec3& velocity, ContactForces& forces) noexcept {
    for (size_t i = 0; i < static_cast<size_t>(loads.count); ++i) {
        const ContactLoad& contact = loads.contacts[i];
        const glm::dvec3 share = loads.stiffness * contact.length * contact.plane;
        forces.force[i] = share + loads.bounding * (contactForce(contact) - share) +
                          contactDamping(loads, contact, velocity);
        forces.load[i] = loads.bounding * contact.feel.stiffness * contact.feel.depth;
        forces.grip[i] = forces.load[i] * contact.feel.staticFriction;
    }
}

void ContactForces::complete(const glm::dvec3& whole) noexcept {
    glm::dvec3 left = whole;
    double grips = 0.0, loads = 0.0;
    for (size_t i = 0; i < count; ++i) {
        left -= force[i];
        grips += grip[i];
        loads += load[i];
    }
    const glm::dvec3 all = left;
    for (size_t i = 0; i + 1 < count; ++i) {
        const double part = grips > 0.0   ? grip[i] / grips
                            : loads > 0.0 ? load[i] / loads
                                          : 1.0 / static_cast<double>(count);
        force[i] += part * all;
        left -= part * all;
    }
    if (count > 0)
        force[count - 1] += left; // what rounding leaves, too
}

} // namespace touchstone
