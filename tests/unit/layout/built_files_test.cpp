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

/// An entry for a line that has moved or changed says nothing: tools/mutate looks for file and line.
TEST(EquivalentMutants, NameLinesThatThereAre) {
    const fs::path root = TOUCHSTONE_SOURCE;
    std::ifstream list(root / "tools/mutate_equivalent.txt");
    size_t entries = 0;
    for (std::string entry; std::getline(list, entry);) {
        if (entry.empty() || entry[0] == '#')
            continue;
        ++entries;
        const size_t first = entry.find('\t'), second = entry.find('\t', first + 1);
        ASSERT_NE(second, std::string::npos) << entry;
        const std::string wanted = entry.substr(first + 1, second - first - 1);
        std::ifstream source(root / entry.substr(0, first));
        bool found = false;
        for (std::string line; !found && std::getline(source, line);) {
            const size_t begin = line.find_first_not_of(' ');
            found = begin != std::string::npos && line.substr(begin) == wanted;
        }
        EXPECT_TRUE(found) << entry;
    }
    EXPECT_GT(entries, 50u);
}

} // namespace
} // namespace touchstone
