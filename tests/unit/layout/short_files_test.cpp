// Files that are read by whoever is new here stay short.

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

namespace touchstone {
namespace {

std::ptrdiff_t linesOf(const std::string& file) {
    std::ifstream stream(std::filesystem::path(TOUCHSTONE_SOURCE) / file);
    EXPECT_TRUE(stream.is_open()) << file;
    return std::count(std::istreambuf_iterator<char>(stream), {}, '\n');
}

/// Tick, loader and program (docs/architecture.md).
TEST(ShortFiles, AreTheThreeThatTellTheStory) {
    for (const char* file :
         {"haptics/tick/haptic_step.cpp", "engine/load/scene_loader.cpp", "workbench/workbench.cpp"}) {
        EXPECT_GT(linesOf(file), 100) << file;
        EXPECT_LT(linesOf(file), 300) << file;
    }
}

/// A shape of one's own, with a scene in which it is touched beside a mesh.
TEST(ShortFiles, IsWhatItTakesToAddAShape) {
    EXPECT_LT(linesOf("tests/unit/haptics/shape_test.cpp"), 150);
}

} // namespace
} // namespace touchstone
