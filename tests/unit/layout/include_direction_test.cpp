// Links run one way only (docs/architecture.md): engine knows nobody; haptics, renderer, devices and
// sound know engine and not each other; study and session know haptics and devices; api knows session and
// those below it; workbench knows them all; nobody knows workbench. assets stand alone. Nor do the folders
// inside one of them form a circle.

#include <gtest/gtest.h>
#include <unistd.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace touchstone {
namespace {

namespace fs = std::filesystem;

/// For each folder, the folders that it may include besides itself. shaders/shared is plain data layout.
const std::map<std::string, std::set<std::string>> kAllowed{
    {"engine", {}},
    {"haptics", {"engine"}},
    {"renderer", {"engine", "shaders"}},
    {"devices", {"engine"}},
    {"experiment", {"engine", "haptics", "study"}},
    {"sound", {"engine"}},
    {"assets", {}},
    {"shaders", {}},
    {"study", {"engine", "haptics", "devices", "assets"}},
    {"session", {"engine", "haptics", "devices"}},
    {"api", {"engine", "haptics", "devices", "session"}},
    {"server", {}},
    {"workbench",
     {"engine", "haptics", "renderer", "devices", "sound", "assets", "study", "session", "experiment"}},
};

struct Survey {
    std::map<std::string, int> files;   ///< read, by folder
    std::vector<std::string> forbidden; ///< "engine/a.h:3: haptics/b.h"
    /// Inside a library: from folder to folder, with the first include that says so.
    std::map<std::string, std::map<std::string, std::string>> inside;
};

bool isCode(const fs::path& path) {
    static const std::set<std::string> kEndings{".h",    ".hpp",  ".cpp",  ".cc",  ".inl",
                                                ".glsl", ".vert", ".frag", ".comp"};
    return kEndings.contains(path.extension().string());
}

/// The file that an include of `file` reaches, relative to the root.
fs::path reached(const fs::path& root, const fs::path& file, const std::string& included) {
    fs::path target = included;
    if (fs::exists(file.parent_path() / included))
        target = fs::relative(file.parent_path() / included, root);
    return target.lexically_normal();
}

/// The library that a file belongs to, or "" if it is none of ours.
std::string libraryOf(const fs::path& target) {
    const std::string first = target.empty() ? "" : target.begin()->string();
    return kAllowed.contains(first) || first == "tests" || first == "tools" || first == ".." ? first : "";
}

Survey survey(const fs::path& root) {
    static const std::regex kInclude(R"(^\s*#\s*include\s*[<"]([^">]+)[">])");
    Survey result;
    for (const auto& [folder, allowed] : kAllowed) {
        if (!fs::exists(root / folder))
            continue;
        for (const auto& entry : fs::recursive_directory_iterator(root / folder)) {
            if (!entry.is_regular_file() || !isCode(entry.path()))
                continue;
            ++result.files[folder];
            std::ifstream in(entry.path());
            std::string line;
            for (int number = 1; std::getline(in, line); ++number) {
                std::smatch match;
                if (!std::regex_search(line, match, kInclude))
                    continue;
                const fs::path target = reached(root, entry.path(), match[1]);
                const fs::path from = fs::relative(entry.path(), root);
                const std::string to = libraryOf(target);
                const std::string arrow =
                    from.string() + ":" + std::to_string(number) + ": " + match[1].str();
                if (to == folder && target.parent_path() != from.parent_path())
                    result.inside[from.parent_path().string()].emplace(target.parent_path().string(), arrow);
                if (to.empty() || to == folder || allowed.contains(to))
                    continue;
                result.forbidden.push_back(arrow);
            }
        }
    }
    std::sort(result.forbidden.begin(), result.forbidden.end());
    return result;
}

/// The arrows that lie on a circle of folders, each with the include that makes it.
std::vector<std::string> circles(const Survey& house) {
    // What can be reached from each folder, by Warshall's closure.
    std::map<std::string, std::set<std::string>> reach;
    for (const auto& [from, arrows] : house.inside)
        for (const auto& [to, arrow] : arrows)
            reach[from].insert(to);
    for (const auto& [middle, unused] : house.inside)
        for (auto& [from, known] : reach)
            if (known.contains(middle)) {
                const std::set<std::string> further = reach[middle];
                known.insert(further.begin(), further.end());
            }
    std::vector<std::string> found;
    for (const auto& [from, arrows] : house.inside)
        for (const auto& [to, arrow] : arrows)
            if (reach.contains(to) && reach[to].contains(from))
                found.push_back(arrow);
    return found;
}

/// Our own tree, read once.
const Survey& ownSurvey() {
    static const Survey kSurvey = survey(TOUCHSTONE_SOURCE);
    return kSurvey;
}

class Tree {
  public:
    Tree() : root_(fs::temp_directory_path() / ("touchstone layout " + std::to_string(::getpid()))) {
        fs::create_directories(root_);
    }
    ~Tree() { fs::remove_all(root_); }
    Tree(const Tree&) = delete;
    Tree& operator=(const Tree&) = delete;

    void add(const std::string& path, const std::string& text) const {
        fs::create_directories((root_ / path).parent_path());
        std::ofstream(root_ / path) << text;
    }
    [[nodiscard]] const fs::path& root() const { return root_; }

  private:
    fs::path root_;
};

TEST(IncludeDirection, LinksRunOneWayOnly) {
    const Survey& house = ownSurvey();
    for (const std::string& arrow : house.forbidden)
        ADD_FAILURE() << arrow;
    for (const char* folder : {"engine", "haptics", "devices", "assets"})
        EXPECT_GT(house.files.contains(folder) ? house.files.at(folder) : 0, 3)
            << folder << " was not looked at";
}

TEST(IncludeDirection, FoldersInsideALibraryFormNoCircle) {
    const Survey& house = ownSurvey();
    for (const std::string& arrow : circles(house))
        ADD_FAILURE() << arrow << " lies on a circle of folders";
    for (const char* folder : {"haptics/tick", "haptics/proxy", "engine/load", "workbench/panels"})
        EXPECT_TRUE(house.inside.contains(folder)) << folder << " was not looked at";
}

TEST(IncludeDirection, FindsTheArrowsOfACircle) {
    const Tree tree;
    tree.add("haptics/a/one.h", "#include \"haptics/b/two.h\"\n");
    tree.add("haptics/b/two.h", "\n#include \"haptics/c/three.h\"\n#include \"haptics/d/four.h\"\n");
    tree.add("haptics/c/three.h", "#include \"../a/other.h\"\n");
    tree.add("haptics/a/other.h", "#include \"one.h\"\n");
    tree.add("haptics/d/four.h", "");
    const std::vector<std::string> expected{"haptics/a/one.h:1: haptics/b/two.h",
                                            "haptics/b/two.h:2: haptics/c/three.h",
                                            "haptics/c/three.h:1: ../a/other.h"};
    EXPECT_EQ(circles(survey(tree.root())), expected);
}

TEST(IncludeDirection, LetsTheAllowedArrowsPass) {
    const Tree tree;
    tree.add("engine/a.h", "#include <vector>\n#include \"engine/b.h\"\n");
    tree.add("engine/b.h", "");
    tree.add("haptics/deep/c.cpp", "#include \"engine/a.h\"\n#include \"d.h\"\n#include \"../e.h\"\n");
    tree.add("haptics/deep/d.h", "");
    tree.add("haptics/e.h", "");
    tree.add("renderer/f.cpp", "#include \"shaders/shared/g.h\"\n#include <vulkan/vulkan.h>\n");
    tree.add("workbench/h.cpp",
             "#include \"devices/i.h\"\n#include \"haptics/e.h\"\n#include \"renderer/j.h\"\n");
    tree.add("engine/k.cpp", "// #include \"haptics/e.h\" is what one must not write\n");
    EXPECT_TRUE(survey(tree.root()).forbidden.empty());
}

TEST(IncludeDirection, FindsEveryForbiddenArrow) {
    const Tree tree;
    tree.add("haptics/a.h", "");
    tree.add("engine/upwards.h", "\n#include \"haptics/a.h\"\n");
    tree.add("engine/angled.cpp", "#  include <haptics/a.h>\n");
    tree.add("engine/relative.cpp", "#include \"../haptics/a.h\"\n");
    tree.add("haptics/sideways.cpp", "#include \"devices/b.h\"\n");
    tree.add("haptics/pixels.cpp", "#include \"renderer/c.h\"\n");
    tree.add("renderer/touch.cpp", "#include \"haptics/a.h\"\n");
    tree.add("devices/top.h", "#include \"workbench/d.h\"\n");
    tree.add("devices/tests.cpp", "#include \"tests/support/e.h\"\n");
    tree.add("assets/engine.cpp", "#include \"engine/f.h\"\n");
    const std::vector<std::string> expected{
        "assets/engine.cpp:1: engine/f.h",       "devices/tests.cpp:1: tests/support/e.h",
        "devices/top.h:1: workbench/d.h",        "engine/angled.cpp:1: haptics/a.h",
        "engine/relative.cpp:1: ../haptics/a.h", "engine/upwards.h:2: haptics/a.h",
        "haptics/pixels.cpp:1: renderer/c.h",    "haptics/sideways.cpp:1: devices/b.h",
        "renderer/touch.cpp:1: haptics/a.h",
    };
    EXPECT_EQ(survey(tree.root()).forbidden, expected);
}

} // namespace
} // namespace touchstone
