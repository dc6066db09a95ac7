#include "study/truth/truth_path.h"

#include "haptics/scene/haptic_scene.h"
#include "study/truth/oracle.h"

#include <algorithm>

namespace touchstone::truth {

RestPath smoothPath(const SmoothShape& shape, std::span<const glm::dvec3> hips, double radius) {
    RestPath path;
    LVec3 last = hips.empty() ? LVec3(0.0L) : LVec3(hips[0]);
    for (const glm::dvec3& hip : hips) {
        const SmoothRest rest = shape.rest(LVec3(hip), static_cast<long double>(radius), last);
        last = rest.proxy;
        path.proxies.emplace_back(rest.proxy);
        path.normals.emplace_back(rest.normal);
        path.failed.push_back(false);
    }
    return path;
}

RestPath oraclePath(const HapticScene& scene, int frame, std::span<const glm::dvec3> hips, double radius,
                    size_t work) {
    RestPath path;
    const Soup soup(scene, frame);
    const HapticObject& object = *scene.objects[static_cast<size_t>(frame)];
    const LSimilarity workspaceFromObject(object.workspaceFromObject);
    // Features below the welding tolerance are ignored, as by the solver's point.
    const long double reach = std::max(static_cast<long double>(radius) / workspaceFromObject.scale,
                                       static_cast<long double>(0.5 * kWeldTolerance * object.diagonal));
    LVec3 at = hips.empty() ? LVec3(0.0L) : workspaceFromObject.inversePoint(LVec3(hips[0]));
    for (const glm::dvec3& hip : hips) {
        const LVec3 goal = workspaceFromObject.inversePoint(LVec3(hip));
        const size_t near = 1 + soup.near(goal, glm::length(goal - at) + reach).size();
        if (work < near) {
            path.proxies.push_back(hip);
            path.normals.emplace_back(0.0);
            path.failed.push_back(true);
            continue;
        }
        const int most = static_cast<int>(std::min(work / near, static_cast<size_t>(kOracleMoves)));
        const OracleRest rest = oracleRest(soup, at, goal, reach, most);
        work -= std::min(work, near * (static_cast<size_t>(rest.moves) + 1));
        at = rest.proxy;
        const LVec3 proxy = workspaceFromObject.point(at);
        path.proxies.emplace_back(proxy);
        // At rest, the displacement to the HIP is a combination of the inward normals; a contact without load
        // contributes one.
        const LVec3 way = proxy - LVec3(hip);
        const bool loaded = glm::length(way) > 1e-12L * static_cast<long double>(object.diagonal);
        path.normals.emplace_back(rest.touching.empty() ? LVec3(0.0L)
                                  : loaded              ? glm::normalize(way)
                                                        : workspaceFromObject.rotation * rest.touching[0]);
        path.failed.push_back(!rest.settled);
    }
    return path;
}

std::vector<FeltTick> springForces(const RestPath& path, std::span<const glm::dvec3> hips, double stiffness,
                                   double friction) {
    std::vector<FeltTick> ticks(hips.size());
    for (size_t i = 0; i < hips.size(); ++i) {
        FeltTick& tick = ticks[i];
        tick.failed = path.failed[i];
        tick.proxy = path.proxies[i];
        tick.contact = path.normals[i] != glm::dvec3(0.0);
        if (!tick.contact)
            continue;
        const glm::dvec3 pull = tick.proxy - hips[i];
        glm::dvec3 held(0.0);
        if (friction > 0.0 && i > 0) {
            glm::dvec3 way = path.proxies[i] - path.proxies[i - 1];
            way -= glm::dot(way, path.normals[i]) * path.normals[i];
            const double length = glm::length(way);
            if (length > 0.0)
                held = -friction * glm::length(pull) / length * way;
        }
        tick.proxy += held;
        tick.force = stiffness * (pull + held);
    }
    return ticks;
}

std::vector<FeltTick> reliefForces(const RestPath& path, std::span<const glm::dvec3> hips, double radius,
                                   double stiffness, const Bump& bump) {
    std::vector<FeltTick> ticks = springForces(path, hips, stiffness, 0.0);
    for (size_t i = 0; i < hips.size(); ++i) {
        if (!ticks[i].contact)
            continue;
        const glm::dvec3& n = path.normals[i];
        const BumpAt at = bump(path.proxies[i] - radius * n);
        const glm::dvec3 m = glm::normalize(n - at.slope + glm::dot(at.slope, n) * n);
        const double depth = glm::length(path.proxies[i] - hips[i]);
        ticks[i].force =
            stiffness * (depth >= at.height ? (depth - at.height) * n + at.height * m : depth * m);
    }
    return ticks;
}

} // namespace touchstone::truth
