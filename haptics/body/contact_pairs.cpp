// Contacts of two colliders: distances by GJK and EPA, and face against face by clipping. Bullet's own
// dispatcher keeps manifolds from step to step, which a replay that begins in the middle would not have; its
// building blocks keep nothing.

#include "haptics/body/bullet_colliders.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace touchstone::body {

namespace {

/// A face of which the normal is nearer than this to the direction of the distance carries a face contact.
constexpr float kFaceCosine = 0.98f;
constexpr size_t kPerPair = 4, kPerTriangle = 4, kTriangles = 8;

/// At most four points: the deepest, and those that span the widest polygon.
void reduce(std::vector<Reported::Point>& points) {
    if (points.size() <= kPerPair)
        return;
    const auto take = [&](size_t slot, auto&& measure) {
        size_t best = slot;
        btScalar most = -1e30f;
        for (size_t i = slot; i < points.size(); ++i)
            if (const btScalar value = measure(points[i]); value > most) {
                most = value;
                best = i;
            }
        std::swap(points[slot], points[best]);
    };
    take(0, [](const auto& p) { return -p.distance; });
    take(1, [&](const auto& p) { return (p.onB - points[0].onB).length2(); });
    take(2, [&](const auto& p) {
        return (p.onB - points[0].onB).cross(points[1].onB - points[0].onB).length2();
    });
    const btVector3 side = (points[1].onB - points[0].onB).cross(points[2].onB - points[0].onB);
    take(3, [&](const auto& p) {
        // The farthest outside of the triangle of the three.
        btScalar out = -1e30f;
        for (size_t i = 0; i < 3; ++i) {
            const btVector3 edge = points[(i + 1) % 3].onB - points[i].onB;
            out = std::max(out, (p.onB - points[i].onB).dot(edge.cross(side)));
        }
        return out;
    });
    points.resize(kPerPair);
}

/// The normal of the face that is nearest to `direction`, and its cosine.
struct FaceNormal {
    btVector3 normal{0, 0, 0};
    btScalar cosine = -2.0f;
};
FaceNormal nearestFace(const btConvexPolyhedron& hull, const btTransform& at, const btVector3& direction) {
    FaceNormal best;
    const btVector3 own = at.getBasis().transpose() * direction;
    for (int i = 0; i < hull.m_faces.size(); ++i) {
        const btVector3 normal(hull.m_faces[i].m_plane[0], hull.m_faces[i].m_plane[1],
                               hull.m_faces[i].m_plane[2]);
        if (const btScalar cosine = normal.dot(own); cosine > best.cosine)
            best = {normal, cosine};
    }
    best.normal = at.getBasis() * best.normal;
    return best;
}

} // namespace

void ContactFinder::Bullet::convexPair(const btConvexShape& a, const btTransform& atA,
                                       const btConvexPolyhedron* hullA, const btConvexShape& b,
                                       const btTransform& atB, const btConvexPolyhedron* hullB, bool curved,
                                       float reach, std::vector<Reported::Point>& points) const {
    btVoronoiSimplexSolver simplex;
    btGjkEpaPenetrationDepthSolver penetration;
    const auto nearest = [&](const btTransform& turnedA, Reported& reported) {
        btGjkPairDetector detector(&a, &b, &simplex, &penetration);
        btGjkPairDetector::ClosestPointInput input;
        input.m_transformA = turnedA;
        input.m_transformB = atB;
        const float most = reach + a.getMargin() + b.getMargin();
        input.m_maximumDistanceSquared = most * most;
        detector.getClosestPoints(input, reported, nullptr);
        return !reported.points.empty();
    };
    Reported closest;
    if (!nearest(atA, closest) || closest.points[0].distance > reach)
        return;
    const Reported::Point first = closest.points[0];
    if (hullA != nullptr && hullB != nullptr) {
        // Along a face's normal: the face that is nearest to the direction of the distance.
        FaceNormal ofB = nearestFace(*hullB, atB, first.normal),
                   ofA = nearestFace(*hullA, atA, -first.normal);
        if (std::max(ofA.cosine, ofB.cosine) > kFaceCosine) {
            const btVector3 normal = ofB.cosine >= ofA.cosine - 1e-3f ? ofB.normal : -ofA.normal;
            Reported clipped;
            btVertexArray one, two;
            btPolyhedralContactClipping::clipHullAgainstHull(normal, *hullA, *hullB, atA, atB, -1e3f, reach,
                                                             one, two, clipped);
            if (!clipped.points.empty()) {
                points.insert(points.end(), clipped.points.begin(), clipped.points.end());
                return;
            }
        }
    }
    points.push_back(first);
    if (!curved)
        return;
    // A cylinder on its side meets along a line: small turns find its ends.
    btVector3 u, v;
    btPlaneSpace1(first.normal, u, v);
    constexpr float kTurn = 0.01f;
    for (const btVector3& axis : {u, -u, v, -v}) {
        btTransform turnedA = atA;
        turnedA.setRotation(btQuaternion(axis, kTurn) * atA.getRotation());
        Reported other;
        if (!nearest(turnedA, other))
            continue;
        const Reported::Point& p = other.points[0];
        const btVector3 onA = p.onB + p.distance * p.normal;
        const btVector3 back = atA * (turnedA.inverse() * onA);
        const float distance = (back - p.onB).dot(first.normal);
        const bool known = std::ranges::any_of(
            points, [&](const Reported::Point& q) { return (q.onB - p.onB).length2() < 1e-4f; });
        if (distance <= reach && !known)
            points.push_back({p.onB, first.normal, distance});
    }
}

void ContactFinder::Bullet::meshPair(const Made& a, const btTransform& atA, const Made& b,
                                     const btTransform& atB, float reach,
                                     std::vector<Reported::Point>& points) const {
    struct Near : btTriangleCallback {
        std::vector<std::array<btVector3, 3>> triangles;
        void processTriangle(btVector3* corner, int, int) override {
            if (triangles.size() < 256)
                triangles.push_back({corner[0], corner[1], corner[2]});
        }
    } near;
    const btTransform bFromA = atB.inverse() * atA;
    btVector3 low, high;
    a.convex->getAabb(bFromA, low, high);
    const btVector3 margin(reach, reach, reach);
    static_cast<const btBvhTriangleMeshShape*>(b.shape.get())
        ->processAllTriangles(&near, low - margin, high + margin);
    std::vector<Reported::Point> all;
    for (const auto& corners : near.triangles) {
        btTriangleShape triangle(corners[0], corners[1], corners[2]);
        triangle.setMargin(0.0f);
        btVector3 flat = (corners[1] - corners[0]).cross(corners[2] - corners[0]);
        if (!(flat.length2() > 0.0f))
            continue;
        flat.normalize();
        std::vector<Reported::Point> found;
        convexPair(*a.convex, atA, nullptr, triangle, atB, nullptr, a.curved, reach, found);
        if (found.empty())
            continue;
        btVector3 normal = atB.getBasis() * flat;
        const float cosine = normal.dot(found[0].normal);
        if (cosine < 0.0f)
            normal = -normal;
        if (a.polyhedron != nullptr && std::abs(cosine) > kFaceCosine) {
            Reported clipped;
            btVertexArray corner, scratch;
            for (const btVector3& p : corners)
                corner.push_back(atB * p);
            btPolyhedralContactClipping::clipFaceAgainstHull(normal, *a.polyhedron, atA, corner, scratch,
                                                             -1e3f, reach, clipped);
            if (!clipped.points.empty())
                found = clipped.points;
        }
        // Inside a surface an edge between two triangles has the normal of either, not of the way out.
        if (std::abs(cosine) > 0.5f)
            for (Reported::Point& p : found)
                p.normal = normal;
        if (found.size() > kPerTriangle)
            reduce(found);
        all.insert(all.end(), found.begin(), found.end());
    }
    std::ranges::stable_sort(all, {}, &Reported::Point::distance);
    for (const Reported::Point& p : all) {
        const bool known = std::ranges::any_of(points, [&](const Reported::Point& q) {
            return (q.onB - p.onB).length2() < 1e-4f && q.normal.dot(p.normal) > 0.9f;
        });
        if (!known && points.size() < kTriangles)
            points.push_back(p);
    }
}

void ContactFinder::Bullet::pair(const FinderInput& input, size_t i, size_t j, double reach,
                                 FinderOutput& output) const {
    const Made &a = made[i], &b = made[j];
    const btTransform atA = transform(input, forms[i]), atB = transform(input, forms[j]);
    const float most = static_cast<float>(reach) * unit;
    std::vector<Reported::Point> points;
    if (a.convex != nullptr && b.convex != nullptr) {
        convexPair(*a.convex, atA, a.polyhedron, *b.convex, atB, b.polyhedron, a.curved || b.curved, most,
                   points);
        reduce(points);
    } else if (a.convex != nullptr) {
        meshPair(a, atA, b, atB, most, points);
    }
    for (const Reported::Point& p : points) {
        if (output.count == output.found.size()) {
            output.full = true;
            return;
        }
        FoundContact& contact = output.found[output.count++];
        contact.a = forms[i].body;
        contact.b = forms[j].body;
        contact.pair = static_cast<uint32_t>(i << 16 | j);
        contact.normal = glm::normalize(fromBullet(p.normal));
        contact.onB = fromBullet(p.onB, unit);
        contact.onA =
            contact.onB + contact.normal * (static_cast<double>(p.distance) / static_cast<double>(unit));
    }
}

} // namespace touchstone::body
