#pragma once
// Bullet's part of the contact finder. Private to its files.

#include "haptics/body/contact_finder.h"

#include <BulletCollision/CollisionShapes/btBoxShape.h>
#include <BulletCollision/CollisionShapes/btConvexPolyhedron.h>
#include <BulletCollision/CollisionShapes/btTriangleIndexVertexArray.h>
#include <BulletCollision/NarrowPhaseCollision/btDiscreteCollisionDetectorInterface.h>

#include <cstddef>
#include <memory>
#include <utility>
#include <vector>

namespace touchstone::body {

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
    void makeHull(const ColliderForm& form, Made& to) const;
    btTransform transform(const FinderInput& input, const ColliderForm& form) const;
    void pair(const FinderInput& input, size_t i, size_t j, double reach, FinderOutput& output) const;
    void convexPair(const btConvexShape& a, const btTransform& atA, const btConvexPolyhedron* hullA,
                    const btConvexShape& b, const btTransform& atB, const btConvexPolyhedron* hullB,
                    bool curved, float reach, std::vector<Reported::Point>& points) const;
    void meshPair(const Made& a, const btTransform& atA, const Made& b, const btTransform& atB, float reach,
                  std::vector<Reported::Point>& points) const;
    [[nodiscard]] bool collide(const ColliderForm& a, const ColliderForm& b) const;
};

inline btVector3 bulletVector(const glm::dvec3& v, float unit = 1.0f) {
    return {static_cast<float>(v.x) * unit, static_cast<float>(v.y) * unit, static_cast<float>(v.z) * unit};
}
inline btQuaternion bulletRotation(const glm::dquat& q) {
    return {static_cast<float>(q.x), static_cast<float>(q.y), static_cast<float>(q.z),
            static_cast<float>(q.w)};
}
inline glm::dvec3 fromBullet(const btVector3& v, float unit = 1.0f) {
    return {static_cast<double>(v.x()) / static_cast<double>(unit),
            static_cast<double>(v.y()) / static_cast<double>(unit),
            static_cast<double>(v.z()) / static_cast<double>(unit)};
}

} // namespace touchstone::body
