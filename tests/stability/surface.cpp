#include "tests/stability/surface.h"

#include "haptics/shape/mesh/triangle.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <set>

namespace touchstone::test {

namespace {

glm::dvec3 corner(const HapticObject& object, size_t triangle, size_t k) {
    return glm::dvec3(object.vertices[object.indices[3 * triangle + k]]);
}

Corners cornersOf(const HapticObject& object, size_t triangle) {
    return {LVec3(corner(object, triangle, 0)), LVec3(corner(object, triangle, 1)),
            LVec3(corner(object, triangle, 2))};
}

/// Shares 0..1 along the segments a0 a1 and b0 b1 where they are nearest to each other.
void nearestShares(const glm::dvec3& a0, const glm::dvec3& a1, const glm::dvec3& b0, const glm::dvec3& b1,
                   double& s, double& t) {
    const glm::dvec3 u = a1 - a0, v = b1 - b0, w = a0 - b0;
    const double uu = glm::dot(u, u), uv = glm::dot(u, v), vv = glm::dot(v, v), uw = glm::dot(u, w),
                 vw = glm::dot(v, w);
    const double determinant = uu * vv - uv * uv;
    s = determinant > 1e-30 ? std::clamp((uv * vw - vv * uw) / determinant, 0.0, 1.0) : 0.0;
    t = vv > 0.0 ? std::clamp((vw + s * uv) / vv, 0.0, 1.0) : 0.0;
    s = uu > 0.0 ? std::clamp((t * uv - uw) / uu, 0.0, 1.0) : 0.0;
}

} // namespace

double angleBetween(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b));
}

double largestAngle(const std::vector<glm::dvec3>& a, const std::vector<glm::dvec3>& b) {
    if (a.empty() != b.empty())
        return std::numbers::pi;
    double largest = 0.0;
    for (const glm::dvec3& x : a)
        for (const glm::dvec3& y : b)
            largest = std::max(largest, angleBetween(x, y));
    return largest;
}

double Touching::tilt() const {
    double largest = 0.0;
    for (size_t i = 0; i < normals.size(); ++i)
        if (felt[i] != normals[i])
            largest = std::max(largest, angleBetween(normals[i], felt[i]));
    return largest;
}

Surface::Surface(const HapticScene& scene, double shaded) : scene_(scene), tiltLimit_(shaded) {
    for (const auto& object : scene.objects) {
        std::vector<Ball> balls(object->triangleCount());
        for (size_t t = 0; t < balls.size(); ++t) {
            const glm::dvec3 a = corner(*object, t, 0), b = corner(*object, t, 1), c = corner(*object, t, 2);
            balls[t].centre = (a + b + c) / 3.0;
            balls[t].radius = std::max({glm::distance(a, balls[t].centre), glm::distance(b, balls[t].centre),
                                        glm::distance(c, balls[t].centre)}) *
                              (1.0 + 1e-12);
        }
        balls_.push_back(std::move(balls));
    }
}

glm::dvec3 Surface::feltNormal(size_t k, size_t t, const glm::dvec3& closest,
                               const glm::dvec3& normal) const {
    const HapticObject& object = *scene_.objects[k];
    if (tiltLimit_ <= 0.0 || object.smooth[t] == 0)
        return normal;
    const Triangle triangle(corner(object, t, 0), corner(object, t, 1), corner(object, t, 2));
    const glm::dvec3 weight = barycentric(triangle, closest);
    glm::dvec3 felt(0.0);
    for (int i = 0; i < 3; ++i)
        felt += weight[i] * glm::dvec3(object.normals[object.sourceIndices[3 * t + static_cast<size_t>(i)]]);
    if (!(glm::length(felt) > 1e-6))
        return normal;
    felt = glm::normalize(felt);
    if (glm::dot(felt, normal) < 0.0)
        felt = -felt;
    if (angleBetween(felt, normal) <= tiltLimit_)
        return felt;
    const glm::dvec3 sideways = felt - glm::dot(felt, normal) * normal;
    return glm::length(sideways) > 0.0
               ? std::cos(tiltLimit_) * normal + std::sin(tiltLimit_) * glm::normalize(sideways)
               : normal;
}

bool Surface::isBeyond(size_t k, size_t t, const glm::dvec3& at, double reach) const {
    const glm::dvec3 away = at - balls_[k][t].centre;
    const double outer = balls_[k][t].radius + reach;
    return glm::dot(away, away) > outer * outer;
}

Touching Surface::touching(ObjectMotions motions, const glm::dvec3& p, double reach) const {
    Touching result;
    for (size_t k = 0; k < balls_.size(); ++k) {
        const HapticObject& object = *scene_.objects[k];
        const Similarity& pose = motions[k].workspaceFromObject;
        const glm::dvec3 at = pose.inverse().point(p);
        const double limit = reach / pose.scale;
        for (size_t t = 0; t < balls_[k].size(); ++t) {
            if (isBeyond(k, t, at, limit))
                continue;
            const BruteContact contact = distanceFrom(cornersOf(object, t), LVec3(at));
            const auto distance = static_cast<double>(contact.distance);
            if (distance > limit)
                continue;
            result.nearest = std::min(result.nearest, distance * pose.scale);
            const glm::dvec3 normal(contact.normal);
            result.triangles.push_back(static_cast<uint64_t>(k) << 32 | t);
            result.normals.push_back(pose.direction(normal));
            result.felt.push_back(pose.direction(feltNormal(k, t, at - distance * normal, normal)));
        }
    }
    return result;
}

double Surface::freeSector(size_t k, const std::vector<size_t>& near, const glm::dvec3& at,
                           const glm::dvec3& along, const glm::dvec3& seenFrom, double gap) const {
    const HapticObject& object = *scene_.objects[k];
    // Angles round the edge, from the direction in which the proxy stands.
    glm::dvec3 zero = seenFrom - at;
    zero -= glm::dot(zero, along) * along;
    if (!(glm::length(zero) > 0.0))
        return 2.0 * std::numbers::pi;
    zero = glm::normalize(zero);
    const glm::dvec3 quarter = glm::cross(along, zero);
    double left = INFINITY, right = INFINITY;
    for (const size_t t : near) {
        if (isBeyond(k, t, at, gap))
            continue;
        const BruteContact contact = distanceFrom(cornersOf(object, t), LVec3(at));
        if (static_cast<double>(contact.distance) > gap)
            continue;
        // In the triangle's plane, from the edge to its farthest corner, and to the farthest on the other
        // side where the edge lies across the triangle.
        std::array<glm::dvec3, 3> across;
        for (size_t c = 0; c < 3; ++c) {
            across[c] = corner(object, t, c) - at;
            across[c] -= glm::dot(across[c], along) * along;
        }
        std::sort(across.begin(), across.end(),
                  [](const glm::dvec3& u, const glm::dvec3& v) { return glm::length(u) > glm::length(v); });
        for (const glm::dvec3& into : across) {
            if (!(glm::length(into) > gap) ||
                (into != across[0] && glm::dot(into, across[0]) > -gap * glm::length(across[0])))
                continue;
            double angle = std::atan2(glm::dot(into, quarter), glm::dot(into, zero));
            angle += angle < 0.0 ? 2.0 * std::numbers::pi : 0.0;
            left = std::min(left, angle);
            right = std::min(right, 2.0 * std::numbers::pi - angle);
        }
    }
    return left == INFINITY ? 0.0 : left + right;
}

/// rad, what a ball that bridges gaps up to `gap`, its diameter, turns by where the surface goes on from an
/// open edge only at some distance: over a step of height h by acos(1 - h / r).
double Surface::stepAt(size_t k, const std::vector<size_t>& near, std::pair<uint32_t, uint32_t> edge,
                       const glm::dvec3& at, double gap) const {
    const HapticObject& object = *scene_.objects[k];
    int sharing = 0;
    double nearest = INFINITY;
    for (const size_t t : near) {
        const uint32_t* i = &object.indices[3 * t];
        const bool has0 = i[0] == edge.first || i[1] == edge.first || i[2] == edge.first,
                   has1 = i[0] == edge.second || i[1] == edge.second || i[2] == edge.second;
        if (has0 && has1)
            ++sharing;
        else if (!isBeyond(k, t, at, gap))
            nearest = std::min(nearest,
                               static_cast<double>(distanceFrom(cornersOf(object, t), LVec3(at)).distance));
    }
    return sharing > 1 || nearest > gap ? 0.0 : std::acos(1.0 - std::min(2.0 * nearest / gap, 1.0));
}

double Surface::turnAlong(ObjectMotions motions, const glm::dvec3& p, const glm::dvec3& q, double reach,
                          double gap) const {
    double sum = 0.0;
    for (const double turn : edgesAlong(motions, p, q, reach, gap, std::numbers::pi))
        sum += std::max(turn, 0.0);
    return std::min(sum, std::numbers::pi);
}

std::vector<double> Surface::edgesAlong(ObjectMotions motions, const glm::dvec3& p, const glm::dvec3& q,
                                        double reach, double gap, double enough) const {
    std::vector<double> turns;
    double convex = 0.0;
    for (size_t k = 0; k < balls_.size(); ++k) {
        const HapticObject& object = *scene_.objects[k];
        const Similarity& pose = motions[k].workspaceFromObject;
        const Similarity back = pose.inverse();
        const glm::dvec3 from = back.point(p), to = back.point(q);
        const double limit = reach / pose.scale, close = gap / pose.scale;
        const glm::dvec3 middle = 0.5 * (from + to);
        const double half = 0.5 * glm::distance(from, to);
        std::vector<size_t> near;
        for (size_t t = 0; t < balls_[k].size(); ++t)
            if (glm::distance(balls_[k][t].centre, middle) <=
                balls_[k][t].radius + half + limit + 2.0 * close)
                near.push_back(t);
        std::set<std::pair<uint32_t, uint32_t>> done;
        for (const size_t t : near)
            for (size_t c = 0; c < 3; ++c) {
                const uint32_t i0 = object.indices[3 * t + c], i1 = object.indices[3 * t + (c + 1) % 3];
                if (i0 == i1 || !done.insert(std::minmax(i0, i1)).second)
                    continue;
                const glm::dvec3 a(object.vertices[i0]), b(object.vertices[i1]);
                double s = 0.0, share = 0.0;
                nearestShares(from, to, a, b, s, share);
                const glm::dvec3 onWay = from + s * (to - from);
                if (glm::distance(onWay, a + share * (b - a)) > limit)
                    continue;
                // Off the ends, where other edges' triangles come in.
                const double length = glm::distance(a, b);
                const double off = std::min(0.5, 4.0 * close / length + 1e-3);
                const glm::dvec3 at = a + std::clamp(share, off, 1.0 - off) * (b - a);
                const glm::dvec3 along = (b - a) / length;
                const double one = freeSector(k, near, at, along, from, close),
                             other = freeSector(k, near, at, along, to, close);
                turns.push_back(std::max(one, other) - std::numbers::pi +
                                stepAt(k, near, {i0, i1}, at, close));
                convex += std::max(turns.back(), 0.0);
                if (convex >= enough)
                    return turns;
            }
    }
    return turns;
}

} // namespace touchstone::test
