// What tactile shading interpolates on triangles was chosen by measurement: candidates on a torus, an
// ellipsoid and a sphere, finer and finer.

#include "haptics/shading/patch_normal.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <random>
#include <vector>

namespace touchstone::patch_normal_test {
namespace {

using Three = std::array<glm::dvec3, 3>;
using Rule = std::function<glm::dvec3(const Three&, const Three&, const glm::dvec3&)>;

glm::dvec3 linear(const Three&, const Three& n, const glm::dvec3& w) {
    return w.x * n[0] + w.y * n[1] + w.z * n[2];
}

/// The quadratic normals of PN triangles (Vlachos, Peters, Boyd, Mitchell 2001).
glm::dvec3 pnTriangle(const Three& p, const Three& n, const glm::dvec3& w) {
    glm::dvec3 sum(0.0);
    for (int i = 0; i < 3; ++i) {
        const auto a = static_cast<size_t>(i), b = static_cast<size_t>((i + 1) % 3);
        const glm::dvec3 e = p[b] - p[a], m = n[a] + n[b];
        sum += w[i] * w[i] * n[a] +
               w[i] * w[(i + 1) % 3] * glm::normalize(m - 2.0 * glm::dot(e, m) / glm::dot(e, e) * e);
    }
    return sum;
}

/// The normal of the surface of Phong tessellation (Boubekeur and Alexa 2008), by differences.
glm::dvec3 phongTessellation(const Three& p, const Three& n, const glm::dvec3& w) {
    const auto at = [&](double u, double v) {
        const glm::dvec3 k(1.0 - u - v, u, v), q = linear({}, p, k);
        glm::dvec3 sum(0.0);
        for (int i = 0; i < 3; ++i) {
            const auto a = static_cast<size_t>(i);
            sum += k[i] * (q - glm::dot(q - p[a], n[a]) * n[a]);
        }
        return 0.25 * q + 0.75 * sum;
    };
    constexpr double h = 1e-4;
    return glm::cross(at(w.y + h, w.z) - at(w.y - h, w.z), at(w.y, w.z + h) - at(w.y, w.z - h));
}

double angle(const glm::dvec3& a, const glm::dvec3& b) {
    return std::atan2(glm::length(glm::cross(a, b)), glm::dot(a, b)) * 180.0 / M_PI;
}

/// A surface by two angles, and the normal of the level set at any point near it.
struct Surface {
    std::function<glm::dvec3(double, double)> place;
    std::function<glm::dvec3(const glm::dvec3&)> normal;
};

Surface torus() {
    constexpr double kRing = 0.05, kTube = 0.02;
    return {[](double u, double v) {
                const double d = kRing + kTube * std::cos(v);
                return glm::dvec3(d * std::cos(u), d * std::sin(u), kTube * std::sin(v));
            },
            [](const glm::dvec3& p) {
                const double d = std::hypot(p.x, p.y);
                return glm::normalize(glm::dvec3(p.x * (1.0 - kRing / d), p.y * (1.0 - kRing / d), p.z));
            }};
}

Surface sphere() {
    return {[](double u, double v) {
                return 0.05 * glm::dvec3(std::cos(u) * std::cos(v), std::sin(u) * std::cos(v), std::sin(v));
            },
            [](const glm::dvec3& p) { return glm::normalize(p); }};
}

struct Error {
    double mean = 0.0, most = 0.0, jump = 0.0; // degrees
};

/// Triangles of size h about random places; the error at random points of them, and the jump over one edge.
Error measured(const Surface& surface, double h, const Rule& rule) {
    std::mt19937_64 random(7);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    Error error;
    constexpr int kCount = 4000;
    for (int i = 0; i < kCount; ++i) {
        const double u = 2.0 * M_PI * unit(random), v = 1.2 * (unit(random) - 0.5),
                     turn = 2.0 * M_PI * unit(random);
        const auto corner = [&](double a, double b) {
            return surface.place(u + h * (a * std::cos(turn) - b * std::sin(turn)),
                                 v + h * (a * std::sin(turn) + b * std::cos(turn)));
        };
        // Two triangles with a common edge.
        const Three p{corner(0, 0), corner(1, 0), corner(0.4, 0.9)}, q{p[1], p[0], corner(0.7, -0.8)};
        const auto normals = [&](const Three& c) {
            return Three{surface.normal(c[0]), surface.normal(c[1]), surface.normal(c[2])};
        };
        double a = unit(random), b = unit(random);
        if (a + b > 1.0) {
            a = 1.0 - a;
            b = 1.0 - b;
        }
        const glm::dvec3 w(1.0 - a - b, a, b);
        const double off = angle(rule(p, normals(p), w), surface.normal(linear({}, p, w)));
        error.mean += off / kCount;
        error.most = std::max(error.most, off);
        const double s = unit(random);
        error.jump = std::max(error.jump, angle(rule(p, normals(p), {1.0 - s, s, 0.0}),
                                                rule(q, normals(q), {s, 1.0 - s, 0.0})));
    }
    return error;
}

struct Candidate {
    const char* name;
    Rule rule;
};
const std::vector<Candidate>& candidates() {
    static const std::vector<Candidate> all{
        {"linear", linear}, {"PN", pnTriangle}, {"Phong", phongTessellation}, {"patch", patchNormal}};
    return all;
}

TEST(PatchNormal, TheCandidatesMeasured) {
    constexpr std::array kSizes{0.2, 0.1, 0.05, 0.025};
    std::printf("torus 50/20 mm: mean (largest) error of the normal in degrees; jump over an edge; order of "
                "the mean\n");
    for (const auto& [name, rule] : candidates()) {
        double before = 0.0, order = 0.0, jump = 0.0;
        std::printf("%-7s", name);
        for (const double h : kSizes) {
            const Error error = measured(torus(), h, rule);
            order = before > 0.0 ? std::log2(before / error.mean) : 0.0;
            before = error.mean;
            jump = std::max(jump, error.jump);
            std::printf("  %.5f (%.5f)", error.mean, error.most);
        }
        std::printf("  %.2g  %.2f\n", jump, order);
    }
}

TEST(PatchNormal, IsOfSecondOrderContinuousAndBetterThanInterpolation) {
    for (const double h : {0.2, 0.1, 0.05}) {
        const Error patch = measured(torus(), h, patchNormal), plain = measured(torus(), h, linear);
        EXPECT_LT(patch.mean, plain.mean) << h;
        EXPECT_LE(patch.most, plain.most) << h;
        EXPECT_LT(patch.jump, 1e-12) << "degrees: rounding";
        const Error finer = measured(torus(), 0.5 * h, patchNormal);
        EXPECT_GT(std::log2(patch.mean / finer.mean), 1.9) << h;
        EXPECT_LT(measured(sphere(), h, patchNormal).most, 1e-5) << "as interpolation, exact on a sphere";
    }
}

TEST(PatchNormal, IsOfThirdOrderAlongAnEdge) {
    // A planar curve, y = x^2 + 2 x^3, over [-0.05, h - 0.05]; the truth at the nearest point of the curve.
    const auto normal = [](double x) {
        return glm::normalize(glm::dvec3(-(2.0 * x + 6.0 * x * x), 1.0, 0.0));
    };
    const auto place = [](double x) { return glm::dvec3(x, x * x + 2.0 * x * x * x, 0.0); };
    const auto truthAt = [&](const glm::dvec3& p) {
        double x = p.x;
        for (int i = 0; i < 60; ++i) {
            const glm::dvec3 n = normal(x), tangent(n.y, -n.x, 0.0);
            x += glm::dot(p - place(x), tangent) * tangent.x;
        }
        return normal(x);
    };
    double before[2] = {0.0, 0.0};
    for (const double h : {0.2, 0.1, 0.05, 0.025}) {
        const Three p{place(-0.05), place(h - 0.05), {-0.05, 0.0, 1.0}},
            n{normal(-0.05), normal(h - 0.05), normal(-0.05)};
        double most[2] = {0.0, 0.0};
        for (double s = 0.0; s <= 1.0; s += 0.05) {
            const glm::dvec3 w(1.0 - s, s, 0.0), truth = truthAt(linear({}, p, w));
            most[0] = std::max(most[0], angle(patchNormal(p, n, w), truth));
            most[1] = std::max(most[1], angle(linear(p, n, w), truth));
        }
        if (before[0] > 0.0) {
            EXPECT_GT(std::log2(before[0] / most[0]), 2.7) << h;
            EXPECT_LT(std::log2(before[1] / most[1]), 2.3) << h;
        }
        before[0] = most[0];
        before[1] = most[1];
    }
}

} // namespace
} // namespace touchstone::patch_normal_test
