// Libraries share the namespace touchstone. Two types of one name in two of them would be one type to the
// linker: their inline members and destructors are merged without a message.

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace touchstone {
namespace {

namespace fs = std::filesystem;

/// Namespace and name of each type that a header defines at the start of a line, with the headers that define
/// it.
using Definitions = std::map<std::string, std::set<std::string>>;

void scan(std::istream& text, const std::string& file, Definitions& definitions) {
    static const std::regex kNamespace(R"(^namespace ([\w:]+) \{)");
    static const std::regex kType(
        R"(^(?:struct|class|union|enum class|enum) (?:\[\[\w+\]\] |alignas\(\w+\) )?(\w+)(?: final)?(?: :[^:].*)? \{)");
    std::string space;
    std::smatch found;
    for (std::string line; std::getline(text, line);) {
        if (std::regex_search(line, found, kNamespace))
            space = found[1];
        else if (std::regex_search(line, found, kType))
            definitions[space + "::" + found[1].str()].insert(file);
    }
}

Definitions definitionsIn(const fs::path& root) {
    Definitions definitions;
    for (const char* library : {"api", "assets", "devices", "engine", "experiment", "haptics", "renderer",
                                "server", "session", "sound", "study", "workbench"}) {
        for (const auto& entry : fs::recursive_directory_iterator(root / library)) {
            if (entry.path().extension() != ".h")
                continue;
            std::ifstream in(entry.path());
            scan(in, fs::relative(entry.path(), root).string(), definitions);
        }
    }
    return definitions;
}

TEST(TypeNames, NameOneTypeEach) {
    const Definitions definitions = definitionsIn(TOUCHSTONE_SOURCE);
    EXPECT_GT(definitions.size(), 400u) << "the scan finds the types";
    EXPECT_TRUE(definitions.contains("touchstone::HapticScene"));
    for (const auto& [name, files] : definitions) {
        std::string where;
        for (const std::string& file : files)
            where += " " + file;
        EXPECT_EQ(files.size(), 1u) << name << " is defined in" << where;
    }
}

TEST(TypeNames, TheScanFindsTwins) {
    Definitions definitions;
    std::istringstream a(
        "namespace touchstone {\nstruct View {\n    int x;\n};\nclass Only;\nenum class Kind : int {\n"),
        b("namespace touchstone {\nclass [[nodiscard]] View : public Base {\n"),
        c("namespace touchstone::study {\nstruct View {\n");
    scan(a, "a.h", definitions);
    scan(b, "b.h", definitions);
    scan(c, "c.h", definitions);
    EXPECT_EQ(definitions["touchstone::View"].size(), 2u);
    EXPECT_EQ(definitions["touchstone::study::View"].size(), 1u);
    EXPECT_EQ(definitions["touchstone::Kind"].size(), 1u);
    EXPECT_FALSE(definitions.contains("touchstone::Only"));
}

} // namespace
} // namespace touchstone
