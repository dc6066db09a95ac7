// A small study from end to end. Times are only asked to be there: what they are is no test's business.

#include "engine/core/error.h"
#include "study/study.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace touchstone::study::study_test {
namespace {

StudyOptions small() {
    StudyOptions options;
    options.errorTicks = 800;
    options.rounds = 3;
    options.ticksPerRound = 300;
    options.largestTriangles = 4096;
    return options;
}

void quietly(const std::string&, double) {}

const ShapeKind& kindNamed(std::string_view name) {
    return *std::find_if(shapeKinds().begin(), shapeKinds().end(),
                         [&](const ShapeKind& kind) { return kind.name == name; });
}

StudyResult studyShape(std::string_view name, size_t triangles = 0) {
    const ShapeKind& kind = kindNamed(name);
    StudyResult result;
    studySubject(kind.make(triangles > 0 ? triangles : kind.triangles), small(), result, quietly);
    return result;
}

const ConfigurationResult& resultOf(const StudyResult& study, std::string_view ablation,
                                    std::string_view configuration) {
    const auto found = std::find_if(study.configurations.begin(), study.configurations.end(),
                                    [&](const ConfigurationResult& r) {
                                        return r.ablation == ablation && r.configuration == configuration;
                                    });
    if (found == study.configurations.end())
        throw std::runtime_error("no configuration " + std::string(ablation) + ", " +
                                 std::string(configuration));
    return *found;
}

TEST(Study, OnThePlaneEverythingThatMovesFreelyIsExact) {
    const StudyResult study = studyShape("plane");
    EXPECT_TRUE(study.problems.empty());
    for (const ConfigurationResult& configuration : study.configurations) {
        EXPECT_EQ(configuration.truth,
                  configuration.ablation == "friction" ? Truth::Coulomb : Truth::Analytic);
        EXPECT_EQ(configuration.errors.ticks, 800u);
        EXPECT_GT(configuration.errors.compared, 500u) << configuration.configuration;
        EXPECT_EQ(configuration.errors.truthFailed, 0u);
        if (configuration.ablation == "friction")
            continue;
        // A point is as thick as half of what was welded: 0.14 µm on a sheet of 0.2 m. Floats are good to
        // less.
        const double finest = configuration.configuration.find("single") != std::string::npos ? 1e-6 : 2.1e-7;
        EXPECT_LT(configuration.errors.position.max, finest)
            << configuration.ablation << ", " << configuration.configuration;
        EXPECT_LT(configuration.errors.force.max, 600.0 * finest)
            << configuration.ablation << ", " << configuration.configuration;
        EXPECT_LT(configuration.errors.forceDirection.p99, 10.0 * finest)
            << configuration.ablation << ", " << configuration.configuration;
        EXPECT_NEAR(configuration.errors.largestJump, configuration.errors.truthJump, 5e-4)
            << configuration.ablation << ", " << configuration.configuration;
    }
    // Ideal friction is 0.3 of 0.6 N; without any that is missing, and every law but the sawtooth comes near
    // it.
    EXPECT_NEAR(resultOf(study, "friction", "off").errors.force.median, 0.18, 1e-3);
    EXPECT_LT(resultOf(study, "friction", "elasto-plastic").errors.force.median, 0.02);
    EXPECT_LT(resultOf(study, "friction", "Ho").errors.force.median, 0.02);
    EXPECT_GT(resultOf(study, "friction", "Zilles").errors.force.p99, 0.03);
    EXPECT_LT(resultOf(study, "friction", "elasto-plastic").errors.energyCreated, 1e-3);
    EXPECT_GT(resultOf(study, "friction", "off").errors.energyCreated, 1e-3)
        << "what friction would have taken";
}

TEST(Study, OnTheSphereShadingBringsTheForceNearerTheTruth) {
    const StudyResult study = studyShape("sphere");
    const Errors flat = resultOf(study, "shading", "off").errors,
                 shaded = resultOf(study, "shading", "two-pass").errors;
    EXPECT_GT(flat.forceDirection.median, 0.01);
    EXPECT_LT(shaded.forceDirection.p99, 0.1 * flat.forceDirection.p99);
    EXPECT_LT(shaded.largestJump, 0.5 * flat.largestJump + shaded.truthJump);
    EXPECT_LT(resultOf(study, "shading", "direction").errors.forceDirection.p99,
              0.1 * flat.forceDirection.p99);
    EXPECT_TRUE(resultOf(study, "shading", "two-pass").isDefault);
    EXPECT_FALSE(resultOf(study, "shading", "off").isDefault);
    EXPECT_GT(resultOf(study, "contact", "sweep r = 0").facetAngle, 0.1);
    EXPECT_LT(resultOf(study, "contact", "sweep r = 0").facetAngle, 0.5);
}

TEST(Study, AMoveATickLagsAndMoreDoNot) {
    const StudyResult study = studyShape("torus");
    const double one = resultOf(study, "budget", "1 move").errors.position.p99;
    const double two = resultOf(study, "budget", "2 moves").errors.position.p99;
    const double all = resultOf(study, "budget", "64 moves").errors.position.p99;
    EXPECT_GT(one, 1.5 * all);
    EXPECT_GE(two, 0.999 * all);
    EXPECT_LT(two, one);
}

TEST(Study, AtTheRidgeTheRestIsWhereTheClosedFormSays) {
    const StudyResult study = studyShape("wedge");
    EXPECT_LT(resultOf(study, "contact", "sweep r = 0").errors.position.max, 2e-7);
    EXPECT_LT(resultOf(study, "contact", "sweep r = 0.5 mm").errors.position.max, 2e-7);
    // Over the ridge the force turns by up to 60 degrees of itself.
    EXPECT_GT(resultOf(study, "contact", "sweep r = 0").errors.truthJump, 0.3);
}

TEST(Study, FinerMeshesAreNearerTheShape) {
    StudyResult study;
    studyTessellation(kindNamed("torus"), small(), study, quietly);
    std::vector<double> angles, errors;
    for (const ConfigurationResult& configuration : study.configurations)
        if (configuration.configuration == "flat") {
            angles.push_back(configuration.facetAngle);
            errors.push_back(configuration.errors.forceDirection.median);
        }
    ASSERT_EQ(angles.size(), 4u); // 512 to 4096 triangles
    EXPECT_NEAR(angles[1] / angles[3], 2.0, 0.3);
    EXPECT_NEAR(errors[1] / errors[3], 2.0, 0.5);
    for (size_t i = 1; i < angles.size(); ++i)
        EXPECT_LT(angles[i], angles[i - 1]);
    EXPECT_EQ(study.configurations[0].shape, "torus");
    EXPECT_NE(study.configurations[0].scene, study.configurations.back().scene);
}

TEST(Study, TellsTimesOfEveryRung) {
    const StudyResult study = studyShape("torus", 2000);
    EXPECT_GE(study.configurations.size(), 30u);
    bool front = false;
    for (const ConfigurationResult& configuration : study.configurations) {
        EXPECT_GT(configuration.step.value, 0.0) << configuration.configuration;
        EXPECT_LE(configuration.step.low, configuration.step.high) << configuration.configuration;
        EXPECT_GT(configuration.stepMean.value, 0.0) << configuration.configuration;
        EXPECT_GE(configuration.stepP99, configuration.step.value) << configuration.configuration;
        EXPECT_GT(configuration.rayFloor, 0.0) << configuration.configuration;
        double sum = 0.0;
        for (const Estimate& stage : configuration.stages)
            sum += stage.value;
        EXPECT_GT(sum, 0.0) << configuration.configuration;
        front |= configuration.pareto;
    }
    EXPECT_TRUE(front);
}

TEST(Study, FindsTheSameErrorsAgain) {
    const StudyResult first = studyShape("waves", 3200), second = studyShape("waves", 3200);
    ASSERT_EQ(first.configurations.size(), second.configurations.size());
    for (size_t i = 0; i < first.configurations.size(); ++i)
        EXPECT_EQ(first.configurations[i].errors, second.configurations[i].errors)
            << first.configurations[i].configuration;
}

TEST(Study, AFileIsComparedWithTheOracle) {
    StudyResult study;
    const Subject subject = loadSubject(std::string(TOUCHSTONE_ASSETS) + "/prism_smooth.glb");
    EXPECT_EQ(subject.shape, "prism_smooth.glb");
    studySubject(subject, small(), study, quietly);
    const ConfigurationResult& exact = resultOf(study, "contact", "sweep r = 0");
    EXPECT_EQ(exact.truth, Truth::Oracle);
    EXPECT_GT(exact.errors.compared, 200u);
    EXPECT_LT(exact.errors.position.p99, 1e-9);
    const ConfigurationResult& shaded = resultOf(study, "shading", "two-pass");
    EXPECT_EQ(shaded.truth, Truth::Reference);
    EXPECT_LT(shaded.errors.force.p99, 1e-9) << "the most exact configuration is its own reference";
    EXPECT_GT(resultOf(study, "shading", "off").errors.force.p99, 0.02);
}

TEST(Study, TextureIsComparedWithTheAblation) {
    StudyResult study;
    studySubject(loadSubject(std::string(TOUCHSTONE_ASSETS) + "/doughnut.glb"), small(), study, quietly);
    EXPECT_EQ(resultOf(study, "texture", "law").truth, Truth::Reference);
    EXPECT_GT(resultOf(study, "texture", "off").errors.force.p99, 0.01);
    EXPECT_LT(resultOf(study, "contact", "sweep r = 0").errors.position.p99, 1e-9)
        << "material and maps have no part in what is compared with the oracle";
}

/// Height maps mean a shape of their own: the law comes within the texels' bend of it.
TEST(Study, ReliefIsComparedWithWhatItsMapMeans) {
    const StudyResult study = studyShape("relief");
    const Errors law = resultOf(study, "texture", "law").errors,
                 off = resultOf(study, "texture", "off").errors;
    EXPECT_EQ(resultOf(study, "texture", "law").truth, Truth::Analytic);
    EXPECT_GT(off.force.median, 0.005);
    EXPECT_LT(law.force.median, 0.05 * off.force.median);
    EXPECT_LT(law.force.max, 0.05 * off.force.max + 1e-4);
    EXPECT_GT(resultOf(study, "texture", "Minsky").errors.force.median, law.force.median);
}

TEST(Study, SaysWhatCannotBeStudied) {
    EXPECT_THROW(static_cast<void>(loadSubject("no such file.glb")), Error);
}

} // namespace
} // namespace touchstone::study::study_test
