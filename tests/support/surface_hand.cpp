#include "tests/support/surface_hand.h"

#include <algorithm>
#include <cmath>

namespace touchstone::test {

namespace {

/// Straight towards `to`, a step at a time.
void append(std::vector<LVec3>& path, const LVec3& to, long double step) {
    const LVec3 from = path.back();
    const int steps = std::max(1, static_cast<int>(std::ceil(glm::length(to - from) / step)));
    for (int i = 1; i <= steps; ++i)
        path.push_back(from + (to - from) * (static_cast<long double>(i) / static_cast<long double>(steps)));
}

} // namespace

SurfaceHand::SurfaceHand(const Soup& soup, double unit, const HandOptions& options, unsigned seed)
    : soup_(soup), unit_(static_cast<long double>(unit)), options_(options), random_(seed) {
    double sum = 0.0;
    for (size_t t = 0; t < soup.triangleCount(); ++t) {
        const Corners c = soup.corners(t);
        if (soup.counts(t))
            sum += static_cast<double>(glm::length(glm::cross(c.b - c.a, c.c - c.a)));
        area_.push_back(sum);
    }
}

std::vector<LVec3> SurfaceHand::stroke() {
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    // Half by area, half by count: dense details are touched as often as large faces.
    size_t t = 0;
    do {
        t = random_() % 2 == 0 ? random_() % area_.size()
                               : static_cast<size_t>(std::lower_bound(area_.begin(), area_.end(),
                                                                      unit(random_) * area_.back()) -
                                                     area_.begin());
        t = std::min(t, area_.size() - 1);
    } while (!soup_.counts(t));
    const Corners c = soup_.corners(t);
    long double u = static_cast<long double>(unit(random_)), v = static_cast<long double>(unit(random_));
    if (u + v > 1.0L) {
        u = 1.0L - u;
        v = 1.0L - v;
    }
    // Each fourth stroke starts beside a corner, each fourth beside an edge. Not on it: straight over a
    // corner, to the last bit, the proxy stands on a knife's edge.
    const auto feature = random_() % 4;
    u *= feature < 2 ? 1e-3L : 1.0L;
    v *= feature < 1 ? 1e-3L : 1.0L;
    LVec3 surface = c.a + u * (c.b - c.a) + v * (c.c - c.a);
    LVec3 normal = glm::cross(c.b - c.a, c.c - c.a);
    const long double area = glm::length(normal);
    normal = area > 0.0L ? normal / area : LVec3(0.0L, 0.0L, 1.0L);
    if (random_() % 4 == 0) // also from behind: sheets, and the inside of hollow things
        normal = -normal;
    const LVec3 across(static_cast<long double>(unit(random_) - 0.5),
                       static_cast<long double>(unit(random_) - 0.5),
                       static_cast<long double>(unit(random_) - 0.5));

    const long double step = static_cast<long double>(options_.speed) * 1e-3L / unit_;
    const long double depth = static_cast<long double>(options_.depth) / unit_;
    const long double height = static_cast<long double>(options_.height) / unit_;
    const int steps = static_cast<int>(options_.length / (options_.speed * 1e-3));
    std::vector<LVec3> path{surface + height * normal};
    append(path, surface - depth * normal, step);
    for (int i = 0; i < steps; ++i) {
        const LVec3 along = across - glm::dot(across, normal) * normal;
        const long double length = glm::length(along);
        if (!(length > 0.0L))
            break;
        // The nearest surface to a point carried along above it.
        const LVec3 above = surface + 0.5L * depth * normal + (step / length) * along;
        const BruteContact next = soup_.nearest(above);
        surface = above - next.distance * next.normal;
        normal = next.distance > 0.0L ? next.normal : normal;
        const long double waver = 0.6L + 0.4L * std::cos(0.9L * static_cast<long double>(i));
        const LVec3 target = surface - depth * waver * normal - path.back();
        const long double far = glm::length(target);
        path.push_back(path.back() + (far > step ? step / far : 1.0L) * target);
    }
    append(path, surface + height * normal, step);
    return path;
}

} // namespace touchstone::test
