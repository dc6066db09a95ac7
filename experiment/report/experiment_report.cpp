#include "experiment/report/experiment_report.h"

#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "experiment/report/experiment_figures.h"
#include "experiment/statistics/distributions.h"
#include "study/report/plots/gnuplot.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <cstdarg>
#include <cstdio>
#include <limits>

namespace touchstone::experiment {

namespace {

using Json = nlohmann::ordered_json;

[[gnu::format(printf, 1, 2)]] std::string line(const char* format, ...) {
    std::array<char, 400> text{};
    std::va_list values;
    va_start(values, format);
    std::vsnprintf(text.data(), text.size(), format, values);
    va_end(values);
    return text.data();
}

std::string probability(double p) {
    return p < 1e-4 ? "p < 0.0001" : line("p = %.4f", p);
}

/// A field of a CSV: in quotes where it needs them.
std::string field(const std::string& text) {
    if (text.find_first_of(",\"\n\r") == std::string::npos)
        return text;
    std::string quoted = "\"";
    for (const char c : text)
        quoted += c == '"' ? "\"\"" : std::string(1, c);
    return quoted + "\"";
}

ConditionResult resultOf(size_t condition, const std::vector<PersonSession>& sessions) {
    ConditionResult result{.condition = condition};
    for (const PersonSession& session : sessions) {
        if (session.trialsOf(condition) == 0)
            continue;
        ++result.begun;
        result.done += session.done(condition) ? 1 : 0;
        if (const auto threshold = session.threshold(condition))
            result.thresholds.push_back(*threshold);
        for (const TrialRecord& trial : session.trials())
            if (trial.condition == condition) {
                ++result.trials;
                result.right += trial.right ? 1 : 0;
            }
    }
    if (!result.thresholds.empty())
        result.mean = meanOf(result.thresholds);
    return result;
}

std::string inDegrees(double degrees) {
    return std::isfinite(degrees) ? line("%8.2f°", degrees) : "        -";
}

std::string describeThresholds(const ExperimentResult& result) {
    std::string text = line("%-8s %6s %10s %10s %9s %10s  %s\n", "", "people", "threshold", "95 % +-",
                            "angle", "observer", "[004]: level, 95 % +-, angle");
    for (const ConditionResult& row : result.conditions) {
        const Condition& condition = result.plan.conditions[row.condition];
        if (condition.varied == Varied::Nothing) {
            if (row.trials > 0)
                text += line("%-8s %6zu %zu of %zu right, by guessing at most as likely as %s\n",
                             condition.name.c_str(), row.begun, row.right, row.trials,
                             probability(guessTail(static_cast<int>(row.right), static_cast<int>(row.trials)))
                                 .c_str());
            continue;
        }
        if (row.thresholds.empty())
            continue;
        text += line("%-8s %6zu %10.1f %10.1f %s", condition.name.c_str(), row.thresholds.size(),
                     row.mean.mean, row.mean.half, inDegrees(degreesAt(condition, row.mean.mean)).c_str());
        text += row.observer ? line(" %10.1f", *row.observer) : line(" %10s", "-");
        if (const PaperResult* paper = paperResult(result.plan, condition))
            text += paper->segments > 0.0
                        ? line("  %6.1f %6.2f %5.1f°", paper->segments, paper->half, paper->degrees)
                        : line("  %6s %6s %5.1f°", "-", "-", paper->degrees);
        text += "\n";
    }
    return text;
}

std::string describeVariance(const ExperimentResult& result) {
    if (!result.variance)
        return "no analysis of variance: " + result.whyNoVariance + "\n";
    const Variance& v = *result.variance;
    std::string text =
        line("repeated measures: F(%.0f,%.0f) = %.2f, %s; Greenhouse-Geisser epsilon %.3f, %s\n",
             v.repeated.between, v.repeated.within, v.repeated.f, probability(v.repeated.p).c_str(),
             v.epsilon, probability(v.correctedP).c_str());
    text += line("as if all values were of different people: F(%.0f,%.0f) = %.2f, %s", v.independent.between,
                 v.independent.within, v.independent.f, probability(v.independent.p).c_str());
    if (paperResult(result.plan, result.plan.conditions[result.compared.front()]) != nullptr)
        text += " ([004]: F(3,44) = 47.76, printed F(44,47))";
    text += "\nTukey, error of the repeated measures (of different people):\n";
    for (size_t i = 0; i < v.tukey.size(); ++i) {
        const auto name = [&](size_t at) { return result.plan.conditions[result.compared[at]].name; };
        text += line("  %s - %s: %+.1f, q = %.2f, %s (%s)\n", name(v.tukey[i].second).c_str(),
                     name(v.tukey[i].first).c_str(), v.tukey[i].difference, v.tukey[i].q,
                     probability(v.tukey[i].p).c_str(), probability(v.tukeyIndependent[i].p).c_str());
    }
    return text;
}

std::string describePower(const ExperimentResult& result) {
    if (result.power.empty())
        return "";
    std::string text = "power: the share of simulated experiments in which p < 0.05\n" +
                       line("%6s %9s %7s %7s", "people", "reversals", "trials", "ANOVA");
    std::vector<std::string> pairs;
    for (size_t i = 0; i < result.compared.size(); ++i)
        for (size_t j = i + 1; j < result.compared.size(); ++j)
            pairs.push_back(result.plan.conditions[result.compared[i]].name + "/" +
                            result.plan.conditions[result.compared[j]].name);
    for (const std::string& pair : pairs)
        text += line(" %7s", pair.c_str());
    text += "\n";
    for (const PowerRow& row : result.power) {
        text += line("%6zu %9zu %7.1f %7.2f", row.people, row.reversals, row.trials, row.anova);
        for (const double told : row.told)
            text += line(" %7.2f", told);
        text += "\n";
    }
    return text;
}

Json jsonOf(const FTest& test) {
    return {{"f", test.f},
            {"between", test.between},
            {"within", test.within},
            {"error", test.error},
            {"p", test.p}};
}

Json jsonOf(const ExperimentResult& result, const std::vector<Comparison>& pairs) {
    Json json = Json::array();
    for (const Comparison& pair : pairs)
        json.push_back({{"first", result.plan.conditions[result.compared[pair.first]].name},
                        {"second", result.plan.conditions[result.compared[pair.second]].name},
                        {"difference", pair.difference},
                        {"q", pair.q},
                        {"p", pair.p}});
    return json;
}

} // namespace

const PaperResult* paperResult(const StudyPlan& plan, const Condition& condition) {
    static const StudyPlan paper = parseStudy(std::string(paperStudy()), "paper");
    if (plan.name != paper.name)
        return nullptr;
    for (const PaperResult& result : kPaperResults)
        if (result.name == condition.name)
            return &result;
    return nullptr;
}

double degreesAt(const Condition& condition, double level) {
    const auto* polygon = std::get_if<PlanarStimulus>(&condition.comparison);
    if (condition.varied != Varied::Segments || polygon == nullptr || !(level > 0.0))
        return std::numeric_limits<double>::quiet_NaN();
    return polygon->arc.angle / level * 57.29577951308232;
}

ExperimentResult evaluate(const std::vector<PersonSession>& sessions) {
    if (sessions.empty())
        throw Error("report", "", "there is no session", "run touchstone experiment first");
    ExperimentResult result;
    result.plan = sessions.front().plan();
    for (const PersonSession& session : sessions)
        if (session.plan().source != result.plan.source)
            throw Error("report", "person " + std::to_string(session.start().person + 1),
                        "its session is of another study",
                        "keep the sessions of each study in a folder of their own");
    for (size_t i = 0; i < result.plan.conditions.size(); ++i) {
        result.conditions.push_back(resultOf(i, sessions));
        const Condition& condition = result.plan.conditions[i];
        if (!condition.pilot && condition.varied != Varied::Nothing)
            result.compared.push_back(i);
    }
    Thresholds values;
    for (size_t person = 0; person < sessions.size(); ++person) {
        std::vector<double> row;
        for (const size_t condition : result.compared)
            if (const auto threshold = sessions[person].threshold(condition))
                row.push_back(*threshold);
        if (row.size() < result.compared.size())
            continue;
        values.push_back(std::move(row));
        result.complete.push_back(person);
    }
    try {
        result.variance = analyse(values);
    } catch (const Error& error) {
        result.whyNoVariance = error.problem() + " (" + std::to_string(values.size()) + " complete)";
    }
    return result;
}

std::string describe(const ExperimentResult& result) {
    return result.plan.name + "\n" + describeThresholds(result) + describeVariance(result) +
           describePower(result);
}

Json toJson(const ExperimentResult& result) {
    Json json{{"study", result.plan.name}, {"conditions", Json::array()}};
    for (const ConditionResult& row : result.conditions) {
        const Condition& condition = result.plan.conditions[row.condition];
        Json one{{"name", condition.name}, {"title", condition.title}, {"begun", row.begun},
                 {"done", row.done},       {"trials", row.trials},     {"right", row.right}};
        if (!row.thresholds.empty()) {
            one["thresholds"] = row.thresholds;
            one["mean"] = row.mean.mean;
            one["deviation"] = row.mean.deviation;
            one["half95"] = row.mean.half;
            if (const double degrees = degreesAt(condition, row.mean.mean); std::isfinite(degrees))
                one["degrees"] = degrees;
        }
        if (row.observer)
            one["observer"] = *row.observer;
        if (const PaperResult* paper = paperResult(result.plan, condition))
            one["paper"] = {
                {"degrees", paper->degrees}, {"segments", paper->segments}, {"half95", paper->half}};
        json["conditions"].push_back(std::move(one));
    }
    if (result.variance) {
        const Variance& v = *result.variance;
        json["people"] = result.complete.size();
        json["repeated"] = jsonOf(v.repeated);
        json["epsilon"] = v.epsilon;
        json["correctedP"] = v.correctedP;
        json["independent"] = jsonOf(v.independent);
        json["tukey"] = jsonOf(result, v.tukey);
        json["tukeyIndependent"] = jsonOf(result, v.tukeyIndependent);
    } else {
        json["noVariance"] = result.whyNoVariance;
    }
    for (const PowerRow& row : result.power)
        json["power"].push_back({{"people", row.people},
                                 {"reversals", row.reversals},
                                 {"trials", row.trials},
                                 {"anova", row.anova},
                                 {"told", row.told},
                                 {"deviation", row.deviation}});
    json["problems"] = result.problems;
    return json;
}

std::string trialsCsv(const std::vector<PersonSession>& sessions) {
    std::string text = "person,condition,trial,level,angle_deg,reference_first,answer,right,reversal,first_s,"
                       "second_s,device\n";
    for (const PersonSession& session : sessions) {
        std::vector<size_t> number(session.plan().conditions.size(), 0);
        for (const TrialRecord& trial : session.trials()) {
            const Condition& condition = session.plan().conditions[trial.condition];
            const double degrees = degreesAt(condition, trial.level);
            text += line("%zu,%s,%zu,%.17g,", session.start().person + 1, field(condition.name).c_str(),
                         ++number[trial.condition], trial.level);
            text += (std::isfinite(degrees) ? line("%.6f", degrees) : "") +
                    line(",%d,%d,%d,%d,%.3f,%.3f,%s\n", trial.referenceFirst ? 1 : 0, trial.answer,
                         trial.right ? 1 : 0, trial.reversal ? 1 : 0, trial.firstSeconds, trial.secondSeconds,
                         field(session.start().device).c_str());
        }
    }
    return text;
}

std::string thresholdsCsv(const std::vector<PersonSession>& sessions) {
    std::string text = "person,place,condition,trials,done,threshold,angle_deg\n";
    for (const PersonSession& session : sessions)
        for (size_t place = 0; place < session.order().size(); ++place) {
            const size_t at = session.order()[place];
            const Condition& condition = session.plan().conditions[at];
            const auto threshold = session.threshold(at);
            text += line("%zu,%zu,%s,%zu,%d,", session.start().person + 1, place + 1,
                         field(condition.name).c_str(), session.trialsOf(at), session.done(at) ? 1 : 0);
            if (threshold)
                text += line("%.9g", *threshold);
            const double degrees = threshold ? degreesAt(condition, *threshold) : NAN;
            text += "," + (std::isfinite(degrees) ? line("%.6f", degrees) : "") + "\n";
        }
    return text;
}

std::vector<std::string> writeReport(const ExperimentResult& result,
                                     const std::vector<PersonSession>& sessions,
                                     const std::filesystem::path& folder, const study::Provenance& where) {
    std::error_code error;
    std::filesystem::create_directories(folder / "plots", error);
    if (error)
        throw Error((folder / "plots").string(), "", "cannot be made: " + error.message(),
                    "choose a folder that you may write to");
    writeFile(folder / "trials.csv", trialsCsv(sessions));
    writeFile(folder / "thresholds.csv", thresholdsCsv(sessions));
    writeFile(folder / "report.json", toJson(result).dump(2) + "\n");
    writeFile(folder / "report.txt", describe(result));
    std::vector<std::string> problems;
    const auto drawAll = [&](const study::Figure& figure) {
        if (figure.name.empty())
            return;
        if (const std::string problem = study::draw(figure, folder / "plots"); !problem.empty())
            problems.push_back(problem);
    };
    drawAll(thresholdFigure(result, where));
    drawAll(powerFigure(result, where));
    for (const PersonSession& session : sessions)
        drawAll(staircaseFigure(session, where));
    return problems;
}

} // namespace touchstone::experiment
