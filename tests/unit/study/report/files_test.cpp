#include "engine/core/error.h"
#include "study/report/report.h"
#include "tests/unit/study/report/synthetic_study.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>

namespace touchstone::study::test {
namespace {

using Json = nlohmann::ordered_json;

/// A field that is added to a result must be added to study/report/fields.h, and here.
TEST(StudyFiles, KnowTheStructuresAsTheyAre) {
    EXPECT_EQ(sizeof(Errors), 20 * 8u);
    EXPECT_EQ(sizeof(ConfigurationResult), 6 * sizeof(std::string) + 36 * 8u + sizeof(Errors) + 8u);
    EXPECT_EQ(sizeof(RateResult), 7 * 8u);
    EXPECT_EQ(sizeof(Provenance), 8 * sizeof(std::string) + 8u);
    EXPECT_EQ(sizeof(StudyResult), sizeof(Provenance) + 6 * sizeof(std::vector<int>));
    EXPECT_EQ(sizeof(VoxelResult), 3 * sizeof(std::string) + 20 * 8u);
    EXPECT_EQ(sizeof(JustNoticeable), 3 * sizeof(std::string) + 8u);
}

TEST(StudyFiles, JsonComesBackToTheBit) {
    const ScratchFolder folder;
    const StudyResult result = everyField();
    ASSERT_EQ(result.configurations.size(), 2u);
    EXPECT_NE(result.configurations[0], result.configurations[1]);
    writeStudyJson(result, folder.path() / "study.json");
    EXPECT_EQ(readStudyJson(folder.path() / "study.json"), result);
}

TEST(StudyFiles, JsonKeepsWhatIsNoNumber) {
    const ScratchFolder folder;
    StudyResult result = everyField();
    result.configurations[0].errors.position.max = std::numeric_limits<double>::infinity();
    result.configurations[0].step.low = -std::numeric_limits<double>::infinity();
    result.configurations[0].step.high = std::numeric_limits<double>::denorm_min();
    writeStudyJson(result, folder.path() / "study.json");
    EXPECT_EQ(readStudyJson(folder.path() / "study.json"), result);
    result.configurations[1].rayFloor = std::numeric_limits<double>::quiet_NaN();
    writeStudyJson(result, folder.path() / "study.json");
    EXPECT_TRUE(std::isnan(readStudyJson(folder.path() / "study.json").configurations[1].rayFloor));
}

/// Splits a table as RFC 4180 has it.
std::vector<std::vector<std::string>> table(const std::string& text) {
    std::vector<std::vector<std::string>> rows{{""}};
    bool quoted = false;
    for (size_t i = 0; i < text.size(); ++i) {
        const char c = text[i];
        if (quoted && c == '"' && i + 1 < text.size() && text[i + 1] == '"')
            rows.back().back() += text[++i];
        else if (c == '"')
            quoted = !quoted;
        else if (!quoted && c == ',')
            rows.back().emplace_back();
        else if (!quoted && c == '\n')
            rows.push_back({""});
        else
            rows.back().back() += c;
    }
    rows.pop_back();
    return rows;
}

TEST(StudyFiles, CsvHasARowForARungAndItsUnitsInTheHeader) {
    const ScratchFolder folder;
    const StudyResult result = everyField();
    writeStudyCsv(result, folder.path() / "study.csv");
    const auto rows = table(readFile(folder.path() / "study.csv"));
    ASSERT_EQ(rows.size(), 1 + result.configurations.size());
    const auto value = [&](size_t configuration, const std::string& column) {
        for (size_t i = 0; i < rows[0].size(); ++i)
            if (rows[0][i] == column)
                return rows[1 + configuration].at(i);
        ADD_FAILURE() << column;
        return std::string();
    };
    for (size_t i = 0; i < 2; ++i) {
        const ConfigurationResult& r = result.configurations[i];
        EXPECT_EQ(rows[1 + i].size(), rows[0].size());
        EXPECT_EQ(value(i, "scene"), r.scene);
        EXPECT_EQ(value(i, "triangles"), std::to_string(r.triangles));
        EXPECT_EQ(std::stod(value(i, "facet_angle_rad")), r.facetAngle);
        EXPECT_EQ(std::stod(value(i, "rate_hz")), r.rateHz);
        EXPECT_EQ(std::stod(value(i, "step_median_ns")), r.step.value);
        EXPECT_EQ(std::stod(value(i, "step_median_low_ns")), r.step.low);
        EXPECT_EQ(std::stod(value(i, "stage_safety_high_ns")), r.stages[7].high);
        EXPECT_EQ(std::stod(value(i, "position_error_p99_m")), r.errors.position.p99);
        EXPECT_EQ(std::stod(value(i, "force_direction_error_max_rad")), r.errors.forceDirection.max);
        EXPECT_EQ(std::stod(value(i, "energy_created_J")), r.errors.energyCreated);
        EXPECT_EQ(value(i, "truth"), "reference");
        EXPECT_EQ(value(i, "pareto"), r.pareto ? "1" : "0");
    }
}

class BadJson : public testing::TestWithParam<std::pair<const char*, const char*>> {};

/// Sets what stands at a JSON pointer, and expects to be told of it.
TEST_P(BadJson, IsToldWithItsPlace) {
    const ScratchFolder folder;
    const auto file = folder.path() / "study.json";
    writeStudyJson(everyField(), file);
    Json json = Json::parse(readFile(file));
    const Json::json_pointer at(GetParam().first);
    ASSERT_TRUE(json.contains(at)) << at;
    json[at.parent_pointer()].erase(at.back());
    const auto read = [&](const std::string& what) {
        std::ofstream(file) << json.dump();
        try {
            (void)readStudyJson(file);
            ADD_FAILURE() << at << " " << what << " was taken";
        } catch (const Error& e) {
            EXPECT_EQ(e.file(), file.string());
            EXPECT_EQ(e.place(), GetParam().second) << what;
            EXPECT_FALSE(e.remedy().empty());
        }
    };
    read("missing");
    json[at] = Json::array({-1.5});
    read("of another kind");
}

INSTANTIATE_TEST_SUITE_P(StudyFiles, BadJson,
                         testing::Values(std::pair{"/format", "format"}, std::pair{"/version", "version"},
                                         std::pair{"/provenance", "provenance"},
                                         std::pair{"/provenance/processors", "provenance.processors"},
                                         std::pair{"/rates/1/rate_hz", "rates[1].rate_hz"},
                                         std::pair{"/rungs/1/errors/position_error_m/p99",
                                                   "rungs[1].errors.position_error_m.p99"},
                                         std::pair{"/rungs/0/truth", "rungs[0].truth"},
                                         std::pair{"/rungs/0/default", "rungs[0].default"},
                                         std::pair{"/rungs/0/stage/proxy_ns", "rungs[0].stage.proxy_ns"},
                                         std::pair{"/noticeable/0/source", "noticeable[0].source"}));

TEST(StudyFiles, WhatIsNoStudyIsToldSo) {
    const ScratchFolder folder;
    const auto throws = [](const std::filesystem::path& file) {
        try {
            (void)readStudyJson(file);
        } catch (const Error& e) {
            return e.file() == file.string() && !e.problem().empty();
        }
        return false;
    };
    EXPECT_TRUE(throws(folder.path() / "none.json"));
    EXPECT_TRUE(throws(folder.path()));
    for (const char* text : {"", "{\"format\": \"touchstone st", "[1, 2]", "3", "{\"a\": \"\xff\"}"}) {
        std::ofstream(folder.path() / "bad.json", std::ios::binary) << text;
        EXPECT_TRUE(throws(folder.path() / "bad.json")) << text;
    }
}

TEST(StudyFiles, LeaveNothingHalfWritten) {
    const ScratchFolder folder;
    EXPECT_THROW(writeStudyCsv(everyField(), folder.path() / "none" / "study.csv"), Error);
    EXPECT_THROW(writeStudyJson(everyField(), folder.path()), Error);
    EXPECT_TRUE(std::filesystem::is_empty(folder.path()));
}

} // namespace
} // namespace touchstone::study::test
