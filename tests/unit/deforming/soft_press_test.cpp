// A hand that presses what gives way exactly where many facets meet: at vertices, on edges and in facets.
#include "tests/unit/deforming/soft_bench.h"

namespace touchstone::test::soft_press_test {
namespace {

/// Down onto `place` (workspace) from 6 mm above it, `depth` m deep, a rest there, and up again.
struct Press {
    glm::dvec3 place{0.0};
    double speed = 0.1, depth = 0.004; ///< m/s, m
};

/// The force at the end of the rest, N.
double press(SoftBench& bench, const Press& how) {
    constexpr double kAbove = 0.006;
    const auto at = [&](double below) {
        return bench.tick(how.place - glm::dvec3(0.0, below, 0.0), 1e-3 * static_cast<double>(bench.count++))
            .force.y;
    };
    const auto steps = static_cast<int>(std::ceil((kAbove + how.depth) / (1e-3 * how.speed)));
    for (int k = 0; k <= steps; ++k)
        (void)at(-kAbove + (kAbove + how.depth) * k / steps);
    double force = 0.0;
    for (int k = 0; k < 250; ++k)
        force = at(how.depth);
    for (int k = steps; k >= 0; --k)
        (void)at(-kAbove + (kAbove + how.depth) * k / steps);
    return force;
}

/// Of a soft body as it rests: its highest vertex, and around it neighbours, the middles of edges and of a
/// facet, and places so near to the vertex that the proxy touches all of its facets.
std::vector<glm::dvec3> placesOf(const SoftBench& bench) {
    const std::vector<glm::dvec3> at = bench.vertices();
    const auto& indices = bench.haptic->objects[bench.hand.world.soft()->shown()[0].object]->indices;
    const auto highest = [](const glm::dvec3& a, const glm::dvec3& b) { return a.y < b.y; };
    const auto top = static_cast<uint32_t>(std::ranges::max_element(at, highest) - at.begin());
    std::vector<glm::dvec3> places{at[top], at[top] + glm::dvec3(1e-4, 0.0, 3e-5),
                                   at[top] + glm::dvec3(0.0, 0.0, 1e-3)};
    for (size_t i = 0; i + 2 < indices.size(); i += 3) {
        const auto corner = std::ranges::find(indices.begin() + static_cast<ptrdiff_t>(i),
                                              indices.begin() + static_cast<ptrdiff_t>(i + 3), top);
        if (corner == indices.begin() + static_cast<ptrdiff_t>(i + 3))
            continue;
        const auto k = static_cast<size_t>(corner - indices.begin()) - i;
        const glm::dvec3 &b = at[indices[i + (k + 1) % 3]], &c = at[indices[i + (k + 2) % 3]];
        places.push_back(b);
        places.push_back(0.5 * (at[top] + b));
        places.push_back(0.5 * (b + c));
        places.push_back((at[top] + b + c) / 3.0);
        break;
    }
    return places;
}

/// The jelly's pole has 32 facets, as many as a tick kept of those that stopped it: pressed there, the
/// surface that came back was a jam that let the hand in.
TEST(SoftPress, AHandOnAVertexOrAnEdgeStaysOutside) {
    SoftBench bench(calmJelly(), touchedWith(0.001, 0.0), true);
    const glm::dvec3 away{0.0, kTop + 0.03, 0.0};
    bench.wait(1.0, away);
    for (const glm::dvec3& place : placesOf(bench))
        for (const double speed : {0.05, 0.17, 0.5})
            for (const double depth : {0.002, 0.004, 0.012}) {
                const size_t jams = bench.report.jams;
                const double force = press(bench, {place, speed, depth});
                EXPECT_GT(force, 0.01) << place.x << ' ' << place.z << ", " << speed << " m/s, " << depth;
                EXPECT_EQ(bench.report.jams, jams)
                    << place.x << ' ' << place.z << ", " << speed << " m/s, " << depth;
                bench.wait(0.3, away);
            }
    EXPECT_EQ(bench.report.starts, 1u) << "touch was lost";
    expectExact(bench.report, "jelly, pressed at vertices and edges");
}

/// Over a ball, so that the proxy has the cloth over it and the ball under that.
TEST(SoftPress, AHandOnAClothStaysOutside) {
    SoftBench bench(kCloth, touchedWith(0.001, 0.0), false);
    const glm::dvec3 away{0.0, 0.05, 0.0};
    bench.wait(1.0, away);
    for (const glm::dvec3& place : placesOf(bench)) {
        const size_t jams = bench.report.jams;
        EXPECT_GT(press(bench, {place, 0.17, 0.004}), 0.01) << place.x << ' ' << place.z;
        EXPECT_EQ(bench.report.jams, jams) << place.x << ' ' << place.z;
        bench.wait(0.3, away);
    }
    EXPECT_EQ(bench.report.starts, 1u) << "touch was lost";
    expectExact(bench.report, "cloth, pressed at vertices and edges");
}

} // namespace
} // namespace touchstone::test::soft_press_test
