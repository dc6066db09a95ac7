// A test that no CMakeLists.txt names is compiled by nobody and passes for ever.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace touchstone {
namespace {

namespace fs = std::filesystem;

/// All words of the tests' CMakeLists.txt, as "name" and as "folder/name.cpp", without their folders.
std::set<std::string> namesInBuildFiles(const fs::path& tests) {
    static const std::regex kWord(R"([\w.]+)");
    std::set<std::string> names;
    for (const auto& entry : fs::recursive_directory_iterator(tests)) {
        if (entry.path().filename() != "CMakeLists.txt")
            continue;
        std::stringstream text;
        text << std::ifstream(entry.path()).rdbuf();
        const std::string all = text.str();
        for (std::sregex_iterator word(all.begin(), all.end(), kWord), end; word != end; ++word)
            names.insert(word->str());
    }
    return names;
}

TEST(TestFiles, AreAllBuilt) {
    const fs::path tests = fs::path(TOUCHSTONE_SOURCE) / "tests";
    const std::set<std::string> names = namesInBuildFiles(tests);
    size_t files = 0;
    for (const auto& entry : fs::recursive_directory_iterator(tests)) {
        if (entry.path().extension() != ".cpp")
            continue;
        ++files;
        // A foreach over targets names the file without its ending.
        EXPECT_TRUE(names.contains(entry.path().filename().string()) ||
                    names.contains(entry.path().stem().string()))
            << entry.path() << " is in no CMakeLists.txt";
    }
    EXPECT_GT(files, 100u);
}

} // namespace
} // namespace touchstone
