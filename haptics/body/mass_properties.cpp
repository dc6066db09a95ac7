#include "haptics/body/mass_properties.h"

#include <cmath>
#include <numbers>

namespace touchstone::body {

VolumeMoments& VolumeMoments::operator+=(const VolumeMoments& other) {
    volume += other.volume;
    first += other.first;
    second += other.second;
    return *this;
}

VolumeMoments VolumeMoments::in(const Pose& pose) const {
    // p' = R p + t: the integrals of p' and of p' p'^T.
    const glm::dmat3 r = glm::mat3_cast(pose.rotation);
    const glm::dvec3 turned = r * first, t = pose.position;
    VolumeMoments moved;
    moved.volume = volume;
    moved.first = turned + volume * t;
    moved.second = r * second * glm::transpose(r) + glm::outerProduct(turned, t) +
                   glm::outerProduct(t, turned) + volume * glm::outerProduct(t, t);
    return moved;
}

VolumeMoments momentsOf(std::span<const glm::dvec3> points, std::span<const uint32_t> indices) {
    VolumeMoments sum;
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const glm::dvec3 &a = points[indices[i]], &b = points[indices[i + 1]], &c = points[indices[i + 2]];
        // The tetrahedron with the origin: V/20 (sum of p p^T over its corners + s s^T), s their sum.
        const double volume = glm::dot(a, glm::cross(b, c)) / 6.0;
        const glm::dvec3 s = a + b + c;
        sum.volume += volume;
        sum.first += 0.25 * volume * s;
        sum.second += volume / 20.0 *
                      (glm::outerProduct(a, a) + glm::outerProduct(b, b) + glm::outerProduct(c, c) +
                       glm::outerProduct(s, s));
    }
    return sum;
}

namespace {

VolumeMoments diagonal(double volume, double x, double y, double z) {
    VolumeMoments moments;
    moments.volume = volume;
    moments.second = glm::dmat3(0.0);
    moments.second[0][0] = volume * x;
    moments.second[1][1] = volume * y;
    moments.second[2][2] = volume * z;
    return moments;
}

VolumeMoments boxMoments(const glm::dvec3& size) {
    const glm::dvec3 s = size * size / 12.0;
    return diagonal(size.x * size.y * size.z, s.x, s.y, s.z);
}

VolumeMoments cylinderMoments(double radius, double height) {
    const double across = radius * radius / 4.0;
    return diagonal(std::numbers::pi * radius * radius * height, across, height * height / 12.0, across);
}

VolumeMoments halfBallMoments(double radius, double towards, double offset) {
    // About the centre of the whole ball <x^2> = r^2/5; the half's centre is 3/8 r away from it.
    const double r2 = radius * radius;
    VolumeMoments half = diagonal(2.0 / 3.0 * std::numbers::pi * r2 * radius, r2 / 5.0, r2 / 5.0, r2 / 5.0);
    half.first = glm::dvec3(0.0, towards * 0.375 * radius * half.volume, 0.0);
    return half.in({glm::dquat(1.0, 0.0, 0.0, 0.0), {0.0, offset, 0.0}});
}

} // namespace

VolumeMoments momentsOf(const ColliderForm& form, std::span<const uint32_t> triangles) {
    const double mean = 0.5 * (form.radius + form.top);
    switch (form.shape) {
    case ColliderShape::Box:
        return boxMoments(form.size);
    case ColliderShape::Sphere: {
        const double r2 = form.radius * form.radius;
        return diagonal(4.0 / 3.0 * std::numbers::pi * r2 * form.radius, r2 / 5.0, r2 / 5.0, r2 / 5.0);
    }
    case ColliderShape::Cylinder:
        return cylinderMoments(mean, form.height);
    case ColliderShape::Capsule: {
        VolumeMoments sum = cylinderMoments(mean, form.height);
        sum += halfBallMoments(form.radius, -1.0, -0.5 * form.height);
        sum += halfBallMoments(form.top, 1.0, 0.5 * form.height);
        return sum;
    }
    case ColliderShape::Hull:
    case ColliderShape::Mesh:
        break;
    }
    std::vector<glm::dvec3> points(form.points.begin(), form.points.end());
    Bounds bounds;
    for (const glm::dvec3& p : points)
        bounds.include(p);
    const VolumeMoments moments = momentsOf(points, triangles);
    const glm::dvec3 size = bounds.extent();
    const double box = size.x * size.y * size.z;
    if (moments.volume > 1e-3 * box && moments.volume <= box * (1.0 + 1e-6))
        return moments;
    const double least = 1e-3 * std::max({size.x, size.y, size.z});
    return boxMoments(glm::max(size, glm::dvec3(least)))
        .in({glm::dquat(1.0, 0.0, 0.0, 0.0), bounds.centre()});
}

glm::dmat3 inertiaOf(const VolumeMoments& moments) {
    const glm::dvec3 centre = moments.first / moments.volume;
    const glm::dmat3 c = moments.second - moments.volume * glm::outerProduct(centre, centre);
    return (c[0][0] + c[1][1] + c[2][2]) * glm::dmat3(1.0) - c;
}

PrincipalAxes principalAxes(const glm::dmat3& matrix) {
    glm::dmat3 a = matrix, v(1.0);
    for (int sweep = 0; sweep < 50; ++sweep) {
        int p = 0, q = 1;
        for (const auto& [i, j] : {std::pair{0, 2}, std::pair{1, 2}})
            if (std::abs(a[i][j]) > std::abs(a[p][q])) {
                p = i;
                q = j;
            }
        if (std::abs(a[p][q]) <= 1e-15 * (std::abs(a[p][p]) + std::abs(a[q][q])))
            break;
        const double angle = 0.5 * std::atan2(2.0 * a[p][q], a[q][q] - a[p][p]);
        const double c = std::cos(angle), s = std::sin(angle);
        glm::dmat3 turn(1.0);
        turn[p][p] = turn[q][q] = c;
        turn[p][q] = -s; // column p
        turn[q][p] = s;
        a = glm::transpose(turn) * a * turn;
        v = v * turn;
    }
    if (glm::determinant(v) < 0.0)
        v[2] = -v[2];
    return {{a[0][0], a[1][1], a[2][2]}, glm::normalize(glm::quat_cast(v))};
}

} // namespace touchstone::body
