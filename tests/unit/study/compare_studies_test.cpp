#include "study/compare_studies.h"

#include <gtest/gtest.h>

namespace touchstone::study::compare_studies_test {
namespace {

StudyResult studyOf(std::vector<Estimate> steps) {
    StudyResult study;
    for (const Estimate& step : steps) {
        ConfigurationResult& configuration = study.configurations.emplace_back();
        configuration.scene = "torus";
        configuration.ablation = "contact";
        configuration.configuration = std::to_string(study.configurations.size());
        configuration.step = step;
    }
    return study;
}

TEST(CompareStudies, CountsPairsThatChangedPlaces) {
    const StudyResult first = studyOf({{100, 98, 102}, {110, 108, 112}, {111, 109, 114}});
    const OrderKept same = compareOrder(first, first);
    EXPECT_EQ(same.matched, 3u);
    EXPECT_EQ(same.pairs, 3u);
    EXPECT_EQ(same.apart, 2u);
    EXPECT_TRUE(same.swapped.empty());
    // The overlapping pair may change places; the first may not fall behind the second.
    const OrderKept turned =
        compareOrder(first, studyOf({{120, 118, 122}, {119, 117, 121}, {118, 116, 120}}));
    EXPECT_EQ(turned.swapped.size(), 2u);
    EXPECT_EQ(turned.bothApart, 0u);
    const OrderKept clearly = compareOrder(first, studyOf({{120, 118, 122}, {90, 89, 91}, {130, 128, 132}}));
    EXPECT_EQ(clearly.swapped, std::vector<std::string>{"torus, contact: 1 and 2"});
    EXPECT_EQ(clearly.swappedApart, 1u);
}

TEST(CompareStudies, MatchesRungsByWhatTheyAre) {
    StudyResult second = studyOf({{100, 98, 102}, {90, 88, 92}});
    second.configurations[1].scene = "sphere";
    second.configurations[0].errors.position.max = 1.0;
    const OrderKept kept = compareOrder(studyOf({{100, 98, 102}, {110, 108, 112}}), second);
    EXPECT_EQ(kept.matched, 1u);
    EXPECT_EQ(kept.onlyInOne, 2u);
    EXPECT_EQ(kept.pairs, 0u);
    EXPECT_EQ(kept.errorsChanged, 1u);
}

} // namespace
} // namespace touchstone::study::compare_studies_test
