// Every link inside the documentation leads to a file, and every anchor to a heading.

#include <gtest/gtest.h>

#include <cctype>
#include <filesystem>
#include <fstream>
#include <regex>
#include <set>
#include <string>
#include <vector>

namespace touchstone::test {
namespace {

std::vector<std::string> linesOf(const std::filesystem::path& file) {
    std::vector<std::string> lines;
    std::ifstream in(file);
    for (std::string line; std::getline(in, line);)
        lines.push_back(line);
    return lines;
}

/// As GitHub makes them: lower case, blanks become hyphens, and of the rest only word characters stay.
std::string anchorOf(const std::string& heading) {
    std::string anchor;
    for (const char c : heading) {
        if (c == ' ')
            anchor += '-';
        else if (std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || (c & 0x80) != 0)
            anchor += static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    }
    return anchor;
}

std::set<std::string> anchorsOf(const std::filesystem::path& file) {
    std::set<std::string> anchors;
    for (const std::string& line : linesOf(file))
        if (const size_t text = line.find_first_not_of('#');
            text > 0 && text < line.size() && line[text] == ' ')
            anchors.insert(anchorOf(line.substr(text + 1)));
    return anchors;
}

std::vector<std::filesystem::path> pages() {
    const std::filesystem::path root = TOUCHSTONE_SOURCE;
    std::vector<std::filesystem::path> found{root / "README.md"};
    for (const auto& entry : std::filesystem::directory_iterator(root / "docs"))
        if (entry.path().extension() == ".md")
            found.push_back(entry.path());
    return found;
}

/// What is wrong with a link on `page`; empty: nothing.
std::string brokenBy(const std::filesystem::path& page, const std::string& link) {
    if (link.starts_with("http"))
        return "";
    const size_t hash = std::min(link.find('#'), link.size());
    const std::filesystem::path target = hash == 0 ? page : page.parent_path() / link.substr(0, hash);
    if (!std::filesystem::exists(target))
        return "no such file";
    if (hash < link.size() && target.extension() == ".md" &&
        !anchorsOf(target).contains(link.substr(hash + 1)))
        return "no such heading";
    return "";
}

TEST(DocsLinks, LeadToFilesAndHeadings) {
    const std::regex link(R"(\]\(([^)\s]+)\))");
    size_t links = 0;
    for (const std::filesystem::path& page : pages())
        for (const std::string& line : linesOf(page))
            for (std::sregex_iterator at(line.begin(), line.end(), link), end; at != end; ++at) {
                ++links;
                const std::string to = (*at)[1];
                EXPECT_EQ(brokenBy(page, to), "") << page << ": " << to;
            }
    EXPECT_GT(links, 100u);
    const std::filesystem::path readme = pages().front();
    EXPECT_NE(brokenBy(readme, "docs/nothing.md"), "");
    EXPECT_NE(brokenBy(readme, "docs/commands.md#no-such-heading"), "");
    EXPECT_EQ(brokenBy(readme, "docs/commands.md#settings"), "");
}

/// The index names every page.
TEST(DocsLinks, TheIndexNamesEveryPage) {
    std::string index;
    for (const std::string& line : linesOf(std::filesystem::path(TOUCHSTONE_SOURCE) / "docs/README.md"))
        index += line + "\n";
    for (const std::filesystem::path& page : pages())
        if (page.filename() != "README.md") {
            EXPECT_NE(index.find("](" + page.filename().string() + ")"), std::string::npos) << page;
        }
}

} // namespace
} // namespace touchstone::test
