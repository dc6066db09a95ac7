// A session survives a crash at any byte, and refuses what was edited.

#include "engine/core/error.h"
#include "experiment/people/person_session.h"
#include "tests/support/program.h"

#include <gtest/gtest.h>

#include <fstream>
#include <string>

namespace touchstone::experiment {
namespace {

using test::readFile;
using test::ScratchFolder;
using test::writeTextFile;

StudyPlan paperPlan() {
    return parseStudy(std::string(paperStudy()), "paper");
}

/// Answers as somebody does who can tell up to `limit` segments.
void answerOne(PersonSession& session, double limit) {
    if (session.training())
        session.endTraining();
    const bool knows = session.level() <= limit || session.trials().size() % 2 == 0;
    session.answer(session.isReference(1) == knows ? 1 : 2, 1.0, 2.0);
}

std::string openingProblem(const std::filesystem::path& file) {
    try {
        const PersonSession session(file);
        return "";
    } catch (const Error& error) {
        return error.what();
    }
}

TEST(PersonSession, LeadsThroughAllConditionsInTheOrderOfTheSquare) {
    const ScratchFolder folder;
    PersonSession session(folder / "a.session", paperPlan(),
                          {.person = 2, .seed = 7, .device = "test", .synchronise = false});
    EXPECT_EQ(session.order(), paperPlan().orderFor(2));
    EXPECT_TRUE(session.training());
    session.answer(1);
    EXPECT_TRUE(session.trials().empty()) << "not before the training's end";
    while (!session.finished())
        answerOne(session, 60.0);
    for (const size_t condition : session.order())
        EXPECT_TRUE(session.threshold(condition).has_value());
    EXPECT_FALSE(session.threshold(4).has_value()) << "a pilot";
    const PersonSession read = PersonSession::read(folder / "a.session");
    EXPECT_TRUE(read.finished());
    EXPECT_EQ(read.trials().size(), session.trials().size());
    for (const size_t condition : session.order())
        EXPECT_EQ(read.threshold(condition), session.threshold(condition));
    EXPECT_EQ(read.start().device, "test");
}

/// Killed after any number of bytes (each 23rd is tried, whole lines among them), a session goes on at the
/// first answer that is not whole, and shows the same.
TEST(PersonSession, GoesOnAfterACrashInTheMiddleOfALine) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "a.session", cut = folder / "b.session";
    {
        PersonSession session(file, paperPlan(), {.person = 0, .seed = 3, .synchronise = false});
        for (int i = 0; i < 12; ++i)
            answerOne(session, 60.0);
    }
    const std::string text = readFile(file);
    const size_t header = text.find('\n') + 1;
    for (size_t size = header; size <= text.size(); size += 23) {
        std::filesystem::remove(cut);
        std::filesystem::remove(folder / "b.session.cut");
        writeTextFile(cut, text.substr(0, size));
        size_t trials = 0, whole = 0;
        for (size_t at = 0;
             (at = text.find("\"trial\",", at)) != std::string::npos && text.find('\n', at) < size; ++at)
            ++whole;
        {
            PersonSession session(cut);
            trials = session.trials().size();
            const bool torn = text[size - 1] != '\n';
            EXPECT_EQ(!session.note().empty(), torn) << size;
            EXPECT_EQ(std::filesystem::exists(folder / "b.session.cut"), torn) << "nothing is lost";
            while (session.trials().size() < 12)
                answerOne(session, 60.0);
        }
        EXPECT_EQ(trials, whole) << size;
        const PersonSession again = PersonSession::read(cut), first = PersonSession::read(file);
        ASSERT_EQ(again.trials().size(), 12u);
        for (size_t i = 0; i < 12; ++i) {
            EXPECT_EQ(again.trials()[i].level, first.trials()[i].level);
            EXPECT_EQ(again.trials()[i].referenceFirst, first.trials()[i].referenceFirst);
        }
    }
    writeTextFile(cut, text.substr(0, header / 2));
    EXPECT_NE(openingProblem(cut).find("no whole line"), std::string::npos);
}

/// Each changed byte is found, and the file is left as it is.
TEST(PersonSession, RefusesAnEditedFile) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "a.session";
    {
        PersonSession session(file, paperPlan(), {.person = 0, .seed = 3, .synchronise = false});
        for (int i = 0; i < 3; ++i)
            answerOne(session, 60.0);
    }
    const std::string text = readFile(file);
    for (size_t at = 0; at + 1 < text.size(); at += 7) {
        std::string edited = text;
        edited[at] = edited[at] == '1' ? '2' : '1';
        if (edited == text)
            continue;
        writeTextFile(file, edited);
        EXPECT_NE(openingProblem(file), "") << at;
        EXPECT_EQ(readFile(file), edited);
    }
    // A whole line left out, and two exchanged.
    const size_t second = text.find('\n') + 1, third = text.find('\n', second) + 1;
    writeTextFile(file, text.substr(0, second) + text.substr(third));
    EXPECT_NE(openingProblem(file).find("line 2"), std::string::npos) << openingProblem(file);
    std::string other = text;
    other.replace(other.find("\"touchstoneSession\":1"), 21, "\"touchstoneSession\":9");
    writeTextFile(file, other);
    EXPECT_NE(openingProblem(file).find("version 9"), std::string::npos);
    writeTextFile(file, "{\"something\":1}\n");
    EXPECT_NE(openingProblem(file).find("no session"), std::string::npos);
    EXPECT_NE(openingProblem(folder / "missing.session").find("cannot be opened"), std::string::npos);
    EXPECT_NE(openingProblem(folder.path()).find("cannot be opened"), std::string::npos) << "a folder";
}

TEST(PersonSession, IsNotBegunTwiceNorOpenTwice) {
    const ScratchFolder folder;
    const std::filesystem::path file = folder / "a.session";
    const PersonSession session(file, paperPlan(), {.synchronise = false});
    EXPECT_THROW(PersonSession(file, paperPlan(), SessionStart{}), Error);
    EXPECT_NE(openingProblem(file).find("another program"), std::string::npos);
    EXPECT_NO_THROW((void)PersonSession::read(file));
}

/// The order of the stimuli is even, and another one for another seed.
TEST(PersonSession, ShowsTheReferenceFirstInHalfOfTheTrials) {
    const ScratchFolder folder;
    PersonSession session(folder / "a.session", paperPlan(), {.seed = 11, .synchronise = false});
    while (!session.finished())
        answerOne(session, 60.0);
    size_t first = 0;
    for (const TrialRecord& trial : session.trials())
        first += trial.referenceFirst ? 1 : 0;
    const double share = static_cast<double>(first) / static_cast<double>(session.trials().size());
    EXPECT_NEAR(share, 0.5, 0.15);
}

TEST(PersonSession, ReadsAFolderAndNamesWhatItCannotRead) {
    const ScratchFolder folder;
    { PersonSession session(folder / "b.session", paperPlan(), {.synchronise = false}); }
    writeTextFile(folder / "a.session", "nonsense\n");
    writeTextFile(folder / "notes.txt", "nothing\n");
    std::vector<std::string> problems;
    EXPECT_EQ(readSessions(folder.path(), problems).size(), 1u);
    ASSERT_EQ(problems.size(), 1u);
    EXPECT_NE(problems[0].find("a.session"), std::string::npos);
}

} // namespace
} // namespace touchstone::experiment
