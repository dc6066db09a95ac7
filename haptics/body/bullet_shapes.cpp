// Bullet's shapes of colliders.

#include "haptics/body/bullet_colliders.h"

#include <BulletCollision/CollisionShapes/btBvhTriangleMeshShape.h>
#include <BulletCollision/CollisionShapes/btCapsuleShape.h>
#include <BulletCollision/CollisionShapes/btConvexHullShape.h>
#include <BulletCollision/CollisionShapes/btCylinderShape.h>
#include <BulletCollision/CollisionShapes/btSphereShape.h>
#include <LinearMath/btConvexHullComputer.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace touchstone::body {

namespace {

/// Corners of a hull: more would not be felt in a contact.
constexpr int kHullCorners = 64;

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
    makeHull(form, to);
}

/// A hull: of its points, or of the two ends of a cone.
void ContactFinder::Bullet::makeHull(const ColliderForm& form, Made& to) const {
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

} // namespace touchstone::body
