// The library's symbols: those of the header, and nothing else. A symbol that is missing here breaks programs
// that were linked before; one that is new becomes a promise.

#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <fstream>
#include <regex>
#include <set>
#include <sstream>
#include <string>

namespace touchstone::test {
namespace {

std::set<std::string> exported() {
    const ProgramResult run = runProgram({"nm", "-D", "--defined-only", TOUCHSTONE_LIBRARY});
    EXPECT_EQ(run.status, 0) << run.err;
    std::set<std::string> names;
    std::istringstream lines(run.out);
    for (std::string address, kind, name; lines >> address >> kind >> name;)
        if (kind != "A") // the version's own name
            names.insert(name);
    return names;
}

std::set<std::string> listed() {
    std::set<std::string> names;
    std::ifstream in(TOUCHSTONE_SOURCE "/api/symbols.txt");
    for (std::string name; in >> name;)
        names.insert(name);
    return names;
}

TEST(ApiSymbols, AreThoseOfTheList) {
    ASSERT_GT(listed().size(), 30u);
    EXPECT_EQ(exported(), listed()) << "a changed interface changes api/symbols.txt and CHANGELOG.md";
}

TEST(ApiSymbols, AreDeclaredInTheHeader) {
    std::ifstream in(TOUCHSTONE_SOURCE "/api/include/touchstone/touchstone.h");
    const std::string header((std::istreambuf_iterator<char>(in)), {});
    const std::regex declared(R"(TS_API[^;(]*?\b(ts_\w+)\()");
    std::set<std::string> names;
    for (std::sregex_iterator at(header.begin(), header.end(), declared), end; at != end; ++at)
        names.insert((*at)[1].str() + "@@TOUCHSTONE_0.1");
    EXPECT_EQ(names, listed());
}

TEST(ApiHeaders, IncludeOnlyTheStandardLibrary) {
    const std::set<std::string> allowed{"stddef.h", "stdint.h", "touchstone.h", "array",      "cmath",
                                        "cstddef",  "cstdint",  "exception",    "functional", "stdexcept",
                                        "string",   "utility",  "vector"};
    for (const char* file : {"touchstone.h", "touchstone.hpp"}) {
        std::ifstream in(std::string(TOUCHSTONE_SOURCE "/api/include/touchstone/") + file);
        size_t includes = 0;
        for (std::string line; std::getline(in, line);) {
            std::smatch match;
            if (!std::regex_search(line, match, std::regex(R"(#include [<"]([^>"]+))")))
                continue;
            ++includes;
            EXPECT_TRUE(allowed.contains(match[1])) << file << ": " << line;
        }
        EXPECT_GT(includes, 1u);
    }
}

} // namespace
} // namespace touchstone::test
