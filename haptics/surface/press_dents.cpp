#include "haptics/surface/press_dents.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace touchstone {

namespace {

/// m: a dent that is less deep is none.
constexpr double kShallow = 1e-9;
/// A place whose normal turns from the dent's by 78 degrees begins to leave it; by 90 degrees it has: the
/// other side of the object does not follow.
constexpr double kTurned = 0.2;
/// Of its radius, by which a dent is behind a contact that slides.
constexpr double kLag = 0.25;

/// The contact in the frame of its object.
struct Place {
    glm::dvec3 point{0.0}, normal{0.0};
    Similarity referenceFromObject;
};

Place placeOf(ObjectMotions motions, int reference, const Contact& contact, const glm::dvec3& normal) {
    if (contact.object == reference)
        return {contact.point, normal, {}};
    const Similarity referenceFromObject =
        motions[static_cast<size_t>(reference)].workspaceFromObject.inverseTimes(
            motions[static_cast<size_t>(contact.object)].workspaceFromObject);
    const Similarity objectFromReference = referenceFromObject.inverse();
    return {objectFromReference.point(contact.point), objectFromReference.direction(normal),
            referenceFromObject};
}

/// What a dent takes part with at a place.
struct Reach {
    double share = 0.0;    // phi
    glm::dvec3 slope{0.0}; // gradient of phi, 1/m (workspace), object axes
};

Reach reachOf(const LocalDeformation& law, double radius, double scale, const glm::dvec3& centre,
              const glm::dvec3& outwards, const Place& at) {
    const double facing = std::clamp(glm::dot(outwards, at.normal) / kTurned, 0.0, 1.0);
    const glm::dvec3 away = scale * (at.point - centre);
    const double distance = glm::length(away), s = distance / radius;
    Reach reach{facing * law.shape(s), glm::dvec3(0.0)};
    if (distance > 0.0)
        reach.slope = (facing * law.slope(s) / (radius * distance)) * away;
    return reach;
}

/// The dent for a new contact: a free one, else the shallowest.
size_t freeDent(const Dents& dents, uint32_t pressed) {
    size_t found = 0;
    double least = std::numeric_limits<double>::infinity();
    for (size_t i = 0; i < Dents::kMax; ++i)
        if ((pressed >> i & 1U) == 0 && dents.depth[i] < least) {
            least = dents.depth[i];
            found = i;
        }
    return found;
}

/// Each dent's implicit step, with the others where they are: d and N satisfy both
/// (tau + dt) d = tau d_0 + dt phi N / k' and N = k (below - phi d), or N is a bound and d follows. Returns
/// by how much the surface is lowered.
double stepDents(const LocalDeformation& law, double radius, const std::array<Reach, Dents::kMax>& reaches,
                 const SurfaceSample& feel, DentPress& press) {
    Dents& dents = press.dents;
    const double ground = std::isnan(law.stiffness) ? feel.stiffness : law.stiffness, dt = press.dt;
    double lowered = 0.0;
    for (size_t i = 0; i < Dents::kMax; ++i)
        lowered += dents.depth[i] * reaches[i].share;
    for (size_t i = 0; i < Dents::kMax; ++i) {
        const double share = reaches[i].share;
        if (!(share > 0.0) || (press.pressed >> i & 1U) != 0)
            continue;
        press.pressed |= 1U << i;
        double& depth = dents.depth[i];
        lowered -= depth * share;
        const double below = feel.depth - lowered, had = law.time * depth, step = law.time + dt;
        const double pressing = (had + dt * share * feel.stiffness * below / ground) /
                                (step + dt * share * share * feel.stiffness / ground);
        const double load = std::clamp(feel.stiffness * (below - share * pressing), 0.0, press.maxForce);
        depth = std::min((had + dt * share * load / ground) / step, radius);
        lowered += depth * share;
    }
    return lowered;
}

} // namespace

void pressDents(const HapticScene& scene, ObjectMotions motions, int reference, const Contact& contact,
                double speed, DentPress& press, SurfaceSample& feel) noexcept {
    const auto k = static_cast<size_t>(contact.object);
    const LocalDeformation& law = scene.materials[static_cast<size_t>(feel.material)].deformation;
    // What has no stiffness here (a map, or vertices, may say 0) has no load that could press it in.
    if (!law.on() || !(feel.stiffness > 0.0))
        return;
    Dents& dents = press.dents;
    const double radius = law.radius * scene.workspaceFromScene.scale, dt = press.dt;
    const double scale = motions[k].workspaceFromObject.scale;
    const Place at = placeOf(motions, reference, contact, feel.normal);

    std::array<Reach, Dents::kMax> reaches;
    size_t nearest = Dents::kMax;
    for (size_t i = 0; i < Dents::kMax; ++i) {
        if (dents.depth[i] == 0.0 || dents.object[i] != contact.object)
            continue;
        reaches[i] = reachOf(law, radius, scale, dents.centre[i], dents.normal[i], at);
        if (reaches[i].share > 0.0 && (nearest == Dents::kMax || reaches[i].share > reaches[nearest].share))
            nearest = i;
    }
    if (nearest == Dents::kMax) {
        nearest = freeDent(dents, press.pressed);
        dents.object[nearest] = contact.object;
        dents.centre[nearest] = at.point;
        dents.normal[nearest] = at.normal;
        dents.depth[nearest] = 0.0;
        reaches[nearest] = {1.0, glm::dvec3(0.0)};
    } else if ((press.pressed >> nearest & 1U) == 0) {
        const double rate = std::max(law.time > 0.0 ? dt / law.time : std::numeric_limits<double>::infinity(),
                                     speed * dt / (kLag * radius));
        const double part = std::isinf(rate) ? 1.0 : rate / (1.0 + rate);
        dents.centre[nearest] += part * (at.point - dents.centre[nearest]);
        const glm::dvec3 turned = glm::mix(dents.normal[nearest], at.normal, part);
        const double length = glm::length(turned);
        dents.normal[nearest] = length > 0.0 ? turned / length : at.normal;
        reaches[nearest] = reachOf(law, radius, scale, dents.centre[nearest], dents.normal[nearest], at);
    }

    const double lowered = stepDents(law, radius, reaches, feel, press);
    glm::dvec3 slope(0.0);
    for (size_t i = 0; i < Dents::kMax; ++i)
        slope += dents.depth[i] * reaches[i].slope;
    slope -= glm::dot(slope, at.normal) * at.normal;
    feel.dent = std::min(std::max(lowered, 0.0), feel.depth);
    feel.depth -= feel.dent;
    feel.dentSlope = contact.object == reference ? slope : at.referenceFromObject.direction(slope);
    press.shift -=
        feel.dent * motions[static_cast<size_t>(reference)].workspaceFromObject.direction(feel.normal);
}

void relaxDents(const HapticScene& scene, double dt, uint32_t pressed, Dents& dents) noexcept {
    for (size_t i = 0; i < Dents::kMax; ++i) {
        double& depth = dents.depth[i];
        if (depth == 0.0 || (pressed >> i & 1U) != 0)
            continue;
        const auto object = static_cast<size_t>(dents.object[i]);
        const double time =
            dents.object[i] >= 0 && object < scene.objects.size()
                ? scene.materials[static_cast<size_t>(scene.objects[object]->material)].deformation.time
                : 0.0;
        depth *= time / (time + dt);
        if (!(depth > kShallow))
            depth = 0.0;
    }
}

} // namespace touchstone
