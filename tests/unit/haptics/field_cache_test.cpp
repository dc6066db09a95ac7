// A field out of the cache is the one that was built, and no file in its folder can make it another one.

#include "haptics/shape/field/field_cache.h"
#include "haptics/shape/field/mesh_to_field.h"
#include "tests/support/program.h"
#include "tests/unit/haptics/field_bench.h"

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>
#include <string>

namespace touchstone::test::field_cache_test {
namespace {

namespace fs = std::filesystem;

std::string bytesOf(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

void write(const fs::path& file, const std::string& bytes) {
    std::ofstream(file, std::ios::binary) << bytes;
}

class FieldCacheTest : public ::testing::Test {
  protected:
    [[nodiscard]] FieldCache cache(uint64_t bytes = 1 << 26) const {
        return {folder_.path() / "deep" / "fields", bytes};
    }

    test::ScratchFolder folder_;
    FieldGrid grid_ = gridOfDistance(cubeOf(40), 0.2, 0.1, ball);
};

TEST_F(FieldCacheTest, FindsWhatItKept) {
    EXPECT_EQ(cache().find(7), nullptr) << "of an empty cache";
    cache().keep(7, grid_);
    EXPECT_EQ(cache().find(8), nullptr);
    const auto found = cache().find(7);
    ASSERT_NE(found, nullptr);
    EXPECT_EQ(found->hash(), grid_.hash());
    EXPECT_EQ(found->lipschitz(), grid_.lipschitz());
    EXPECT_EQ(found->low(), grid_.low());
    EXPECT_EQ(found->inside(), grid_.inside());
    EXPECT_EQ(found->outside(), grid_.outside());
    for (const glm::ivec3& node : {glm::ivec3(0), glm::ivec3(9, 20, 33), glm::ivec3(40)})
        EXPECT_EQ(found->node(node), grid_.node(node));
}

TEST_F(FieldCacheTest, RemovesWhatIsNotTheFileThatItWrote) {
    cache().keep(7, grid_);
    const fs::path file = cache().fileOf(7);
    const std::string good = bytesOf(file);
    ASSERT_GT(good.size(), 1000u);
    std::mt19937 random(11);
    for (int trial = 0; trial < 400; ++trial) {
        std::string bad = good;
        const size_t at = random() % (trial < 200 ? 96 : bad.size());
        switch (trial % 3) {
        case 0:
            bad.resize(at);
            break;
        case 1:
            bad[at] = static_cast<char>(bad[at] ^ (1 << random() % 8));
            break;
        default:
            bad += good.substr(at);
        }
        if (bad == good)
            continue;
        write(file, bad);
        const auto found = cache().find(7);
        if (found != nullptr) { // bits that nothing depends on
            EXPECT_EQ(found->hash(), grid_.hash()) << trial;
            EXPECT_EQ(found->outside(), grid_.outside()) << trial;
        } else {
            EXPECT_FALSE(fs::exists(file)) << trial;
        }
    }
    write(file, good);
    fs::rename(file, cache().fileOf(9));
    EXPECT_EQ(cache().find(9), nullptr) << "another field's";
    fs::create_directory(file);
    EXPECT_EQ(cache().find(7), nullptr);
    cache().keep(7, grid_); // no throw
}

TEST_F(FieldCacheTest, StaysWithinItsLimitAndForgetsTheOldest) {
    cache().keep(0, grid_);
    const uint64_t one = fs::file_size(cache().fileOf(0)), limit = 5 * one + one / 2;
    for (uint64_t key = 0; key < 5; ++key) {
        cache(limit).keep(key, grid_);
        fs::last_write_time(cache().fileOf(key), fs::file_time_type::clock::now() -
                                                     std::chrono::hours(100 - static_cast<int>(key)));
    }
    EXPECT_NE(cache(limit).find(0), nullptr) << "used: no longer the oldest";
    cache(limit).keep(5, grid_);
    EXPECT_TRUE(fs::exists(cache().fileOf(0)));
    EXPECT_FALSE(fs::exists(cache().fileOf(1)));
    EXPECT_TRUE(fs::exists(cache().fileOf(5)));
    cache(3 * one).keep(6, grid_);
    EXPECT_FALSE(fs::exists(cache().fileOf(6))) << "more than a quarter of the limit";
    EXPECT_EQ(cache(0).find(5), nullptr) << "switched off";
}

TEST_F(FieldCacheTest, IsNotPutOutByEntriesThatAreNoFiles) {
    cache().keep(0, grid_);
    const uint64_t one = fs::file_size(cache().fileOf(0)), limit = 5 * one + one / 2;
    const fs::path folder = cache().fileOf(0).parent_path();
    fs::create_directory(folder / "x.field");
    fs::create_symlink("nowhere", folder / "broken.field"); // its size and time cannot be read
    for (uint64_t key = 1; key < 4; ++key)
        cache(limit).keep(key, grid_);
    for (uint64_t key = 0; key < 4; ++key)
        EXPECT_TRUE(fs::exists(cache().fileOf(key))) << key;
    EXPECT_TRUE(fs::is_directory(folder / "x.field"));
}

TEST_F(FieldCacheTest, AMeshsFieldIsTheSameToTheBit) {
    const TouchBench bench(sceneOf(assets::sphere(0.075, 40, 40)));
    const HapticObject& object = *bench.scene->objects[0];
    const FieldRequest request{.voxel = 1.0 / 48.0};
    const auto plain = fieldOfMesh(object, request), built = fieldOfMesh(object, request, cache());
    EXPECT_EQ(built->hash(), plain->hash());
    size_t files = 0;
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(cache().fileOf(0).parent_path()))
        ++files;
    EXPECT_EQ(files, 1u);
    const auto found = fieldOfMesh(object, request, cache());
    EXPECT_EQ(found->hash(), plain->hash());
    EXPECT_EQ(found->lipschitz(), plain->lipschitz());
    (void)fieldOfMesh(object, {.voxel = 1.0 / 47.0}, cache());
    for ([[maybe_unused]] const auto& entry : fs::directory_iterator(cache().fileOf(0).parent_path()))
        ++files;
    EXPECT_EQ(files, 3u) << "another voxel is another field";
}

} // namespace
} // namespace touchstone::test::field_cache_test
