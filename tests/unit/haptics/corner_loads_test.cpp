// Random hollow corners of one to three walls: elastic force, friction and energy of a round against closed
// forms, through the whole tick.

#include "tests/support/corner.h"
#include "tests/support/touch_bench.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace touchstone::test::corner_loads_test {
namespace {

constexpr double kPi = 3.141592653589793, kRadius = kCornerRadius;

/// Walls with random normals whose least singular value is at least 0.1, and random materials.
std::vector<Wall> randomWalls(std::mt19937& random, size_t count) {
    std::normal_distribution<double> normal;
    std::uniform_real_distribution<float> unit(0.0f, 1.0f);
    for (;;) {
        std::vector<Wall> walls(count);
        std::vector<glm::dvec3> normals;
        for (Wall& wall : walls) {
            wall.normal = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
            wall.stiffness = 100.0f * std::pow(15.0f, unit(random));
            wall.staticFriction = unit(random) < 0.3f ? 0.0f : unit(random);
            wall.dynamicFriction = wall.staticFriction * unit(random);
            normals.push_back(wall.normal);
        }
        if (minSingularValue(normals) >= 0.11)
            return walls;
    }
}

/// A way out of the hollow, m from its apex: every wall is below it.
glm::dvec3 inTheOpen(const std::vector<glm::dvec3>& normals, double distance) {
    std::vector<glm::dvec3> independent = normals;
    glm::dvec3 out(0.0);
    // The point that is equally far above all walls.
    if (normals.size() == 3)
        out = glm::inverse(glm::transpose(glm::dmat3(normals[0], normals[1], normals[2]))) * glm::dvec3(1.0);
    else
        for (const glm::dvec3& n : normals)
            out += n;
    return distance * glm::normalize(out);
}

/// A smooth closed curve round the apex, about 2 mm wide, that dips into walls, edges and corner.
struct Wander {
    std::array<glm::dvec3, 3> amplitude;
    explicit Wander(std::mt19937& random) {
        std::normal_distribution<double> normal;
        for (glm::dvec3& a : amplitude)
            a = 1e-3 * glm::dvec3(normal(random), normal(random), normal(random));
    }
    [[nodiscard]] glm::dvec3 at(double turn) const {
        const double a = 2.0 * kPi * turn;
        return amplitude[0] * std::cos(a) + amplitude[1] * std::sin(a) +
               amplitude[2] * std::sin(2.0 * a + 1.0);
    }
};

TEST(CornerLoads, InRandomCornersTheElasticForceIsTheClosedFormContinuousAndPulledByNobody) {
    std::mt19937 random(20261122);
    double worst = 0.0, steepest = 0.0;
    std::array<int, 4> held{};
    for (int trial = 0; trial < 120; ++trial) {
        std::vector<Wall> walls = randomWalls(random, 1 + static_cast<size_t>(trial) % 3);
        TouchBench bench(cornerScene(walls), cornerSettings());
        const Corner corner = cornerOf(*bench.scene);
        const std::vector<glm::dvec3>& normals = corner.normals;
        // |N_s K N_s^+| <= |N_s| max k / sigma(N_s), for the walls of every subset s.
        double hardest = 0.0;
        for (const Wall& wall : walls)
            hardest = std::max(hardest, static_cast<double>(wall.stiffness));
        const double lipschitz =
            hardest * std::sqrt(static_cast<double>(walls.size())) / minSingularValue(normals);
        const Wander path(random);
        bench.step(inTheOpen(normals, 0.02));
        bench.moveTo(path.at(0.0), 0.1);
        glm::dvec3 last = bench.output.force, lastHip = bench.output.hip;
        for (int i = 1; i <= 3000; ++i) {
            const glm::dvec3 hip = path.at(i / 3000.0);
            const glm::dvec3 force = bench.step(hip).force;
            const CornerSolve solve = solveCorner(corner, kRadius, hip);
            ++held[static_cast<size_t>(solve.count)];
            worst = std::max(worst, glm::distance(force, elasticOf(normals, walls, solve)));
            const double step = glm::distance(hip, lastHip), jump = glm::distance(force, last);
            EXPECT_LE(jump, lipschitz * step + 1e-9);
            steepest = std::max(steepest, jump / (lipschitz * step + 1e-9));
            std::vector<glm::dvec3> holding;
            for (size_t k = 0; k < walls.size(); ++k)
                if (solve.load[k] > 0.0)
                    holding.push_back(normals[k]);
            if (!holding.empty()) {
                for (const double share : coefficients(holding, force))
                    EXPECT_GE(share, -1e-9) << "pulls";
            }
            last = force;
            lastHip = hip;
        }
    }
    // The proxy keeps a gap of 1e-12 object units (0.3 pm), which k / sigma makes 5 nN of.
    EXPECT_LT(worst, 5e-9) << "N off the closed form";
    for (size_t planes = 0; planes <= 3; ++planes)
        EXPECT_GT(held[planes], 1000) << planes << " planes";
    printf("corners: %.2g N off the closed form, jumps at most %.2f of L times the step\n", worst, steepest);
}

TEST(CornerLoads, InRandomCornersFrictionStaysInsideTheSumOfTheCones) {
    std::mt19937 random(20261123);
    double fullest = 0.0;
    for (int trial = 0; trial < 90; ++trial) {
        std::vector<Wall> walls = randomWalls(random, 1 + static_cast<size_t>(trial / 3) % 3);
        const bool viscous = trial % 2 == 0;
        for (Wall& wall : walls)
            wall.viscousFriction = viscous && wall.staticFriction > 0.0f ? 2.0f : 0.0f;
        HapticSettings s = cornerSettings();
        s.friction = std::array{FrictionMode::Zilles, FrictionMode::Ho,
                                FrictionMode::Elastoplastic}[static_cast<size_t>(trial) % 3];
        TouchBench bench(cornerScene(walls), s);
        const Corner corner = cornerOf(*bench.scene);
        const std::vector<glm::dvec3>& normals = corner.normals;
        const Wander path(random);
        bench.step(inTheOpen(normals, 0.02));
        bench.moveTo(path.at(0.0), 0.1);
        for (int i = 1; i <= 2000; ++i) {
            const glm::dvec3 hip = path.at(i / 2000.0);
            const HapticOutput& out = bench.step(hip);
            const CornerSolve solve = solveCorner(corner, kRadius, hip);
            const glm::dvec3 held = out.force - elasticOf(normals, walls, solve);
            const double friction = glm::length(held);
            // The extent of the friction disks along it; of one alone its radius, also where the place that
            // is held stands at another wall.
            double bound = 0.0;
            for (size_t k = 0; k < walls.size() && friction > 0.0; ++k) {
                const double along = glm::length(held - glm::dot(held, normals[k]) * normals[k]) / friction;
                bound += static_cast<double>(walls[k].staticFriction * walls[k].stiffness) * solve.load[k] *
                         (solve.count > 1 && !viscous ? along : 1.0);
            }
            EXPECT_LE(friction, bound + 1e-8) << settingValue(s, "friction") << " tick " << i;
            if (bound > 1e-3)
                fullest = std::max(fullest, friction / bound);
        }
    }
    EXPECT_GT(fullest, 0.99);
    printf("corners: friction at most %.6f of the sum of the cones\n", fullest);
}

/// [v]_x w = (A - A^T) w / 2 for the matrix A of a linear force field F = A (p - h): its curl is 2 v.
glm::dvec3 halfCurl(const glm::dmat3& a) {
    return 0.5 * glm::dvec3(a[1][2] - a[2][1], a[2][0] - a[0][2], a[0][1] - a[1][0]);
}

/// A = N K N^+ of the walls in `set`.
glm::dmat3 stiffnessOf(const std::vector<glm::dvec3>& normals, const std::vector<Wall>& walls, unsigned set) {
    std::vector<glm::dvec3> chosen;
    std::vector<double> k;
    for (size_t i = 0; i < walls.size(); ++i)
        if (set >> i & 1u) {
            chosen.push_back(normals[i]);
            k.push_back(static_cast<double>(walls[i].stiffness));
        }
    glm::dmat3 matrix(0.0);
    for (int column = 0; column < 3; ++column) {
        glm::dvec3 unit(0.0);
        unit[column] = 1.0;
        const std::vector<double> lambda = coefficients(chosen, unit);
        for (size_t i = 0; i < chosen.size(); ++i)
            matrix[column] += k[i] * lambda[i] * chosen[i];
    }
    return matrix;
}

/// J that the hand is given on one round of a circle, by the trapezium rule.
double workOfRound(TouchBench& bench, const glm::dvec3& centre, const glm::dvec3& a, const glm::dvec3& b,
                   int ticks) {
    glm::dvec3 last = bench.step(centre + a).force, lastHip = bench.output.hip;
    double work = 0.0;
    for (int i = 1; i <= ticks; ++i) {
        const double turn = 2.0 * kPi * i / ticks;
        const glm::dvec3 force = bench.step(centre + std::cos(turn) * a + std::sin(turn) * b).force;
        work += 0.5 * glm::dot(last + force, bench.output.hip - lastHip);
        last = force;
        lastHip = bench.output.hip;
    }
    return work;
}

TEST(CornerLoads, ARoundInAGrooveGivesTheEnergyOfTheCurlAndNoneWhereStiffnessesAreEqual) {
    // dW = curl F . dS; in the groove |curl F| = |k1 - k2| |cot a|, a the angle between the walls.
    for (const double angle : {1.0, 0.5 * kPi, 2.2})
        for (const auto& [left, right] : {std::pair{300.0f, 900.0f}, std::pair{600.0f, 600.0f}}) {
            const std::vector<Wall> walls = groove(angle, left, right);
            TouchBench bench(cornerScene(walls), cornerSettings());
            const double r = 4e-4;
            bench.step({0.0, 0.01, 0.0});
            bench.moveTo({0.0, -0.006, 0.0}, 0.05); // both walls hold it all the way round
            const double work = workOfRound(bench, {0.0, -0.006, 0.0}, {r, 0, 0}, {0, r, 0}, 4000);
            const double expected = std::abs(static_cast<double>(left) - static_cast<double>(right)) /
                                    std::abs(std::tan(angle)) * kPi * r * r;
            EXPECT_NEAR(std::abs(work), expected, 1e-5 * expected + 1e-12) << angle << " rad, " << left;
        }
}

TEST(CornerLoads, ARoundInARandomCornerGivesNoMoreThanTheCurlTimesItsArea) {
    std::mt19937 random(20261124);
    std::uniform_real_distribution<double> unit(0.0, 1.0);
    std::normal_distribution<double> normal;
    double most = 0.0;
    for (int trial = 0; trial < 60; ++trial) {
        std::vector<Wall> walls = randomWalls(random, 1 + static_cast<size_t>(trial) % 3);
        const bool equal = trial % 2 == 0;
        for (Wall& wall : walls) {
            if (equal)
                wall.stiffness = walls[0].stiffness;
            wall.staticFriction = wall.dynamicFriction = 0.0f;
        }
        TouchBench bench(cornerScene(walls), cornerSettings());
        const Corner corner = cornerOf(*bench.scene);
        const std::vector<glm::dvec3>& normals = corner.normals;
        double curl = 0.0;
        for (unsigned set = 1; set < 1u << walls.size(); ++set)
            curl = std::max(curl, 2.0 * glm::length(halfCurl(stiffnessOf(normals, walls, set))));
        const glm::dvec3 a = glm::normalize(glm::dvec3(normal(random), normal(random), normal(random)));
        const glm::dvec3 b =
            glm::normalize(glm::cross(a, glm::dvec3(normal(random), normal(random), normal(random))));
        const double r = 5e-4 + 1e-3 * unit(random);
        const glm::dvec3 centre = -1e-3 * unit(random) * inTheOpen(normals, 1.0);
        bench.step(inTheOpen(normals, 0.02));
        bench.moveTo(centre + r * a, 0.1);
        const double work = workOfRound(bench, centre, r * a, r * b, 4000);
        // The trapezium rule misses at most L h^2 / 4 where the loop crosses from walls to walls.
        const double rule = 1e-9;
        EXPECT_LE(std::abs(work), curl * kPi * r * r + rule) << "curl " << curl;
        if (equal) {
            EXPECT_LE(std::abs(work), rule);
        } else if (curl > 1.0) {
            most = std::max(most, std::abs(work) / (curl * kPi * r * r));
        }
    }
    EXPECT_GT(most, 0.2) << "no loop came near the bound";
}

} // namespace
} // namespace touchstone::test::corner_loads_test
