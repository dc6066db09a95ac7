// What a tick asks a field: its cost, free of the clock.

#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <numbers>
#include <utility>
#include <vector>

namespace touchstone::test::field_queries_test {
namespace {

/// A field that counts sweeps and searches for what is near.
class CountedField final : public Shape {
  public:
    explicit CountedField(std::shared_ptr<const FieldShape> field) : field_(std::move(field)) {}
    [[nodiscard]] int take() const { return std::exchange(queries_, 0); }

    [[nodiscard]] double sweep(const glm::dvec3& centre, double radius, const glm::dvec3& motion,
                               double limit) const noexcept override {
        ++queries_;
        return field_->sweep(centre, radius, motion, limit);
    }
    [[nodiscard]] size_t near(const glm::dvec3& point, double reach,
                              std::span<FeatureDistance> found) const noexcept override {
        ++queries_;
        return field_->near(point, reach, found);
    }
    [[nodiscard]] FeatureDistance distanceFrom(FeatureId feature,
                                               const glm::dvec3& point) const noexcept override {
        return field_->distanceFrom(feature, point);
    }
    [[nodiscard]] bool restNear(const glm::dvec3& from, const glm::dvec3& goal, double distance,
                                glm::dvec3& place) const noexcept override {
        return field_->restNear(from, goal, distance, place);
    }
    [[nodiscard]] glm::dvec3 shadingNormal(FeatureId feature,
                                           const glm::dvec3& point) const noexcept override {
        return field_->shadingNormal(feature, point);
    }
    [[nodiscard]] bool hasShadingNormals() const noexcept override { return true; }
    [[nodiscard]] bool contains(const glm::dvec3& point) const noexcept override {
        return field_->contains(point);
    }
    [[nodiscard]] double boundingRadius() const noexcept override { return field_->boundingRadius(); }
    [[nodiscard]] uint64_t memoryBytes() const noexcept override { return field_->memoryBytes(); }
    [[nodiscard]] uint64_t identity() const noexcept override { return field_->identity(); }

  private:
    std::shared_ptr<const FieldShape> field_;
    mutable int queries_ = 0;
};

/// A torus of 360 x 90 plane facets: kinks within cells, and between them.
double facets(const glm::dvec3& p) {
    const auto nearest = [](double angle, int count) {
        const double step = 2.0 * std::numbers::pi / count;
        return step * std::round(angle / step);
    };
    const double around = nearest(std::atan2(p.y, p.x), 360);
    const double out = p.x * std::cos(around) + p.y * std::sin(around) - 0.3;
    const double tube = nearest(std::atan2(p.z, out), 90);
    return out * std::cos(tube) + p.z * std::sin(tube) - 0.12;
}

/// Kinks that stand above the way of a leap cost a ramp, not a slide with all its lifts: the
/// slowest ticks ask little more than the others (without ramps 15 times at 384 cells).
TEST(FieldQueries, AreFewInSlowTicksToo) {
    constexpr double kUnit = 0.15, kDepth = 0.001; // m
    struct Case {
        int cells;
        bool smooth;
    };
    for (const auto& [cells, smooth] : {Case{96, true}, {384, true}, {192, false}, {384, false}}) {
        const auto counted = std::make_shared<const CountedField>(fieldOf(smooth ? torus : facets, cells));
        FieldBench bench(counted, kUnit);
        // Round the ring and the tube at 0.1 m/s.
        const auto hip = [&](double way, double depth) {
            const double ring = way / (0.42 * kUnit), tube = 0.37 * ring, reach = 0.12 * kUnit - depth;
            const double out = 0.3 * kUnit + reach * std::cos(tube);
            return FieldBench::kMiddle +
                   glm::dvec3(out * std::cos(ring), out * std::sin(ring), reach * std::sin(tube));
        };
        bench.step(hip(0.0, -0.004));
        bench.moveTo(hip(0.0, kDepth), 0.1);
        std::vector<int> queries;
        for (int i = 0; i < 20000; ++i) {
            (void)counted->take();
            bench.step(hip(1e-4 * i, kDepth));
            queries.push_back(counted->take());
        }
        std::ranges::sort(queries);
        const int median = queries[queries.size() / 2], slow = queries[queries.size() * 995 / 1000];
        std::printf("%d cells, %s: median %d, 99.5 %% %d, most %d\n", cells, smooth ? "smooth" : "facets",
                    median, slow, queries.back());
        EXPECT_LE(median, 4);
        EXPECT_LE(slow, 2 * median);
    }
}

} // namespace
} // namespace touchstone::test::field_queries_test
