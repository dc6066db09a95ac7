#include "study/truth/smooth_shape.h"

#include <cmath>

namespace touchstone::truth {

namespace {

/// At `foot` on a surface with outward `normal`; `height` of the HIP over it.
SmoothRest restOver(const LVec3& hip, const LVec3& foot, const LVec3& normal, long double height,
                    long double radius) {
    if (height >= radius)
        return {hip, LVec3(0.0L), false};
    return {foot + radius * normal, normal, true};
}

class Plane final : public SmoothShape {
  public:
    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3&) const override {
        return restOver(hip, {hip.x, 0.0L, hip.z}, {0.0L, 1.0L, 0.0L}, hip.y, radius);
    }
};

/// Offset surfaces of a centre: of a sphere the point, of a cylinder the axis, of a torus the ring.
SmoothRest restAround(const LVec3& hip, const LVec3& centre, long double size, long double radius) {
    const LVec3 out = hip - centre;
    const long double distance = glm::length(out);
    const LVec3 normal = out / distance;
    return restOver(hip, centre + size * normal, normal, distance - size, radius);
}

class Sphere final : public SmoothShape {
  public:
    explicit Sphere(double radius) : size_(static_cast<long double>(radius)) {}
    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3&) const override {
        return restAround(hip, LVec3(0.0L), size_, radius);
    }

  private:
    long double size_;
};

class Cylinder final : public SmoothShape {
  public:
    explicit Cylinder(double radius) : size_(static_cast<long double>(radius)) {}
    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3&) const override {
        return restAround(hip, {0.0L, hip.y, 0.0L}, size_, radius);
    }

  private:
    long double size_;
};

class Torus final : public SmoothShape {
  public:
    Torus(double ring, double tube)
        : ring_(static_cast<long double>(ring)), tube_(static_cast<long double>(tube)) {}
    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3&) const override {
        const long double out = std::sqrt(hip.x * hip.x + hip.y * hip.y);
        return restAround(hip, {ring_ * hip.x / out, ring_ * hip.y / out, 0.0L}, tube_, radius);
    }

  private:
    long double ring_, tube_;
};

class Waves final : public SmoothShape {
  public:
    Waves(double amplitude, double length)
        : amplitude_(static_cast<long double>(amplitude)),
          wave_(2.0L * 3.14159265358979323846264338327950288L / static_cast<long double>(length)) {}

    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3& last) const override {
        // The sphere's centre moves on a curve parallel to the cosine: their foot points are the same.
        const long double x = foot(hip, foot(last, last.x));
        const long double slope = -amplitude_ * wave_ * std::sin(wave_ * x);
        const long double steep = std::sqrt(1.0L + slope * slope);
        const LVec3 normal{-slope / steep, 1.0L / steep, 0.0L};
        const LVec3 at{x, height(x), hip.z};
        return restOver(hip, at, normal, glm::dot(hip - at, normal), radius);
    }

  private:
    [[nodiscard]] long double height(long double x) const { return amplitude_ * std::cos(wave_ * x); }

    /// Newton on half the derivative of the squared distance, (x - p.x) + (f - p.y) f'; where the distance is
    /// not convex it takes a descent step of the same size.
    [[nodiscard]] long double foot(const LVec3& p, long double x) const {
        constexpr int kSteps = 200;
        constexpr long double kDone = 1e-18L; // m
        const long double furthest = 0.25L / wave_;
        for (int i = 0; i < kSteps; ++i) {
            const long double f = height(x), f1 = -amplitude_ * wave_ * std::sin(wave_ * x),
                              f2 = -wave_ * wave_ * f;
            const long double g = (x - p.x) + (f - p.y) * f1;
            const long double g1 = 1.0L + f1 * f1 + (f - p.y) * f2;
            long double step = g1 > 0.0L ? -g / g1 : -g;
            step = std::fmax(-furthest, std::fmin(furthest, step));
            x += step;
            if (std::fabs(step) < kDone)
                break;
        }
        return x;
    }

    long double amplitude_, wave_;
};

class Wedge final : public SmoothShape {
  public:
    explicit Wedge(double slope)
        : cos_(std::cos(static_cast<long double>(slope))), sin_(std::sin(static_cast<long double>(slope))) {}

    /// A sphere on one face stays there until its foot has passed the ridge, even if the other face has long
    /// been nearer. A HIP within the body then always has its foot on the other face, since the faces meet at
    /// more than 90 degrees.
    [[nodiscard]] SmoothRest rest(const LVec3& hip, long double radius, const LVec3& last) const override {
        long double side = last.x < 0.0L ? -1.0L : 1.0L;
        if (run(hip, side) < 0.0L)
            side = -side;
        const long double along = run(hip, side);
        const LVec3 normal{side * sin_, cos_, 0.0L};
        const long double above = glm::dot(hip, normal);
        if (along >= 0.0L)
            return restOver(hip, hip - above * normal, normal, above, radius);
        return restAround(hip, {0.0L, 0.0L, hip.z}, 0.0L, radius); // over the ridge itself, outside
    }

  private:
    /// Distance of the HIP's foot on a face from the ridge.
    [[nodiscard]] long double run(const LVec3& hip, long double side) const {
        return side * cos_ * hip.x - sin_ * hip.y;
    }

    long double cos_, sin_;
};

} // namespace

SmoothShapePtr smoothPlane() {
    return std::make_shared<Plane>();
}
SmoothShapePtr smoothSphere(double radius) {
    return std::make_shared<Sphere>(radius);
}
SmoothShapePtr smoothCylinder(double radius) {
    return std::make_shared<Cylinder>(radius);
}
SmoothShapePtr smoothTorus(double ring, double tube) {
    return std::make_shared<Torus>(ring, tube);
}
SmoothShapePtr smoothWaves(double amplitude, double length) {
    return std::make_shared<Waves>(amplitude, length);
}
SmoothShapePtr smoothWedge(double slope) {
    return std::make_shared<Wedge>(slope);
}

} // namespace touchstone::truth
