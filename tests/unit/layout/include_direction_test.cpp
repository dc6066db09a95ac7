// Links run one way only (docs/architecture.md): engine knows nobody; haptics, renderer, devices and
// sound know engine and not each other; study knows haptics and devices; workbench knows them all; nobody
// knows workbench. assets stand alone.

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
    {"sound", {"engine"}},
    {"assets", {}},
    {"shaders", {}},
    {"study", {"engine", "haptics", "devices", "assets"}},
    {"workbench", {"engine", "haptics", "renderer", "devices", "sound", "assets", "study"}},
};

struct Survey {
    std::map<std::string, int> files;   ///< read, by folder
    std::vector<std::string> forbidden; ///< "engine/a.h:3: haptics/b.h"
};

bool isCode(const fs::path& path) {
    static const std::set<std::string> kEndings{".h",    ".hpp",  ".cpp",  ".cc",  ".inl",
                                                ".glsl", ".vert", ".frag", ".comp"};
    return kEndings.contains(path.extension().string());
}

/// The folder of the house that an include of `file` reaches, or "" if it is none of ours.
std::string reached(const fs::path& root, const fs::path& file, const std::string& included) {
    fs::path target = included;
    if (fs::exists(file.parent_path() / included))
        target = fs::relative(file.parent_path() / included, root);
    target = target.lexically_normal();
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
                const std::string to = reached(root, entry.path(), match[1]);
                if (to.empty() || to == folder || allowed.contains(to))
                    continue;
                result.forbidden.push_back(fs::relative(entry.path(), root).string() + ":" +
                                           std::to_string(number) + ": " + match[1].str());
            }
        }
    }
    std::sort(result.forbidden.begin(), result.forbidden.end());
    return result;
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
    const Survey house = survey(TOUCHSTONE_SOURCE);
    for (const std::string& arrow : house.forbidden)
        ADD_FAILURE() << arrow;
    for (const char* folder : {"engine", "haptics", "devices", "assets"})
        EXPECT_GT(house.files.contains(folder) ? house.files.at(folder) : 0, 3)
            << folder << " was not looked at";
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
