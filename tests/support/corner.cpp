#include "tests/support/corner.h"

#include "tests/support/touch_bench.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

namespace {

/// One triangle: what is rounded to float stays a plane.
assets::Shape wallShape(const glm::dvec3& normal, const glm::dvec3& a, const glm::dvec3& b,
                        const glm::dvec3& c) {
    assets::Shape shape;
    for (const glm::dvec3& p : {a, b, c})
        shape.positions.emplace_back(p);
    const bool outwards = glm::dot(glm::cross(b - a, c - a), normal) > 0.0;
    shape.indices = outwards ? std::vector<uint32_t>{0, 1, 2} : std::vector<uint32_t>{0, 2, 1};
    return shape;
}

/// Along the meet of two walls, where the third leaves it free.
glm::dvec3 edgeOf(const std::vector<Wall>& walls, size_t i, size_t k, size_t other) {
    const glm::dvec3 edge = glm::normalize(glm::cross(walls[i].normal, walls[k].normal));
    return glm::dot(edge, walls[other].normal) > 0.0 ? edge : -edge;
}

glm::dvec3 anyAcross(const glm::dvec3& normal) {
    const glm::dvec3 other = std::abs(normal.x) < 0.6 ? glm::dvec3(1, 0, 0) : glm::dvec3(0, 1, 0);
    return glm::normalize(glm::cross(normal, other));
}

assets::Shape shapeOf(const std::vector<Wall>& walls, size_t i, double reach) {
    const glm::dvec3& n = walls[i].normal;
    if (walls.size() == 1) {
        const glm::dvec3 x = reach * anyAcross(n), y = glm::cross(n, x);
        return wallShape(n, -2.0 * x - y, 2.0 * x - y, 2.0 * y);
    }
    if (walls.size() == 2) {
        const glm::dvec3 edge = reach * glm::normalize(glm::cross(walls[0].normal, walls[1].normal));
        const glm::dvec3 across = glm::cross(edge, n);
        return wallShape(n, -edge, edge, glm::dot(across, walls[1 - i].normal) < 0.0 ? -across : across);
    }
    const size_t k = (i + 1) % 3, l = (i + 2) % 3;
    return wallShape(n, glm::dvec3(0.0), reach * edgeOf(walls, i, k, l), reach * edgeOf(walls, i, l, k));
}

} // namespace

HapticSettings cornerSettings() {
    HapticSettings s;
    s.proxyRadius = kCornerRadius;
    s.forceShading = ShadingMode::Off;
    s.texture = TextureMode::Off;
    s.friction = FrictionMode::Off;
    return s;
}

std::vector<Wall> groove(double angle, float left, float right) {
    const double half = 0.5 * angle;
    return {{.normal = {std::cos(half), std::sin(half), 0.0}, .stiffness = left},
            {.normal = {-std::cos(half), std::sin(half), 0.0}, .stiffness = right}};
}

glm::dvec3 elasticOf(const std::vector<glm::dvec3>& normals, const std::vector<Wall>& walls,
                     const CornerSolve& solve) {
    glm::dvec3 force(0.0);
    for (size_t i = 0; i < walls.size(); ++i)
        force += static_cast<double>(walls[i].stiffness) * solve.load[i] * normals[i];
    return force;
}

Scene cornerScene(const std::vector<Wall>& walls, double reach) {
    Scene scene = sceneOf(shapeOf(walls, 0, reach));
    for (size_t i = 1; i < walls.size(); ++i) {
        addShape(scene, shapeOf(walls, i, reach));
        scene.materials.emplace_back();
        scene.meshes[i].material = static_cast<int>(i);
    }
    for (size_t i = 0; i < walls.size(); ++i) {
        HapticMaterial& haptic = scene.materials[i].haptic;
        constexpr HapticSource kSource = HapticSource::Touchstone;
        haptic.stiffness = {walls[i].stiffness, kSource};
        haptic.damping = {walls[i].damping, kSource};
        haptic.staticFriction = {walls[i].staticFriction, kSource};
        haptic.dynamicFriction = {walls[i].dynamicFriction, kSource};
        haptic.viscousFriction = {walls[i].viscousFriction, kSource};
    }
    return scene;
}

Corner cornerOf(const HapticScene& scene) {
    Corner corner;
    for (size_t k = 0; k < scene.objects.size(); ++k) {
        const HapticObject& object = *scene.objects[k];
        const auto at = [&](size_t i) {
            return scene.restMotions[k].workspaceFromObject.point(
                glm::dvec3(object.vertices[object.indices[i]]));
        };
        corner.normals.push_back(glm::normalize(glm::cross(at(1) - at(0), at(2) - at(0))));
        corner.offsets.push_back(glm::dot(corner.normals.back(), at(0)));
    }
    return corner;
}

std::vector<double> multipliers(const std::vector<glm::dvec3>& n, const std::vector<double>& lengths) {
    if (n.size() == 1)
        return lengths;
    if (n.size() == 2) {
        const double c = glm::dot(n[0], n[1]), s = 1.0 - c * c;
        return {(lengths[0] - c * lengths[1]) / s, (lengths[1] - c * lengths[0]) / s};
    }
    const glm::dmat3 rows = glm::transpose(glm::dmat3(n[0], n[1], n[2]));
    const glm::dvec3 sum = glm::inverse(rows) * glm::dvec3(lengths[0], lengths[1], lengths[2]);
    const glm::dvec3 lambda = glm::inverse(glm::transpose(rows)) * sum;
    return {lambda.x, lambda.y, lambda.z};
}

std::vector<double> coefficients(const std::vector<glm::dvec3>& n, const glm::dvec3& v) {
    std::vector<double> lengths;
    for (const glm::dvec3& normal : n)
        lengths.push_back(glm::dot(normal, v));
    return multipliers(n, lengths);
}

double minSingularValue(const std::vector<glm::dvec3>& n) {
    if (n.size() == 1)
        return 1.0;
    if (n.size() == 2)
        return std::sqrt(1.0 - std::abs(glm::dot(n[0], n[1])));
    // The least eigenvalue of the Gram matrix 1 + G, by the trigonometric solution of its cubic.
    const double a = glm::dot(n[0], n[1]), b = glm::dot(n[0], n[2]), c = glm::dot(n[1], n[2]);
    const double p = std::sqrt((a * a + b * b + c * c) / 3.0);
    if (!(p > 0.0))
        return 1.0;
    const double r = std::clamp(a * b * c / (p * p * p), -1.0, 1.0);
    const double third = std::acos(r) / 3.0, kThirdTurn = 2.0943951023931953;
    return std::sqrt(std::max(1.0 + 2.0 * p * std::cos(third + kThirdTurn), 0.0));
}

CornerSolve solveCorner(const Corner& corner, double radius, const glm::dvec3& hip) {
    const auto& [normals, offsets] = corner;
    CornerSolve best;
    double nearest = INFINITY;
    for (unsigned set = 0; set < 1u << normals.size(); ++set) {
        std::vector<glm::dvec3> chosen;
        std::vector<double> lengths;
        for (size_t i = 0; i < normals.size(); ++i)
            if (set >> i & 1u) {
                chosen.push_back(normals[i]);
                lengths.push_back(offsets[i] + radius - glm::dot(normals[i], hip));
            }
        // Onto the meet of the chosen planes, a radius above the walls.
        const std::vector<double> lambda =
            chosen.empty() ? std::vector<double>{} : multipliers(chosen, lengths);
        glm::dvec3 place = hip;
        for (size_t k = 0; k < chosen.size(); ++k)
            place += lambda[k] * chosen[k];
        bool holds = true;
        for (const double l : lambda)
            holds &= l >= 0.0;
        for (size_t i = 0; i < normals.size(); ++i)
            holds &= glm::dot(normals[i], place) >= offsets[i] + radius - 1e-14;
        const double distance = glm::length(place - hip);
        if (!holds || distance >= nearest)
            continue;
        nearest = distance;
        best = {.place = place, .load = {}, .count = static_cast<int>(chosen.size())};
        for (size_t i = 0, k = 0; i < normals.size(); ++i)
            if (set >> i & 1u)
                best.load[i] = lambda[k++];
    }
    return best;
}

double loadOf(const HapticOutput& out, const glm::dvec3& offset) {
    constexpr double kParallel = 1e-6; // planes nearer to each other carry the load together
    const std::vector<glm::dvec3> planes(out.planes.begin(), out.planes.begin() + out.planeCount);
    double load = 0.0;
    if (planes.size() > 1 && minSingularValue(planes) > kParallel)
        for (const double part : coefficients(planes, offset))
            load += part;
    return std::max(load, glm::length(offset));
}

} // namespace touchstone::test
