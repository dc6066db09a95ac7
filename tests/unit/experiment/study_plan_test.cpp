// Studies as JSON: the paper's, a lab's own, and what is refused.

#include "engine/core/error.h"
#include "experiment/plan/study_plan.h"

#include <gtest/gtest.h>

#include <map>
#include <set>
#include <string>

namespace touchstone::experiment {
namespace {

std::string replaced(std::string text, const std::string& what, const std::string& by) {
    const size_t at = text.find(what);
    EXPECT_NE(at, std::string::npos) << what;
    return text.replace(at, what.size(), by);
}

std::string problemOf(const std::string& text) {
    try {
        (void)parseStudy(text, "lab.json");
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

const std::string kPaper(paperStudy());

TEST(StudyPlan, OfThePaperHasItsConditions) {
    const StudyPlan plan = parseStudy(kPaper, "paper");
    ASSERT_EQ(plan.conditions.size(), 6u);
    EXPECT_EQ(plan.selected(false).size(), 4u);
    EXPECT_EQ(plan.selected(true).size(), 2u);
    const auto& c4 = std::get<PlanarStimulus>(plan.conditions[3].comparison);
    EXPECT_EQ(c4.rendering.force, PlanarForce::Facets);
    EXPECT_EQ(c4.rendering.location, PlanarLocation::Bezier);
    EXPECT_EQ(plan.conditions[0].rule.reversals, 11u);
    EXPECT_EQ(plan.conditions[0].rule.largeReversals, 3u);
    EXPECT_EQ(plan.conditions[0].rule.averaged, 6u);
}

/// Each condition at each place once in four people, and after each other one once.
TEST(StudyPlan, OrdersConditionsByALatinSquare) {
    const StudyPlan plan = parseStudy(kPaper, "paper");
    std::map<std::pair<size_t, size_t>, int> places, follow;
    for (size_t person = 0; person < 4; ++person) {
        const std::vector<size_t> order = plan.orderFor(person);
        ASSERT_EQ(order.size(), 4u);
        for (size_t i = 0; i < order.size(); ++i) {
            ++places[{i, order[i]}];
            if (i > 0)
                ++follow[{order[i - 1], order[i]}];
        }
    }
    EXPECT_EQ(places.size(), 16u);
    EXPECT_EQ(follow.size(), 12u);
    EXPECT_EQ(plan.orderFor(4), plan.orderFor(0));
    EXPECT_EQ(plan.orderFor(0, true), (std::vector<size_t>{4, 5}));
}

TEST(StudyPlan, SaysWhatIsWrongAndWhere) {
    EXPECT_NE(problemOf("{").find("no JSON"), std::string::npos);
    EXPECT_NE(problemOf("[]").find("no object"), std::string::npos);
    EXPECT_NE(problemOf("{}").find("no study"), std::string::npos);
    EXPECT_NE(
        problemOf(replaced(kPaper, "\"touchstoneStudy\": 1", "\"touchstoneStudy\": 2")).find("version 2"),
        std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"largeStep\": 16", "\"largeStep\": -16")).find("conditions[0]"),
              std::string::npos);
    EXPECT_NE(
        problemOf(replaced(kPaper, "\"largeStep\": 16", "\"bigStep\": 16")).find("unknown member 'bigStep'"),
        std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"start\": 20", "\"start\": 20.5")).find("whole"),
              std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"force\": \"shaded\"", "\"force\": \"round\""))
                  .find("facets, shaded, bezier"),
              std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"name\": \"C2\"", "\"name\": \"C1\"")).find("second condition"),
              std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"radius\": 0.1", "\"radius\": 1e999")).find("lab.json"),
              std::string::npos);
    EXPECT_NE(problemOf(replaced(kPaper, "\"reversals\": 11", "\"reversals\": 5")).find("averages more"),
              std::string::npos);
}

std::string ownCurves(const std::string& comparison) {
    return R"({"touchstoneStudy": 1, "name": "own", "question": "Which?", "conditions": [{"name": "A",
        "reference": {"points": [[-0.05, 0], [0.05, 0]]}, "comparison": )" +
           comparison + R"(, "vary": "nothing", "trials": 10}]})";
}

/// Polylines of one point, edges of no length, spikes.
TEST(StudyPlan, RefusesPolylinesThatAreNone) {
    EXPECT_EQ(problemOf(ownCurves(R"({"points": [[-0.05, 0], [0, 0.01], [0.05, 0]]})")), "");
    EXPECT_EQ(problemOf(ownCurves(R"({"points": [[-0.05, 0], [-0.05, 0], [0, 0.01], [0.05, 0]]})")), "")
        << "an edge of no length";
    EXPECT_NE(problemOf(ownCurves(R"({"points": [[0, 0]]})")).find("conditions[0].comparison"),
              std::string::npos);
    EXPECT_NE(problemOf(ownCurves(R"({"points": [[0, 0], [0, 0]]})")).find("1 places"), std::string::npos);
    EXPECT_NE(problemOf(ownCurves(R"({"points": [[0, 0], [0.1, 0], [0, 0]]})")).find("turns back"),
              std::string::npos);
    EXPECT_NE(problemOf(ownCurves(R"({"points": [[0, 0], [1]]})")).find("point 1"), std::string::npos);
    EXPECT_NE(problemOf(ownCurves(R"({"points": [[0, 0], [1e9, 0]]})")).find("1000 km"), std::string::npos);
    EXPECT_NE(problemOf(ownCurves(R"({"model": "missing.glb"})")).find("missing.glb"), std::string::npos);
}

} // namespace
} // namespace touchstone::experiment
