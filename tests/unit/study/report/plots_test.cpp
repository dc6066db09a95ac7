#include "engine/core/error.h"
#include "study/report/plots/figures.h"
#include "study/report/plots/gnuplot.h"
#include "study/report/report.h"
#include "tests/unit/study/report/synthetic_study.h"

#include <gtest/gtest.h>

#include <cmath>
#include <fstream>
#include <limits>
#include <regex>
#include <set>

namespace touchstone::study::test {
namespace {

size_t count(const std::string& text, const std::string& what) {
    size_t found = 0;
    for (size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += what.size())
        ++found;
    return found;
}

TEST(StudyPlots, AreAllDrawnWhateverTheNamesHold) {
    const ScratchFolder folder;
    const PlotsWritten written = writeStudyPlots(likeMeasured(), folder.path());
    for (const std::string& problem : written.problems)
        ADD_FAILURE() << problem;
    // Two scenes: three errors and the stages each. Then triangles, scenes, tessellation, rates, voxels.
    EXPECT_EQ(written.files.size(), 2 * 4 + 5u);
    for (const auto& file : written.files) {
        const std::string svg = readFile(file);
        EXPECT_NE(svg.find("</svg>"), std::string::npos) << file;
        EXPECT_EQ(svg.find("font-family=\"Inter\""), std::string::npos) << "no font to fall back to";
        EXPECT_EQ(count(svg, "<&>"), 0u) << file;
        for (const char* ending : {".gp", ".dat"}) {
            auto beside = file;
            EXPECT_TRUE(std::filesystem::exists(beside.replace_extension(ending))) << beside;
        }
    }
    // Nothing else: no half written picture, and nothing that a name asked for.
    size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(folder.path() / "plots"))
        files += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, 3 * written.files.size());
}

TEST(StudyPlots, NameTheirUnitsAndSeries) {
    const ScratchFolder folder;
    const PlotsWritten written = writeStudyPlots(likeMeasured(), folder.path());
    const std::vector<std::pair<std::string, std::vector<std::string>>> expected{
        {"error_force_torus", {"mN", "µs", "just noticeable: 40 mN", "exact", "Pareto", "rung 0", "0a1b2c"}},
        {"error_position_torus", {"µm", "µs", "exact", "combination"}},
        {"error_direction_torus", {"degrees", "just noticeable: 28.6 degrees"}},
        {"stages_torus", {"ns", "safety", "whole tick", "rung 0"}},
        {"cost_over_triangles", {"triangles", "µs", "one Embree ray", "flat", "two-pass"}},
        {"error_over_tessellation", {"degrees", "C1 0.498°", "no shading", "C2 3.38°", "shape"}},
        {"error_over_voxel", {"voxel, mm", "µm", "virtual point", "torus", "groove"}},
        {"servo_rate", {"kHz", "N/mm", "%", "theory", "measured"}},
    };
    for (const auto& [name, words] : expected) {
        std::string svg;
        for (const auto& file : written.files)
            if (file.filename().string().starts_with(name))
                svg = readFile(file);
        for (const std::string& word : words)
            EXPECT_NE(svg.find(word), std::string::npos) << name << " does not say " << word;
    }
}

/// The lines of an ablation's block that are marked as on the front.
TEST(StudyPlots, DrawTheFrontThatThereIs) {
    StudyResult result;
    const StudyResult all = likeMeasured();
    for (const ConfigurationResult& r : all.configurations)
        if (r.scene == "torus 64,800" && r.ablation == "combination")
            result.configurations.push_back(r);
    size_t front = 0;
    for (const ConfigurationResult& r : result.configurations)
        front += std::none_of(result.configurations.begin(), result.configurations.end(),
                              [&](const ConfigurationResult& other) {
                                  return other.step.value < r.step.value &&
                                         other.errors.force.p99 < r.errors.force.p99;
                              });
    ASSERT_GT(front, 2u);
    const std::vector<Figure> figures = errorOverTime(result);
    ASSERT_EQ(figures.size(), 3u);
    EXPECT_EQ(count(figures[0].data, " 1 0 # "), front);
    EXPECT_EQ(count(figures[0].data, " 0 0 # "), result.configurations.size() - front);
}

TEST(StudyPlots, FindAPlaceForWhatALogarithmHasNoneFor) {
    const ScratchFolder folder;
    StudyResult result = likeMeasured();
    result.noticeable.clear();
    result.rates.clear();
    result.voxels.clear();
    constexpr double kInfinity = std::numeric_limits<double>::infinity();
    result.configurations.resize(3);
    for (ConfigurationResult& r : result.configurations)
        r.errors.force = r.errors.position = r.errors.forceDirection = {};
    result.configurations[1].errors.force.p99 = kInfinity;
    result.configurations[2].errors.position.p99 = std::nan("");
    result.configurations[2].step.high = kInfinity;
    const PlotsWritten written = writeStudyPlots(result, folder.path());
    for (const std::string& problem : written.problems)
        ADD_FAILURE() << problem;
    EXPECT_EQ(written.files.size(), 4u);
    EXPECT_TRUE(writeStudyPlots({}, folder.path()).files.empty());
}

TEST(StudyPlots, AreMissedWithARemedyWhereGnuplotIs) {
    const ScratchFolder folder;
    const PlotsWritten written = writeStudyPlots(likeMeasured(), folder.path(), "no-such-gnuplot");
    EXPECT_TRUE(written.files.empty());
    ASSERT_FALSE(written.problems.empty());
    for (const std::string& problem : written.problems)
        EXPECT_NE(problem.find("apt-get install gnuplot-nox"), std::string::npos) << problem;
    const PlotsWritten failed = writeStudyPlots(likeMeasured(), folder.path(), "false");
    EXPECT_TRUE(failed.files.empty());
    EXPECT_EQ(failed.problems.size(), written.problems.size());
    std::ofstream(folder.path() / "a file") << "";
    EXPECT_THROW(writeStudyPlots({}, folder.path() / "a file"), Error);
}

TEST(StudyPlots, OfScenesWithLikeNamesKeepApart) {
    StudyResult result = likeMeasured();
    const size_t before = result.configurations.size();
    for (size_t i = 0; i < before; ++i) {
        result.configurations.push_back(result.configurations[i]);
        result.configurations.back().scene += "!";
    }
    std::set<std::string> names;
    for (const auto& kind : {errorOverTime, costByStage})
        for (const Figure& figure : kind(result))
            EXPECT_TRUE(names.insert(figure.name).second) << figure.name;
    EXPECT_EQ(names.size(), 16u);
}

/// However much there is to say.
TEST(StudyPlots, KeepAllTheirWordsOnThePage) {
    StudyResult result = likeMeasured();
    const ConfigurationResult configuration = result.configurations.front();
    for (int i = 0; i < 63; ++i) {
        result.configurations.push_back(configuration);
        result.configurations.back().ablation = "ladder " + std::to_string(i / 7);
        result.configurations.back().configuration = "rung " + std::to_string(i);
        result.configurations.back().step.value += 10.0 * i;
    }
    static const std::regex kPlace(R"(set label .* at screen (-?[0-9.e-]+),(-?[0-9.e-]+))");
    size_t labels = 0;
    for (const auto& kind :
         {errorOverTime, costByStage, costOverTriangles, errorOverTessellation, stabilityOverRate})
        for (const Figure& figure : kind(result))
            for (std::sregex_iterator at(figure.script.begin(), figure.script.end(), kPlace), end; at != end;
                 ++at)
                for (const int axis : {1, 2}) {
                    EXPECT_GE(std::stod((*at)[axis]), 0.0) << figure.name << ": " << at->str();
                    EXPECT_LE(std::stod((*at)[axis]), 1.0) << figure.name << ": " << at->str();
                    ++labels;
                }
    EXPECT_GT(labels, 500u);
}

TEST(StudyPlots, AxesHoldWhatTheyShow) {
    for (const double low : {1e-9, 0.3, 7.0, 4e5})
        for (const double ratio : {1.0, 1.3, 40.0, 1e7}) {
            const LogAxis axis = LogAxis::around({low, low * ratio, 0.0, -1.0});
            EXPECT_LT(axis.low, low);
            EXPECT_GT(axis.high, low * ratio);
            EXPECT_GE(axis.high, 3.0 * axis.low);
            EXPECT_GT(axis.fraction(low), 0.0);
            EXPECT_LT(axis.fraction(low * ratio), 1.0);
            LogAxis banded = axis;
            banded.band = true;
            EXPECT_LT(banded.place(0.0), banded.low);
            EXPECT_GT(banded.place(0.0), banded.bottom());
            EXPECT_EQ(banded.place(low), low);
        }
}

TEST(StudyPlots, TextIsTakenAsItIs) {
    EXPECT_EQ(inQuotes("it's `a` $(b)\n"), "'it''s `a` $(b) '");
    EXPECT_EQ(slug("WaterBottle.glb / stroke 1 mm, 0.1 m/s"), "waterbottle_glb_stroke_1_mm_0_1_m_s");
    EXPECT_EQ(slug("µ../"), "");
    EXPECT_EQ(cut("µµµµ", 3), "µµµ…");
    EXPECT_EQ(cut("µµµ", 3), "µµµ");
}

} // namespace
} // namespace touchstone::study::test
