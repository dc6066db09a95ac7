// `touchstone experiment`: a session in the window, a study with simulated people, and the report of any
// sessions.

#include "devices/choice/device_choice.h"
#include "engine/core/error.h"
#include "engine/core/output_file.h"
#include "experiment/people/ideal_observer.h"
#include "experiment/people/power.h"
#include "experiment/report/experiment_report.h"
#include "study/result/provenance.h"
#include "workbench/experiment/experiment_window.h"
#include "workbench/guards/interrupt.h"
#include "workbench/options/experiment_options.h"

#include <array>
#include <cstdio>

namespace touchstone {

namespace {

using namespace experiment;

StudyPlan studyOf(const ExperimentOptions& options) {
    return options.study.empty() ? parseStudy(std::string(paperStudy()), "paper") : readStudy(options.study);
}

std::filesystem::path sessionFile(const ExperimentOptions& options, size_t person) {
    std::array<char, 40> name{};
    std::snprintf(name.data(), name.size(), "person_%02zu%s", person + 1, options.pilots ? "_pilots" : "");
    return options.out / (std::string(name.data()) + kSessionEnding);
}

void makeFolder(const std::filesystem::path& folder) {
    std::error_code error;
    std::filesystem::create_directories(folder, error);
    if (error)
        throw Error(folder.string(), "", "cannot be made: " + error.message(),
                    "choose a folder that you may write to");
}

int publish(ExperimentResult& result, const std::vector<PersonSession>& sessions,
            const ExperimentOptions& options) {
    const std::vector<std::string> undrawn =
        writeReport(result, sessions, options.out, study::provenanceOf(options.commandLine));
    result.problems.insert(result.problems.end(), undrawn.begin(), undrawn.end());
    std::printf("%s%s: %zu sessions\n", describe(result).c_str(), (options.out / "report.json").c_str(),
                sessions.size());
    for (const std::string& problem : result.problems)
        std::fprintf(stderr, "touchstone: problem: %s\n", problem.c_str());
    return result.problems.empty() ? 0 : 1;
}

/// One whole session of a simulated person.
void takePart(const ExperimentOptions& options, const StudyPlan& plan, size_t person,
              std::vector<DifferenceTable>& tables, Attention attention) {
    PersonSession session(sessionFile(options, person), plan,
                          {.person = person,
                           .seed = options.seed,
                           .pilots = options.pilots,
                           .device = "ideal observer, " + options.attention,
                           .synchronise = false});
    const SimulatedPerson who = personOf(options.seed, person);
    Draw draw(options.seed * 2654435761u + person);
    const double exposure = ObserverNoise{}.exposure;
    while (!session.finished()) {
        session.endTraining();
        DifferenceTable& table = tables[session.condition()];
        const double right = shareRight(
            sensitivity(table.condition(), table.at(session.level()), who.force, who.acuity, {}, attention));
        const bool knows = draw.uniform() < right;
        session.answer(session.isReference(1) == knows ? 1 : 2, exposure, exposure);
    }
}

int observe(const ExperimentOptions& options) {
    const StudyPlan plan = studyOf(options);
    makeFolder(options.out);
    const Attention attention =
        options.attention == "tactile" ? Attention::TactileFirst : Attention::Everything;
    std::vector<DifferenceTable> tables;
    for (const Condition& condition : plan.conditions)
        tables.emplace_back(condition);
    for (size_t person = 0; person < static_cast<size_t>(options.people); ++person)
        takePart(options, plan, person, tables, attention);
    std::vector<PersonSession> sessions;
    for (size_t person = 0; person < static_cast<size_t>(options.people); ++person)
        sessions.push_back(PersonSession::read(sessionFile(options, person)));
    ExperimentResult result = evaluate(sessions);
    for (ConditionResult& row : result.conditions)
        if (plan.conditions[row.condition].varied != Varied::Nothing)
            row.observer = thresholdOf(tables[row.condition], {}, {}, attention);
    if (!options.pilots && result.compared.size() > 1) {
        std::vector<DifferenceTable> compared;
        for (const size_t at : result.compared)
            compared.push_back(tables[at]);
        result.power = powerOf(compared, {.seed = options.seed, .attention = attention});
    }
    return publish(result, sessions, options);
}

/// A new session, or the one that the file holds. Throws Error where that is of another study.
PersonSession sessionOf(const ExperimentOptions& options, const std::filesystem::path& file) {
    const StudyPlan plan = studyOf(options);
    const auto person = static_cast<size_t>(options.person) - 1;
    if (!std::filesystem::exists(file))
        return PersonSession(file, plan,
                             {.person = person,
                              .seed = options.seed,
                              .pilots = options.pilots,
                              .device = options.device.empty() ? "mouse" : options.device});
    const PersonSession found = PersonSession::read(file); // changes nothing
    if (found.plan().source != plan.source)
        throw Error(file.string(), "",
                    "it is a session of another study, or of this one before it was changed",
                    "give the study it was begun with, or another --out");
    if (found.start().person != person || found.start().pilots != options.pilots)
        throw Error(file.string(), "", "it is the session of another person", "give that person's number");
    PersonSession session(file);
    if (!session.note().empty())
        std::fprintf(stderr, "touchstone: warning: %s: %s\n", file.c_str(), session.note().c_str());
    return session;
}

/// A person in the window.
int lead(const ExperimentOptions& options) {
    catchInterrupts();
    if (!options.device.empty() && options.device != "mouse")
        requireDevice(options.device, "mouse");
    makeFolder(options.out);
    const std::filesystem::path file = sessionFile(options, static_cast<size_t>(options.person) - 1);
    std::vector<PersonSession> sessions;
    sessions.push_back(sessionOf(options, file));
    {
        ExperimentWindow window(options, sessions.front());
        while (!window.closed())
            window.frame();
    }
    std::filesystem::path csv = file;
    csv.replace_extension(".csv");
    writeFile(csv, trialsCsv(sessions));
    std::printf("%s: %zu trials, %s; %s\n", file.c_str(), sessions.front().trials().size(),
                sessions.front().finished() ? "finished" : "to be resumed with the same command",
                csv.c_str());
    return 0;
}

int report(const ExperimentOptions& options) {
    std::vector<std::string> problems;
    const std::vector<PersonSession> sessions = readSessions(options.out, problems);
    if (sessions.empty())
        for (const std::string& problem : problems)
            std::fprintf(stderr, "touchstone: problem: %s\n", problem.c_str());
    ExperimentResult result = evaluate(sessions);
    result.problems = std::move(problems);
    return publish(result, sessions, options);
}

} // namespace

int experimentCommand(const ExperimentOptions& options) {
    if (options.printStudy) {
        const StudyPlan plan = studyOf(options); // a study of one's own is checked
        std::printf("%s\n",
                    options.study.empty() ? std::string(paperStudy()).c_str() : plan.source.dump(2).c_str());
        return 0;
    }
    if (options.observer)
        return observe(options);
    if (options.person > 0)
        return lead(options);
    return report(options);
}

} // namespace touchstone
