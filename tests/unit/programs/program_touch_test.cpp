// What programs make of a contact: closed forms and bounds.

#include "haptics/program/program_touch.h"
#include "program_bench.h"
#include "tests/support/allocation_counter.h"

#include <random>

namespace touchstone::program {
namespace {

ProgramContact contactAt(const glm::dvec3& position, double depth) {
    return {.position = position,
            .depth = depth,
            .stiffness = 600.0,
            .damping = 1.0,
            .staticFriction = 0.4,
            .dynamicFriction = 0.3,
            .maxStiffness = 3000.0};
}

void expectNear(const glm::dvec3& got, const glm::dvec3& wanted, double tolerance) {
    EXPECT_LT(glm::length(got - wanted), tolerance) << got.x << " " << got.y << " " << got.z << " instead of "
                                                    << wanted.x << " " << wanted.y << " " << wanted.z;
}

TEST(ProgramTouch, AProgramThatDoesNothingIsThePlainSurface) {
    const RegisterProgram program = programOf(touchBody(""));
    for (const auto gradient : {ProgramGradient::Dual, ProgramGradient::Central, ProgramGradient::None}) {
        const ProgramFelt felt = feelProgram(program, gradient, contactAt({0.1, 0.2, 0.3}, 0.004));
        EXPECT_EQ(felt.ending, Ending::Finished);
        expectNear(felt.force, {0.0, 0.0, 2.4}, 1e-6);
        EXPECT_EQ(felt.stiffness, 600.0);
        EXPECT_NEAR(felt.staticFriction, 0.4, 1e-7);
        EXPECT_NEAR(felt.dynamicFriction, 0.3, 1e-7);
        EXPECT_EQ(felt.height, 0.0);
    }
}

/// F = -grad U of U = k/2 (d + h)^2 with d = z0 - z, h = a sin(w x).
TEST(ProgramTouch, ADisplacementGivesTheForceOfItsPotential) {
    const RegisterProgram program =
        programOf(touchBody("after.position.z += 2e-4 * sin(400.0 * before.position.x);"));
    for (int i = 0; i < 200; ++i) {
        const double x = static_cast<double>(static_cast<float>(1e-4 * i)), depth = 0.003;
        const double height = 2e-4 * std::sin(400.0 * x), slope = 0.08 * std::cos(400.0 * x);
        const glm::dvec3 wanted = 600.0 * (depth + height) * glm::dvec3(-slope, 0.0, 1.0);
        const ProgramFelt dual = feelProgram(program, ProgramGradient::Dual, contactAt({x, 0, 0}, depth));
        expectNear(dual.force, wanted, 1e-5);
        EXPECT_NEAR(dual.height, height, 1e-9);
        ProgramContact contact = contactAt({x, 0, 0}, depth);
        expectNear(feelProgram(program, ProgramGradient::Central, contact).force, wanted, 1e-3);
        expectNear(feelProgram(program, ProgramGradient::None, contact).force,
                   {0.0, 0.0, 600.0 * (depth + height)}, 1e-5);
    }
}

/// Round (x, d) across the limit of the displacement: dW = F_x dx - F_n dd, by the trapezoid rule.
TEST(ProgramTouch, AClosedPathAcrossTheLimitDoesNoWork) {
    const RegisterProgram program = programOf(touchBody("after.position.z += 0.2 * before.position.x;"));
    constexpr int kSteps = 4000;
    glm::dvec2 place{0.0}, force{0.0};
    double work = 0.0, least = 1.0, greatest = 0.0;
    for (int i = 0; i <= kSteps; ++i) {
        const double angle = 2.0 * 3.14159265358979323846 * i / kSteps;
        const glm::dvec2 next{0.012 + 0.01 * std::cos(angle), 0.003 + 0.001 * std::sin(angle)};
        const ProgramFelt felt =
            feelProgram(program, ProgramGradient::Dual, contactAt({next.x, 0, 0}, next.y));
        const glm::dvec2 here{felt.force.x, -felt.force.z};
        if (i > 0)
            work += 0.5 * glm::dot(force + here, next - place);
        place = next;
        force = here;
        least = std::min(least, 0.2 * next.x / next.y);
        greatest = std::max(greatest, 0.2 * next.x / next.y);
    }
    EXPECT_LT(least, 0.5);
    EXPECT_GT(greatest, 1.0); // across the limit
    EXPECT_LT(std::abs(work), 1e-7);
}

/// Model metres are not workspace metres: a model of 1 m shown 0.1 m long.
TEST(ProgramTouch, ADisplacementScalesWithTheModel) {
    const RegisterProgram program = programOf(touchBody("after.position.z += 0.01 * before.position.x;"));
    ProgramContact contact = contactAt({0.2, 0.0, 0.0}, 0.003);
    contact.modelPerWorkspace = 10.0;
    const ProgramFelt felt = feelProgram(program, ProgramGradient::Dual, contact);
    EXPECT_NEAR(felt.height, 2e-4, 1e-8);
    expectNear(felt.force, 600.0 * 0.0032 * glm::dvec3(-0.01, 0.0, 1.0), 1e-5);
}

TEST(ProgramTouch, AChangedStiffnessScalesTheForceThatIsReturned) {
    const ProgramFelt felt =
        feelProgram(programOf(touchBody("after.stiffness = 900.0; after.force = before.force * 1.2;")),
                    ProgramGradient::Dual, contactAt({0, 0, 0}, 0.002));
    EXPECT_EQ(felt.stiffness, 900.0);
    expectNear(felt.force, {0.0, 0.0, 1.2 * 900.0 * 0.002}, 1e-6);
}

TEST(ProgramTouch, APerturbedNormalTurnsTheForce) {
    const ProgramFelt felt = feelProgram(programOf(touchBody("after.normal = vec3(3.0, 0.0, 4.0);")),
                                         ProgramGradient::Dual, contactAt({0, 0, 0}, 0.002));
    expectNear(felt.force, 1.2 * glm::dvec3(0.6, 0.0, 0.8), 1e-6);
}

TEST(ProgramTouch, BoundsHoldWhateverIsReturned) {
    const struct {
        const char* body;
        glm::dvec3 force;
    } cases[] = {
        {"after.force = -before.force;", {0.0, 0.0, 0.0}},
        {"after.force = vec3(1.0, 0.0, -5.0);", {1.0, 0.0, 0.0}},
        {"after.force = before.force * 1e30;", {0.0, 0.0, kMaxProgramGain * 1.2}},
        {"after.position.z += 1.0;", {0.0, 0.0, 4.8}}, // U = k/2 (2 d)^2
        {"after.position.z -= 1.0;", {0.0, 0.0, 0.0}},
        {"after.stiffness = -1.0;", {0.0, 0.0, 0.0}},
        {"after.stiffness = 1e9;", {0.0, 0.0, 6.0}}, // the device's 3000 N/m
        {"after.normal = vec3(0.0);", {0.0, 0.0, 1.2}},
        {"after.force = vec3(1.0 / before.uv.x);", {0.0, 0.0, 1.2}}, // flagged, plain
        {"for (int i = 0; i < 1000000; i++) after.force.x += 1.0 + before.force.x;", {0.0, 0.0, 1.2}},
    };
    for (const auto& one : cases)
        for (const auto gradient : {ProgramGradient::Dual, ProgramGradient::Central}) {
            const ProgramFelt felt =
                feelProgram(programOf(touchBody(one.body)), gradient, contactAt({0, 0, 0}, 0.002));
            SCOPED_TRACE(one.body);
            expectNear(felt.force, one.force, 1e-5);
        }
    const ProgramFelt felt =
        feelProgram(programOf(touchBody("after.staticFriction = 0.2; after.dynamicFriction = 0.9; "
                                        "after.damping = -4.0;")),
                    ProgramGradient::Dual, contactAt({0, 0, 0}, 0.002));
    EXPECT_NEAR(felt.staticFriction, 0.2, 1e-7);
    EXPECT_EQ(felt.dynamicFriction, felt.staticFriction);
    EXPECT_EQ(felt.damping, 0.0);
}

TEST(ProgramTouch, NoForceOfAWildProgramPullsOrPassesItsBound) {
    const RegisterProgram program = programOf(
        touchBody("vec3 p = before.position; after.force = 1e3 * sin(p * 1e3) + before.force * p.x;"
                  "after.position += tan(p.yzx * 50.0); after.normal = cos(p.zxy * 77.0);"
                  "after.stiffness = 5e3 * sin(p.x * 90.0); after.staticFriction = 1e3 * sin(p.y * 33.0);"
                  "after.dynamicFriction = 1.0 / p.z;"));
    std::mt19937 random(5);
    std::uniform_real_distribution<double> place(-1.0, 1.0);
    const uint64_t before = test::allocationsOnThisThread();
    for (int i = 0; i < 20000; ++i) {
        const ProgramContact contact =
            contactAt({place(random), place(random), place(random)}, std::abs(place(random)) * 0.01);
        const ProgramFelt felt = feelProgram(program, ProgramGradient::Dual, contact);
        ASSERT_GE(felt.force.z, -1e-9);
        ASSERT_LE(glm::length(felt.force), kMaxProgramGain * 3000.0 * contact.depth * (1.0 + 1e-9));
        ASSERT_GE(felt.staticFriction, felt.dynamicFriction);
        ASSERT_GE(felt.dynamicFriction, 0.0);
        ASSERT_TRUE(std::isfinite(felt.staticFriction));
    }
    EXPECT_EQ(test::allocationsOnThisThread(), before);
}

} // namespace
} // namespace touchstone::program
