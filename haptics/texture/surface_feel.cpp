#include "haptics/texture/surface_feel.h"

#include "haptics/contact/triangle.h"

#include <algorithm>
#include <cmath>

namespace touchstone {

namespace {

/// The touched triangle with its contact point, in the frame of its own object.
struct Spot {
    const HapticObject& object;
    const HapticMaterialData& material;
    size_t first;              ///< index of the triangle's first corner
    glm::dvec3 weight;         ///< barycentric
    glm::dvec3 normal;         ///< felt shape's normal on the outer side, object frame
    double workspacePerObject; ///< scale
    double modelPerObject;     ///< metres of the model in one object unit

    [[nodiscard]] double attribute(const std::vector<float>& values, double otherwise) const {
        if (values.empty())
            return otherwise;
        double sum = 0.0;
        for (int k = 0; k < 3; ++k)
            sum +=
                weight[k] * static_cast<double>(values[object.sourceIndices[first + static_cast<size_t>(k)]]);
        return sum;
    }
    [[nodiscard]] bool hasUv(int set) const { return !object.uv[set & 1].empty(); }
    [[nodiscard]] glm::dvec2 uv(int set) const {
        const auto& values = object.uv[set & 1];
        glm::dvec2 sum(0.0);
        for (int k = 0; k < 3; ++k)
            sum += weight[k] * glm::dvec2(values[object.sourceIndices[first + static_cast<size_t>(k)]]);
        return sum;
    }
    [[nodiscard]] double factor(const HapticFactor& f, double level) const {
        if (f.map.empty() || !hasUv(f.map.texCoord()))
            return 1.0;
        return f.min + (f.max - f.min) * f.map.scalar(f.map.transform(uv(f.map.texCoord())), level);
    }
};

/// How positions move with uv on the triangle: d(position)/du and /dv in the object frame. False where the uv
/// are degenerate.
bool uvTangents(const Spot& spot, int set, glm::dvec3& alongU, glm::dvec3& alongV) {
    const HapticObject& o = spot.object;
    const glm::dvec3 a(o.vertices[o.indices[spot.first]]), b(o.vertices[o.indices[spot.first + 1]]),
        c(o.vertices[o.indices[spot.first + 2]]);
    const auto& values = o.uv[set & 1];
    const glm::dvec2 ua(values[o.sourceIndices[spot.first]]), ub(values[o.sourceIndices[spot.first + 1]]),
        uc(values[o.sourceIndices[spot.first + 2]]);
    const glm::dvec2 e1 = ub - ua, e2 = uc - ua;
    const double det = e1.x * e2.y - e1.y * e2.x;
    if (!(std::abs(det) > 1e-24))
        return false;
    alongU = (e2.y * (b - a) - e1.y * (c - a)) / det;
    alongV = (e1.x * (c - a) - e2.x * (b - a)) / det;
    return true;
}

/// Mip level at which one texel is at least two strokes long: at that spacing the servo still samples every
/// feature twice (Nyquist).
double levelForStroke(const Spot& spot, const HapticMap& map, double speed, double dt) {
    glm::dvec3 alongU, alongV;
    if (!spot.hasUv(map.texCoord()) || !uvTangents(spot, map.texCoord(), alongU, alongV))
        return 0.0;
    const glm::dmat2& j = map.transformJacobian();
    const double du = glm::length(alongU) / std::max(glm::length(j[0]), 1e-12) / map.size().x;
    const double dv = glm::length(alongV) / std::max(glm::length(j[1]), 1e-12) / map.size().y;
    const double texel = std::min(du, dv) * spot.workspacePerObject;
    const double strokes = 2.0 * speed * dt;
    return texel > 0.0 && strokes > texel ? std::log2(strokes / texel) : 0.0;
}

/// Unit normal of the core normal map, object frame; the felt normal where there is no tangent frame.
glm::dvec3 normalFromMap(const Spot& spot, double level) {
    const HapticMap& map = spot.material.normal;
    if (!spot.hasUv(map.texCoord()))
        return spot.normal;
    glm::dvec3 local = 2.0 * map.vector(map.transform(spot.uv(map.texCoord())), level) - 1.0;
    local.x *= spot.material.normalScale;
    local.y *= spot.material.normalScale;
    glm::dvec3 tangent(0.0);
    double sign = 1.0;
    if (!spot.object.tangents.empty()) {
        for (int k = 0; k < 3; ++k) {
            const glm::vec4& t =
                spot.object.tangents[spot.object.sourceIndices[spot.first + static_cast<size_t>(k)]];
            tangent += spot.weight[k] * glm::dvec3(t.x, t.y, t.z);
            sign = static_cast<double>(t.w);
        }
    } else {
        glm::dvec3 alongV;
        if (!uvTangents(spot, map.texCoord(), tangent, alongV))
            return spot.normal;
        sign = glm::dot(glm::cross(spot.normal, tangent), alongV) < 0.0 ? -1.0 : 1.0;
    }
    tangent -= glm::dot(tangent, spot.normal) * spot.normal;
    const double length = glm::length(tangent);
    if (!(length > 1e-12))
        return spot.normal;
    tangent /= length;
    const glm::dvec3 bitangent = sign * glm::cross(spot.normal, tangent);
    const glm::dvec3 normal = local.x * tangent + local.y * bitangent + local.z * spot.normal;
    const double size = glm::length(normal);
    return size > 1e-9 ? normal / size : spot.normal;
}

/// m = normalize(n - grad H + (grad H . n) n) [000], with grad H from the uv gradient in the surface.
glm::dvec3 normalFromHeight(const Spot& spot, double strength, double level) {
    const HapticMap& map = spot.material.height;
    glm::dvec3 alongU, alongV;
    if (!spot.hasUv(map.texCoord()) || !uvTangents(spot, map.texCoord(), alongU, alongV))
        return spot.normal;
    const glm::dvec2 overMap = map.gradient(map.transform(spot.uv(map.texCoord())), level);
    const glm::dvec2 overUv = glm::transpose(map.transformJacobian()) * overMap; // chain rule
    // The surface gradient g satisfies g.alongU = dH/du, g.alongV = dH/dv within the facet.
    const double uu = glm::dot(alongU, alongU), uv = glm::dot(alongU, alongV), vv = glm::dot(alongV, alongV);
    const double det = uu * vv - uv * uv;
    if (!(det > 0.0))
        return spot.normal;
    const double scale =
        strength * spot.material.heightScale / spot.modelPerObject; // object units per map unit
    const glm::dvec3 gradient = scale * ((vv * overUv.x - uv * overUv.y) / det * alongU +
                                         (uu * overUv.y - uv * overUv.x) / det * alongV);
    return glm::normalize(spot.normal - gradient + glm::dot(gradient, spot.normal) * spot.normal);
}

/// Compresses the angle between m and n smoothly below `limit`: a / (1 + (a/limit)^4)^(1/4) keeps small tilts
/// to fourth order and never reaches the limit, so no shape is cut flat.
glm::dvec3 compressTilt(const glm::dvec3& n, const glm::dvec3& m, double limit, bool& compressed) {
    constexpr double kNoLimit = 1.5707963267948966;
    if (limit >= kNoLimit)
        return m;
    const double cosine = std::clamp(glm::dot(n, m), -1.0, 1.0);
    const glm::dvec3 sideways = m - cosine * n;
    const double sine = glm::length(sideways);
    if (!(sine > 0.0) || !(limit > 0.0))
        return limit > 0.0 ? m : n;
    const double angle = std::atan2(sine, cosine);
    compressed = angle > limit;
    const double ratio = angle / limit;
    const double kept = angle / std::sqrt(std::sqrt(1.0 + ratio * ratio * ratio * ratio));
    return std::cos(kept) * n + std::sin(kept) / sine * sideways;
}

void readTexture(const Spot& spot, const HapticSettings& settings, double speed, double dt, bool backside,
                 SurfaceFeel& feel, glm::dvec3& m) {
    const HapticMaterialData& material = spot.material;
    if (!material.height.empty() && material.heightScale != 0.0 && spot.hasUv(material.height.texCoord())) {
        const double level = levelForStroke(spot, material.height, speed, dt);
        const double raw =
            material.height.scalar(material.height.transform(spot.uv(material.height.texCoord())), level);
        // Shifted so that the least height is 0; a bump is a dent from the back.
        const bool risesWithRaw = (material.heightScale > 0.0) != backside;
        const double least =
            static_cast<double>(risesWithRaw ? material.height.least() : material.height.greatest());
        const double workspacePerModel = spot.workspacePerObject / spot.modelPerObject;
        feel.hasHeight = true;
        feel.height =
            settings.textureStrength * std::abs((raw - least) * material.heightScale) * workspacePerModel;
        if (material.normal.empty())
            m = normalFromHeight(spot, settings.textureStrength, level);
    }
    if (!material.normal.empty()) {
        m = normalFromMap(spot, levelForStroke(spot, material.normal, speed, dt));
        m = glm::normalize(spot.normal + settings.textureStrength *
                                             (m / std::max(glm::dot(m, spot.normal), 0.05) - spot.normal));
    }
}

} // namespace

SurfaceFeel readSurface(const HapticScene& scene, ObjectMotions motions, const HapticSettings& settings,
                        int anchor, const ProxyRest& rest, const glm::dvec3& normal, double depth,
                        double speed, double dt) noexcept {
    SurfaceFeel feel;
    if (rest.contactCount == 0)
        return feel;
    uint32_t primary = 0;
    double most = -1.0;
    for (int i = 0; i < rest.hold.count; ++i)
        if (rest.hold.multiplier[static_cast<size_t>(i)] > most) {
            most = rest.hold.multiplier[static_cast<size_t>(i)];
            primary = static_cast<uint32_t>(rest.hold.active[static_cast<size_t>(i)]);
        }
    const Contact& contact = rest.contacts[primary];
    const auto k = static_cast<size_t>(contact.object);
    const HapticObject& object = *scene.objects[k];
    const HapticMaterialData& material = scene.materials[static_cast<size_t>(object.material)];
    feel.touching = true;
    feel.object = contact.object;
    feel.triangle = contact.triangle;
    feel.material = object.material;
    feel.normal = feel.textured = normal;
    feel.depth = depth;

    const Similarity& workspaceFromObject = motions[k].workspaceFromObject;
    Similarity anchorFromObject;
    const bool foreign = contact.object != anchor;
    if (foreign)
        anchorFromObject =
            motions[static_cast<size_t>(anchor)].workspaceFromObject.inverseTimes(workspaceFromObject);
    const Similarity objectFromAnchor = anchorFromObject.inverse();
    const size_t first = 3 * static_cast<size_t>(contact.triangle);
    const Triangle triangle = triangleOf(object, contact.triangle);
    const glm::dvec3 towardsProxy = foreign ? objectFromAnchor.direction(normal) : normal;
    const bool backside = glm::dot(triangle.normal, towardsProxy) < 0.0;
    const Spot spot{
        .object = object,
        .material = material,
        .first = first,
        .weight = barycentric(triangle, foreign ? objectFromAnchor.point(contact.point) : contact.point),
        .normal = backside ? -towardsProxy : towardsProxy,
        .workspacePerObject = workspaceFromObject.scale,
        .modelPerObject = workspaceFromObject.scale / scene.workspaceFromScene.scale};

    const double given = settings.stiffness > 0.0         ? settings.stiffness
                         : std::isnan(material.stiffness) ? scene.limits.recommendedStiffness
                                                          : material.stiffness;
    feel.stiffness = (settings.stiffness > 0.0 ? given : spot.attribute(object.stiffness, given)) *
                     spot.factor(material.stiffnessMap, 0.0);
    if (!(settings.stiffness > 0.0)) // what a person asks for in so many words is not cut
        feel.stiffness = std::min(feel.stiffness, scene.limits.maxStiffness);
    const double damping = settings.damping >= 0.0        ? settings.damping
                           : std::isnan(material.damping) ? 0.0
                                                          : material.damping;
    feel.damping = (settings.damping >= 0.0 ? damping : spot.attribute(object.damping, damping)) *
                   spot.factor(material.dampingMap, 0.0);
    if (settings.friction != FrictionMode::Off) {
        // A vertex attribute is the static coefficient; the dynamic one keeps its ratio to it.
        const double factor = spot.factor(material.friction, 0.0);
        const double stated = spot.attribute(object.friction, material.staticFriction);
        const double ratio =
            material.staticFriction > 0.0 ? material.dynamicFriction / material.staticFriction : 1.0;
        feel.staticFriction = factor * (settings.staticFriction >= 0.0 ? settings.staticFriction : stated);
        feel.dynamicFriction =
            factor * (settings.dynamicFriction >= 0.0 ? settings.dynamicFriction : stated * ratio);
        feel.dynamicFriction = std::min(feel.dynamicFriction, feel.staticFriction);
        feel.viscousFriction = material.viscousFriction;
    }
    if (settings.texture == TextureMode::Law && material.textured()) {
        glm::dvec3 m = spot.normal;
        readTexture(spot, settings, speed, dt, backside, feel, m);
        m = compressTilt(spot.normal, m, settings.textureTiltLimit, feel.tiltCompressed);
        if (backside)
            m = -m; // the same displaced surface, touched from below
        feel.textured = foreign ? anchorFromObject.direction(m) : m;
    }
    return feel;
}

} // namespace touchstone
