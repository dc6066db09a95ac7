#include "study/voxel/voxel_shape.h"

#include "study/subject/subject.h"

#include <algorithm>
#include <cmath>

namespace touchstone::study {

namespace {

constexpr double kSphereRadius = 0.050, kRingRadius = 0.060, kTubeRadius = 0.025,
                 kBoxSide = 0.1;    // m, as in study/subject
constexpr double kHandDepth = 1e-3; // m
constexpr size_t kMeshTriangles = 64'800;

/// Far from every axis and diagonal of the grid.
glm::dquat oblique() {
    return glm::normalize(glm::dquat(1.0, 0.21, 0.34, 0.13));
}

double boxDistance(const glm::dvec3& p, const glm::dvec3& half) {
    const glm::dvec3 q = glm::abs(p) - half;
    return glm::length(glm::max(q, 0.0)) + std::min(std::max({q.x, q.y, q.z}), 0.0);
}

/// The stroke, the closed form and the mesh of a shape of the other ablations.
VoxelShape likeSubject(const char* name) {
    VoxelShape shape;
    shape.name = name;
    for (const ShapeKind& kind : shapeKinds())
        if (kind.name == name) {
            const Subject subject = kind.make(512);
            shape.stroke = subject.bench.stroke;
            shape.smooth = subject.smooth;
        }
    shape.triangles = kMeshTriangles;
    return shape;
}

uint32_t squareSide(size_t triangles) {
    return static_cast<uint32_t>(std::max(3L, std::lround(std::sqrt(0.5 * static_cast<double>(triangles)))));
}

VoxelShape voxelSphere() {
    VoxelShape shape = likeSubject("sphere");
    shape.distance = [](const glm::dvec3& p) { return glm::length(p) - kSphereRadius; };
    shape.half = glm::dvec3(kSphereRadius);
    shape.mesh = [](size_t triangles) {
        return assets::sphere(kSphereRadius, squareSide(triangles), squareSide(triangles));
    };
    return shape;
}

VoxelShape voxelTorus() {
    VoxelShape shape = likeSubject("torus");
    shape.distance = [](const glm::dvec3& p) {
        return std::hypot(std::hypot(p.x, p.y) - kRingRadius, p.z) - kTubeRadius;
    };
    shape.half = {kRingRadius + kTubeRadius, kRingRadius + kTubeRadius, kTubeRadius};
    shape.mesh = [](size_t triangles) {
        return assets::torus(kRingRadius, kTubeRadius, squareSide(triangles), squareSide(triangles));
    };
    return shape;
}

/// A loop of 28 mm: 1 mm below the upper face over its edge, up and back through the air; from loop to loop
/// at another place along the edge.
VoxelShape voxelBox() {
    constexpr double kHalf = 0.5 * kBoxSide;
    VoxelShape shape;
    shape.name = "box";
    shape.distance = [](const glm::dvec3& p) { return boxDistance(p, glm::dvec3(kHalf)); };
    shape.half = glm::dvec3(kHalf);
    shape.gridTurn = oblique();
    shape.stroke = [](double metres, double lift) {
        constexpr double kBegin = 0.040, kEnd = 0.051, kHigh = 2e-3, kAlong = 0.04; // m
        constexpr double kWay = kEnd - kBegin, kRise = kHandDepth + kHigh, kLoop = 2.0 * (kWay + kRise);
        const double at = metres - kLoop * std::floor(metres / kLoop);
        const double x = at < kWay           ? kBegin + at
                         : at < kWay + kRise ? kEnd
                                             : std::max(kBegin, kEnd - (at - kWay - kRise));
        const double up =
            std::clamp(at - kWay, 0.0, kRise) - std::clamp(at - (2.0 * kWay + kRise), 0.0, kRise);
        return glm::dvec3(x, kHalf - kHandDepth + up + lift, kAlong * std::sin(metres / kAlong));
    };
    shape.mesh = [](size_t) { return assets::boxWithSharedCorners(glm::dvec3(kBoxSide)); };
    shape.triangles = 12;
    return shape;
}

/// Between the walls y = |x| a hand below their line pulls the proxy into it.
class GrooveRest final : public truth::SmoothShape {
  public:
    [[nodiscard]] truth::SmoothRest rest(const truth::LVec3& hip, long double,
                                         const truth::LVec3&) const override {
        if (hip.y >= std::abs(hip.x))
            return {hip, truth::LVec3(0.0L), false};
        if (std::abs(hip.x) <= -hip.y) {
            const truth::LVec3 line{0.0L, 0.0L, hip.z};
            return {line, glm::normalize(line - hip), true};
        }
        const long double side = hip.x > 0.0L ? 1.0L : -1.0L, half = 0.5L * (side * hip.x + hip.y);
        const truth::LVec3 wall{side * half, half, hip.z};
        return {wall, glm::normalize(wall - hip), true};
    }
};

/// Along the line, 1 mm below it, weaving by 0.3 mm between the walls.
VoxelShape voxelGroove() {
    constexpr double kDeep = 0.030, kLong = 0.05, kWeave = 3e-4;
    VoxelShape shape;
    shape.name = "groove";
    const glm::dvec3 half(kDeep, kDeep, kLong);
    shape.distance = [half](const glm::dvec3& p) {
        const double beside = std::abs(p.x);
        const double walls = beside < -p.y ? -std::hypot(p.x, p.y) : std::sqrt(0.5) * (p.y - beside);
        return std::max(walls, boxDistance(p, half));
    };
    shape.half = half;
    shape.gridTurn = oblique();
    shape.stroke = [](double metres, double lift) {
        constexpr double kAlong = 0.6 * kLong;
        return glm::dvec3(kWeave * std::sin(metres / 0.003), lift - kHandDepth,
                          kAlong * std::sin(metres / kAlong));
    };
    shape.smooth = std::make_shared<const GrooveRest>();
    return shape;
}

} // namespace

std::vector<VoxelShape> voxelShapes() {
    return {voxelSphere(), voxelTorus(), voxelBox(), voxelGroove()};
}

} // namespace touchstone::study
