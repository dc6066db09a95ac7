#include "study/report/report.h"
#include "tests/unit/study/report/synthetic_study.h"

#include <gtest/gtest.h>

namespace touchstone::study::test {
namespace {

StudyResult shardOf(const std::string& scene) {
    StudyResult shard = everyField();
    shard.rates.clear();
    shard.voxels.clear();
    shard.problems.clear();
    for (ConfigurationResult& configuration : shard.configurations)
        configuration.scene = scene;
    return shard;
}

TEST(MergeStudies, TakesTheRungsOfAllAndWhatTheyShareOnce) {
    const std::vector<StudyResult> shards{shardOf("a.glb"), shardOf("b.glb")};
    const StudyResult all = mergeStudies(shards);
    ASSERT_EQ(all.configurations.size(), 4u);
    for (size_t i = 0; i < 4; ++i)
        EXPECT_EQ(all.configurations[i], shards[i / 2].configurations[i % 2]);
    EXPECT_EQ(all.provenance, shards[0].provenance);
    EXPECT_EQ(all.noticeable, shards[0].noticeable);
    EXPECT_EQ(all.problems, std::vector<std::string>{});
}

TEST(MergeStudies, IsTheSameForOne) {
    const StudyResult one = everyField();
    EXPECT_EQ(mergeStudies({&one, 1}), one);
    EXPECT_EQ(mergeStudies({}), StudyResult{});
}

TEST(MergeStudies, TellsWhatCameTwiceAndWhatWasMeasuredElsewhere) {
    std::vector<StudyResult> shards{shardOf("a.glb"), shardOf("a.glb")};
    shards[1].configurations[0].step.value = 5.0;
    shards[1].provenance.commit = "another";
    shards[1].problems = {"c.glb: is not there"};
    const StudyResult all = mergeStudies(shards);
    EXPECT_EQ(all.configurations, shards[0].configurations);
    ASSERT_EQ(all.problems.size(), 4u);
    EXPECT_NE(all.problems[0].find("another"), std::string::npos);
    EXPECT_NE(all.problems[1].find("twice"), std::string::npos);
    EXPECT_EQ(all.problems[3], "c.glb: is not there");
    EXPECT_EQ(all.notes.size(), shards[0].notes.size() + shards[1].notes.size());
}

TEST(MergeStudies, TakesTheVoxelsOfAllAndTellsWhichCameTwice) {
    std::vector<StudyResult> shards{shardOf("a.glb"), shardOf("b.glb")};
    VoxelResult coarse;
    coarse.shape = "torus";
    coarse.across = 64.0;
    VoxelResult fine = coarse;
    fine.across = 128.0;
    shards[0].voxels = {coarse};
    shards[1].voxels = {fine, coarse};
    const StudyResult all = mergeStudies(shards);
    EXPECT_EQ(all.voxels, (std::vector<VoxelResult>{coarse, fine}));
    ASSERT_EQ(all.problems.size(), 1u);
    EXPECT_NE(all.problems[0].find("torus"), std::string::npos);
}

} // namespace
} // namespace touchstone::study::test
