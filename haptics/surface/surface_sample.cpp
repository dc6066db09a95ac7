#include "haptics/surface/surface_sample.h"

#include "haptics/shading/force_shading.h"
#include "haptics/surface/plain_sample.h"
#include "haptics/texture/bump.h"
#include "haptics/texture/bump_height.h"
#include "haptics/texture/surface_spot.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// 87 degrees: the steepest slope that Minsky's force climbs.
constexpr double kMinCosine = 0.05;

/// The touched place at `point`, on a mesh in the touched triangle; both in the object's frame.
SurfaceSpot spotOf(const HapticObject& object, const HapticMaterialData& material, uint32_t triangle,
                   const glm::dvec3& point, const glm::dvec3& towardsProxy) {
    SurfaceSpot spot{object, material, {}};
    if (object.shape != nullptr) { // no attributes, no coordinates: the material alone defines the surface
        spot.normal = towardsProxy;
        return spot;
    }
    spot.triangle = triangleOf(object, triangle);
    spot.first = 3 * static_cast<size_t>(triangle);
    spot.weight = barycentric(spot.triangle, point);
    spot.backside = glm::dot(spot.triangle.normal, towardsProxy) < 0.0;
    spot.normal = spot.backside ? -towardsProxy : towardsProxy;
    for (int set = 0; set < 2; ++set)
        if (spot.hasUv(set))
            for (int corner = 0; corner < 3; ++corner)
                spot.uv[static_cast<size_t>(set)] +=
                    spot.weight[corner] * spot.uvAt(set, static_cast<size_t>(corner));
    return spot;
}

/// The bump height with Blinn's normal, and what the bump map adds to the depth. Out of line: the others read
/// it as they did.
[[gnu::noinline]] Bump readBumped(const SurfaceSpot& spot, SpotMaps& maps, const HapticSettings& settings,
                                  double& bump) {
    HapticSettings blinn = settings;
    blinn.texture = TextureMode::Blinn;
    bump = readBumpEntry(spot, maps, settings);
    return readBump(spot, maps, blinn);
}

/// `share`: the map's factor; `stated`: the static coefficient of the material or the vertices.
void readFriction(const HapticObject& object, const HapticMaterialData& material,
                  const HapticSettings& settings, double share, double stated, SurfaceSample& feel) {
    // A vertex attribute is the static coefficient; the dynamic one keeps its ratio to it.
    const double ratio =
        material.staticFriction > 0.0 ? material.dynamicFriction / material.staticFriction : 1.0;
    feel.staticFriction = share * (settings.staticFriction >= 0.0 ? settings.staticFriction : stated);
    feel.dynamicFriction =
        share * (settings.dynamicFriction >= 0.0 ? settings.dynamicFriction : stated * ratio);
    feel.dynamicFriction = std::min(feel.dynamicFriction, feel.staticFriction);
    feel.viscousFriction = material.viscousFriction;
    feel.coulomb = settings.staticFriction >= 0.0 ? settings.staticFriction > 0.0
                                                  : material.staticFriction > 0.0 || !object.friction.empty();
}

} // namespace

SurfaceSample readSurface(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                          const DeviceLimits& limits, int reference, const Contact& contact,
                          const glm::dvec3& normal, double depth, double speed, double dt) noexcept {
    SurfaceSample feel;
    const auto k = static_cast<size_t>(contact.object);
    const HapticObject& object = *scene.objects[k];
    const HapticMaterialData& material = scene.materials[static_cast<size_t>(object.material)];
    plainSample(scene, settings, limits, contact, normal, depth, feel);

    const Similarity& workspaceFromObject = motions[k].workspaceFromObject;
    Similarity referenceFromObject;
    glm::dvec3 point = contact.point, towardsProxy = normal;
    const bool foreign = contact.object != reference;
    if (foreign) {
        referenceFromObject =
            motions[static_cast<size_t>(reference)].workspaceFromObject.inverseTimes(workspaceFromObject);
        const Similarity objectFromReference = referenceFromObject.inverse();
        point = objectFromReference.point(point);
        towardsProxy = objectFromReference.direction(towardsProxy);
    }
    SurfaceSpot spot = spotOf(object, material, contact.feature, point, towardsProxy);
    spot.smooth = shadingMode(settings, material) != ShadingMode::Off;
    spot.workspacePerObject = workspaceFromObject.scale;
    if (settings.textureGradient == TextureGradient::Precomputed && scene.slopes() != nullptr)
        spot.slopes = &(*scene.slopes())[static_cast<size_t>(object.material)];
    spot.modelPerObject = workspaceFromObject.scale / scene.workspaceFromScene.scale;

    SpotMaps maps(spot, settings.textureFilter, settings.textureGradient, speed * dt);
    const auto factor = [&](const HapticFactor& f) {
        if (f.map.empty() || !spot.hasUv(f.map.layout().texCoord))
            return 1.0;
        return f.min + (f.max - f.min) * maps.scalar(f.map);
    };
    const double stiffness = specifiedStiffness(material, settings, limits);
    feel.stiffness =
        bornStiffness((settings.stiffness > 0.0 ? stiffness : spot.attribute(object.stiffness, stiffness)) *
                          factor(material.stiffnessMap),
                      settings, limits);
    feel.damping = (settings.damping >= 0.0 ? feel.damping : spot.attribute(object.damping, feel.damping)) *
                   factor(material.dampingMap);
    if (settings.friction != FrictionMode::Off)
        readFriction(object, material, settings, factor(material.friction),
                     spot.attribute(object.friction, material.staticFriction), feel);
    if (settings.texture != TextureMode::Off && (material.textured() || !object.heights.empty())) {
        const Bump bump = settings.texture == TextureMode::BlinnMagnitude
                              ? readBumped(spot, maps, settings, feel.bump)
                              : readBump(spot, maps, settings);
        feel.height = bump.height;
        feel.hasHeight = bump.hasHeight && settings.texture == TextureMode::Law;
        feel.tiltCompressed = bump.tiltCompressed;
        if (settings.texture == TextureMode::Minsky)
            feel.lengthening = 1.0 / std::max(glm::dot(bump.normal, spot.normal), kMinCosine);
        const glm::dvec3 m = spot.backside ? -bump.normal : bump.normal; // the same surface from below
        feel.textured = foreign ? referenceFromObject.direction(m) : m;
    }
    return feel;
}

} // namespace touchstone
