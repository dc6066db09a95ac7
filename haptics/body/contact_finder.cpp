// Distances by GJK and EPA, and face against face by clipping. Bullet's own dispatcher keeps manifolds from
// step to step, which a replay that begins in the middle would not have; its building blocks keep nothing.

#include "haptics/body/contact_finder.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/CollisionShapes/btTriangleShape.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkEpaPenetrationDepthSolver.h>
#include <BulletCollision/NarrowPhaseCollision/btGjkPairDetector.h>
#include <BulletCollision/NarrowPhaseCollision/btPolyhedralContactClipping.h>
#include <BulletCollision/NarrowPhaseCollision/btVoronoiSimplexSolver.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::body {

namespace {

/// A face of which the normal is nearer than this to the direction of the distance carries a face contact.
constexpr float kFaceCosine = 0.98f;
constexpr size_t kPerPair = 4, kPerTriangle = 4, kTriangles = 8;
/// Corners of a hull: more would not be felt in a contact.
constexpr int kHullCorners = 64;
/// m: room for what a hand adds to a body's speed until the next contacts come.
constexpr double kLeastReach = 2e-3;

/// What a query of Bullet reports, in its unit.
struct Reported : btDiscreteCollisionDetectorInterface::Result {
    struct Point {
        btVector3 onB, normal; // from b to a
        btScalar distance;
    };
    std::vector<Point> points;

    void setShapeIdentifiersA(int, int) override {}
    void setShapeIdentifiersB(int, int) override {}
    void addContactPoint(const btVector3& normal, const btVector3& onB, btScalar distance) override {
        points.push_back({onB, normal, distance});
    }
};

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

/// Its faces; null where a shape that is flat or thin beyond floats has none that Bullet could clip against.
const btConvexPolyhedron* facesOf(const btPolyhedralConvexShape& shape) {
    const btConvexPolyhedron* polyhedron = shape.getConvexPolyhedron();
    bool sound = polyhedron != nullptr && polyhedron->m_faces.size() > 0;
    for (int i = 0; sound && i < polyhedron->m_faces.size(); ++i)
        for (const btScalar number : polyhedron->m_faces[i].m_plane)
            sound = sound && std::isfinite(number);
    return sound ? polyhedron : nullptr;
}

} // namespace

struct ContactFinder::Bullet {
    std::vector<ColliderForm> forms;
    std::vector<std::pair<int, int>> apart; // sorted
    float unit = 1.0f;                      // Bullet's lengths for 1 m: bodies are about 1
    struct Made {
        std::unique_ptr<btCollisionShape> shape;
        std::unique_ptr<btTriangleIndexVertexArray> mesh;
        std::vector<float> corners;
        std::vector<int> indices;
        const btConvexShape* convex = nullptr;
        const btConvexPolyhedron* polyhedron = nullptr;
        bool curved = false; // neither flat faces nor a ball: several points by small turns
    };
    std::vector<Made> made;

    void make(const ColliderForm& form, Made& to) const;
    btTransform transform(const FinderInput& input, const ColliderForm& form) const;
    void pair(const FinderInput& input, size_t i, size_t j, double reach, FinderOutput& output) const;
    void convexPair(const btConvexShape& a, const btTransform& atA, const btConvexPolyhedron* hullA,
                    const btConvexShape& b, const btTransform& atB, const btConvexPolyhedron* hullB,
                    bool curved, float reach, std::vector<Reported::Point>& points) const;
    void meshPair(const Made& a, const btTransform& atA, const Made& b, const btTransform& atB, float reach,
                  std::vector<Reported::Point>& points) const;
    [[nodiscard]] bool collide(const ColliderForm& a, const ColliderForm& b) const;
};

namespace {

btVector3 bulletVector(const glm::dvec3& v, float unit = 1.0f) {
    return {static_cast<float>(v.x) * unit, static_cast<float>(v.y) * unit, static_cast<float>(v.z) * unit};
}
btQuaternion bulletRotation(const glm::dquat& q) {
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
            static_cast<float>(q.w)};
}
glm::dvec3 fromBullet(const btVector3& v, float unit = 1.0f) {
    return {static_cast<double>(v.x()) / static_cast<double>(unit),
            static_cast<double>(v.y()) / static_cast<double>(unit),
            static_cast<double>(v.z()) / static_cast<double>(unit)};
}

} // namespace

void ContactFinder::Bullet::make(const ColliderForm& form, Made& to) const {
    const auto length = [&](double metres) { return static_cast<float>(metres) * unit; };
    switch (form.shape) {
    case ColliderShape::Box: {
        auto box = std::make_unique<btBoxShape>(bulletVector(0.5 * form.size, unit));
        box->setMargin(0.02f * box->getHalfExtentsWithMargin()[box->getHalfExtentsWithMargin().minAxis()]);
        box->initializePolyhedralFeatures();
        to.polyhedron = facesOf(*box);
        to.convex = box.get();
        to.shape = std::move(box);
        return;
    }
    case ColliderShape::Sphere: {
        auto ball = std::make_unique<btSphereShape>(length(form.radius));
        to.convex = ball.get();
        to.shape = std::move(ball);
        return;
    }
    case ColliderShape::Capsule:
        if (form.radius == form.top) {
            auto capsule = std::make_unique<btCapsuleShape>(length(form.radius), length(form.height));
            to.convex = capsule.get();
            to.shape = std::move(capsule);
            to.curved = true;
            return;
        }
        break;
    case ColliderShape::Cylinder:
        if (form.radius == form.top) {
            auto cylinder = std::make_unique<btCylinderShape>(
                btVector3(length(form.radius), length(0.5 * form.height), length(form.radius)));
            cylinder->setMargin(0.02f * std::min(length(form.radius), length(0.5 * form.height)));
            to.convex = cylinder.get();
            to.shape = std::move(cylinder);
            to.curved = true;
            return;
        }
        break;
    case ColliderShape::Hull:
        break;
    case ColliderShape::Mesh: {
        for (const glm::vec3& p : form.points)
            for (int k = 0; k < 3; ++k)
                to.corners.push_back(p[k] * unit);
        to.indices.assign(form.indices.begin(), form.indices.end());
        to.mesh = std::make_unique<btTriangleIndexVertexArray>(
            static_cast<int>(to.indices.size() / 3), to.indices.data(), 3 * static_cast<int>(sizeof(int)),
            static_cast<int>(form.points.size()), to.corners.data(), 3 * static_cast<int>(sizeof(float)));
        to.shape = std::make_unique<btBvhTriangleMeshShape>(to.mesh.get(), true);
        return;
    }
    }
    // A hull: of its points, or of the two ends of a cone.
    std::vector<btVector3> points;
    for (const glm::vec3& p : form.points)
        points.push_back(bulletVector(glm::dvec3(p), unit));
    constexpr int kAround = 24;
    for (int i = 0; form.shape != ColliderShape::Hull && i < kAround; ++i) {
        const double angle = 2.0 * std::numbers::pi * i / kAround;
        for (const double end : {-0.5, 0.5}) {
            const double radius = end < 0.0 ? form.radius : form.top;
            points.push_back(
                bulletVector({radius * std::cos(angle), end * form.height, radius * std::sin(angle)}, unit));
        }
    }
    btConvexHullComputer hull;
    hull.compute(&points[0].x(), sizeof(btVector3), static_cast<int>(points.size()), 0.0f, 0.0f);
    auto shape = std::make_unique<btConvexHullShape>();
    // Of many corners those that are farthest in evenly spread directions.
    if (hull.vertices.size() <= kHullCorners) {
        for (int i = 0; i < hull.vertices.size(); ++i)
            shape->addPoint(hull.vertices[i], false);
    } else {
        std::vector<bool> taken(static_cast<size_t>(hull.vertices.size()), false);
        for (int k = 0; k < kHullCorners; ++k) {
            const double z = 1.0 - 2.0 * (k + 0.5) / kHullCorners, turn = k * 2.399963229728653;
            const btVector3 direction = bulletVector(
                {std::sqrt(1.0 - z * z) * std::cos(turn), std::sqrt(1.0 - z * z) * std::sin(turn), z});
            int best = 0;
            for (int i = 1; i < hull.vertices.size(); ++i)
                if (hull.vertices[i].dot(direction) > hull.vertices[best].dot(direction))
                    best = i;
            if (!taken[static_cast<size_t>(best)])
                shape->addPoint(hull.vertices[best], false);
            taken[static_cast<size_t>(best)] = true;
        }
    }
    shape->recalcLocalAabb();
    shape->setMargin(0.001f);
    shape->initializePolyhedralFeatures();
    to.polyhedron = facesOf(*shape);
    to.convex = shape.get();
    to.shape = std::move(shape);
}

btTransform ContactFinder::Bullet::transform(const FinderInput& input, const ColliderForm& form) const {
    Pose at = form.bodyFromCollider;
    if (form.body >= 0) {
        const Pose& body = input.bodies[static_cast<size_t>(form.body)].pose;
        at = {body.rotation * at.rotation, body.point(at.position)};
    }
    return btTransform(bulletRotation(at.rotation), bulletVector(at.position, unit));
}

/// True where the collision filters let them meet.
bool ContactFinder::Bullet::collide(const ColliderForm& a, const ColliderForm& b) const {
    const auto meets = [](const ColliderForm& one, const ColliderForm& other) {
        if (other.collides && (one.systems == 0 || (one.systems & ~*other.collides) != 0))
            return false;
        return !(other.collidesNot && one.systems != 0 && (one.systems & ~*other.collidesNot) == 0);
    };
    if (!meets(a, b) || !meets(b, a))
        return false;
    return !std::ranges::binary_search(
        apart, std::pair<int, int>(std::min(a.body, b.body), std::max(a.body, b.body)));
}

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

ContactFinder::ContactFinder(std::vector<ColliderForm> forms, std::vector<std::pair<int, int>> apart)
    : bullet_(std::make_unique<Bullet>()) {
    bullet_->forms = std::move(forms);
    std::ranges::sort(apart);
    bullet_->apart = std::move(apart);
    double smallest = INFINITY;
    for (const ColliderForm& form : bullet_->forms)
        if (form.body >= 0) {
            double size = std::max({form.size.x, form.size.y, form.size.z});
            if (form.shape != ColliderShape::Box)
                size = 2.0 * std::max(form.radius, form.top);
            if (form.shape == ColliderShape::Hull || form.shape == ColliderShape::Mesh) {
                size = 0.0;
                for (const glm::vec3& p : form.points)
                    size = std::max(size, 2.0 * static_cast<double>(glm::length(p)));
            }
            if (size > 0.0)
                smallest = std::min(smallest, size);
        }
    bullet_->unit = std::isfinite(smallest) ? static_cast<float>(2.0 / smallest) : 1.0f;
    bullet_->made.resize(bullet_->forms.size());
    for (size_t i = 0; i < bullet_->forms.size(); ++i)
        bullet_->make(bullet_->forms[i], bullet_->made[i]);
}

ContactFinder::~ContactFinder() = default;

const std::vector<ColliderForm>& ContactFinder::forms() const {
    return bullet_->forms;
}

void ContactFinder::find(const FinderInput& input, double ahead, FinderOutput& output) {
    output.tick = input.tick;
    output.count = 0;
    output.full = false;
    const std::vector<ColliderForm>& forms = bullet_->forms;
    struct Box {
        btVector3 low, high;
    };
    std::vector<Box> boxes(forms.size());
    std::vector<double> reach(forms.size());
    for (size_t i = 0; i < forms.size(); ++i) {
        bullet_->made[i].shape->getAabb(bullet_->transform(input, forms[i]), boxes[i].low, boxes[i].high);
        // The way until the next contacts come, and room for what a hand adds to it.
        if (forms[i].body >= 0) {
            const FinderInput::Entry& body = input.bodies[static_cast<size_t>(forms[i].body)];
            reach[i] = ahead * (glm::length(body.velocity) + body.turning) + kLeastReach;
        }
        const auto room = static_cast<float>(reach[i]) * bullet_->unit;
        boxes[i].low -= btVector3(room, room, room);
        boxes[i].high += btVector3(room, room, room);
    }
    for (size_t b = 0; b < input.bodies.size(); ++b) {
        const FinderInput::Entry& body = input.bodies[b];
        output.rooms[b] = {body.pose.position,
                           body.awake ? ahead * (glm::length(body.velocity) + body.turning) + kLeastReach
                                      : 0.0};
    }
    const auto awake = [&](size_t i) {
        return forms[i].body >= 0 && input.bodies[static_cast<size_t>(forms[i].body)].awake;
    };
    const auto meet = [&](size_t i, size_t j) {
        return boxes[i].low.x() <= boxes[j].high.x() && boxes[j].low.x() <= boxes[i].high.x() &&
               boxes[i].low.y() <= boxes[j].high.y() && boxes[j].low.y() <= boxes[i].high.y() &&
               boxes[i].low.z() <= boxes[j].high.z() && boxes[j].low.z() <= boxes[i].high.z();
    };
    // In the order of their numbers, so that the contacts are in the order of their pairs.
    for (size_t i = 0; i < forms.size(); ++i) {
        if (forms[i].body < 0 || bullet_->made[i].convex == nullptr)
            continue;
        for (size_t j = 0; j < forms.size(); ++j) {
            if (j == i || forms[j].body == forms[i].body || !meet(i, j))
                continue;
            const bool both = forms[j].body >= 0 && bullet_->made[j].convex != nullptr;
            if ((both && j < i) || !(awake(i) || awake(j)) || !bullet_->collide(forms[i], forms[j]))
                continue;
            bullet_->pair(input, i, j, reach[i] + reach[j], output);
        }
    }
}

} // namespace touchstone::body
