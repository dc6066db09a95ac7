#include "engine/core/error.h"
#include "study/report/plots/figures.h"
#include "study/report/plots/gnuplot.h"
#include "study/report/report.h"

namespace touchstone::study {

PlotsWritten writeStudyPlots(const StudyResult& result, const std::filesystem::path& dir,
                             const std::string& gnuplot) {
    const std::filesystem::path folder = dir / "plots";
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(folder.string(), "", "cannot be made: " + error.message(),
                    "choose a folder that you may write to");
    PlotsWritten written;
    for (const auto& kind : {errorOverTime, costByStage, costOverTriangles, errorOverTessellation,
                             stabilityOverRate, errorOverVoxel})
        for (Figure& figure : kind(result)) {
            const std::string problem = draw(figure, folder, gnuplot);
            if (problem.empty())
                written.files.push_back(folder / (figure.name + ".svg"));
            else
                written.problems.push_back(problem);
        }
    return written;
}

} // namespace touchstone::study
