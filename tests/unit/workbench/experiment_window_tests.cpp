// A person's session in the real window: keys alone, killed in the middle, resumed, exported; and nothing on
// the screen that tells the two objects apart.

#include "experiment/people/person_session.h"
#include "tests/unit/workbench/virtual_display.h"

#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <csignal>
#include <functional>
#include <thread>

namespace touchstone::test {
namespace {

using experiment::PersonSession;
using Json = nlohmann::json;

/// Two conditions of few trials: one varies segments, one nothing.
constexpr const char* kStudy = R"json({
  "touchstoneStudy": 1, "name": "Short study", "question": "Which of the two was the smooth object?", "order": "given",
  "staircase": {"largeReversals": 1, "reversals": 2, "averaged": 2, "mostTrials": 6},
  "conditions": [
    {"name": "A", "reference": {"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "held"},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "held"},
     "vary": "segments", "start": 4, "largeStep": 2, "smallStep": 1, "lowest": 2, "highest": 100},
    {"name": "B", "reference": {"arc": {"radius": 0.1, "angle": 0.902}},
     "comparison": {"polygon": {"radius": 0.1, "angle": 0.902, "segments": 3}}, "vary": "nothing", "trials": 3}
  ]
})json";

class ExperimentWindowTest : public testing::Test {
  protected:
    void begin(const std::string& study) {
        writeTextFile(study_, study);
        start();
    }
    void start() {
        std::filesystem::remove(status_);
        Environment environment = display_.environment();
        environment.emplace_back("TOUCHSTONE_VALIDATION=1");
        environment.emplace_back("XDG_STATE_HOME=" + (scratch_ / "state").string());
        program_ = std::make_unique<BackgroundProgram>(
            std::vector<std::string>{TOUCHSTONE_BINARY, "experiment", study_.string(), "--person", "1",
                                     "--out", out_.string(), "--size", "1000x780", "--no-noise",
                                     "--status-json", status_.string()},
            environment, scratch_ / "log");
        corner_ = display_.waitForWindow("Touchstone experiment");
        page("welcome");
    }
    Json status() {
        if (!program_->running())
            throw std::runtime_error("the window has closed: " + readFile(scratch_ / "log"));
        const std::string text = readFile(status_);
        return text.empty() ? Json{{"update", 0}, {"page", ""}} : Json::parse(text);
    }
    Json until(const std::string& what, const std::function<bool(const Json&)>& holds) {
        for (int i = 0; i < 1200; ++i) {
            const Json now = status();
            if (now["update"] > 0 && holds(now))
                return now;
            std::this_thread::sleep_for(std::chrono::milliseconds(50));
        }
        throw std::runtime_error("waited in vain for " + what + ": " + status().dump(2) +
                                 readFile(scratch_ / "log"));
    }
    Json page(const std::string& name) {
        return until("page " + name, [&](const Json& s) { return s["page"] == name; });
    }
    Json later() {
        const int update = status()["update"];
        return until("a newer status", [&](const Json& s) { return s["update"] >= update + 3; });
    }
    /// One whole trial; `answer` as a key.
    void trial(const std::string& answer) {
        const int before = page("first")["trials"];
        display_.key("Return");
        page("second");
        display_.key(answer);
        until("the choice", [&](const Json& s) { return s["chosen"] == std::stoi(answer); });
        display_.key("Return");
        until("the next page",
              [&](const Json& s) { return s["trials"] == before + 1 && s["page"] != "second"; });
    }
    [[nodiscard]] PersonSession session() const { return PersonSession::read(out_ / "person_01.session"); }

    ScratchFolder scratch_;
    std::filesystem::path study_ = scratch_ / "study.json", out_ = scratch_ / "out",
                          status_ = scratch_ / "status.json";
    VirtualDisplay display_{1280, 800};
    VirtualDisplay::Place corner_;
    std::unique_ptr<BackgroundProgram> program_;
};

TEST_F(ExperimentWindowTest, GoesToItsEndByKeysIsKilledResumedAndExported) {
    begin(kStudy);
    display_.key("1"); // means nothing here
    display_.key("Return");
    page("training");
    display_.key("Return");
    trial("1");
    trial("2");
    display_.key("Return");
    page("second");
    display_.key("2");
    program_->send(SIGKILL);
    program_->wait();
    const size_t answered = session().trials().size();
    EXPECT_EQ(answered, 2u) << "the choice was not confirmed";

    start();
    display_.key("Return");
    page("first"); // the training is over; the trial is shown anew, from its first object
    for (int guard = 0; guard < 20; ++guard) {
        const Json s = status();
        if (s["page"] == "finished")
            break;
        if (s["page"] == "training") {
            display_.key("Return");
            page("first");
        }
        trial(guard % 2 == 0 ? "1" : "2");
    }
    page("finished");
    const Json last = later();
    EXPECT_EQ(last["validation_messages"], 0) << readFile(scratch_ / "log");
    EXPECT_EQ(last["allocations_in_tick"], 0);
    EXPECT_GT(last["ticks"], 1000);
    EXPECT_EQ(program_->stop(), 0) << readFile(scratch_ / "log");

    const PersonSession whole = session();
    EXPECT_TRUE(whole.finished());
    EXPECT_EQ(whole.trialsOf(1), 3u);
    for (const experiment::TrialRecord& t : whole.trials()) {
        EXPECT_GT(t.firstSeconds, 0.0);
        EXPECT_GT(t.secondSeconds, 0.0);
    }
    const std::string csv = readFile(out_ / "person_01.csv");
    EXPECT_EQ(static_cast<size_t>(std::ranges::count(csv, '\n')), whole.trials().size() + 1);
}

TEST_F(ExperimentWindowTest, NothingOnTheScreenTellsTheObjectsApart) {
    begin(kStudy);
    display_.key("Return");
    page("training");
    display_.key("Return");
    // Every picture of each interval, by what was felt in it; the hand is on the object.
    display_.move({corner_.x + 500, corner_.y + 300});
    std::vector<std::array<ScreenPicture, 2>> pictures;
    for (int i = 0; i < 4; ++i) {
        page("first");
        later();
        std::array<ScreenPicture, 2> both;
        both[0] = display_.screen();
        display_.key("Return");
        page("second");
        later();
        both[1] = display_.screen();
        pictures.push_back(std::move(both));
        display_.key("1");
        until("the choice", [](const Json& s) { return s["chosen"] == 1; });
        display_.key("Return");
        until("the next trial", [&](const Json& s) { return s["trials"] == i + 1 && s["page"] != "second"; });
        if (status()["page"] == "training")
            break;
    }
    const PersonSession done = session();
    const auto trials = done.trials();
    ASSERT_GE(trials.size(), 2u);
    ASSERT_GE(pictures.size(), 2u);
    EXPECT_TRUE(std::ranges::any_of(trials, [](const auto& t) { return t.referenceFirst; }));
    EXPECT_TRUE(std::ranges::any_of(trials, [](const auto& t) { return !t.referenceFirst; }));
    size_t text = 0;
    for (const auto& pixel : pictures[0][0].pixels)
        text += pixel[0] > 150 ? 1 : 0;
    EXPECT_GT(text, 200u) << "the pages have something on them";
    EXPECT_NE(pictures[0][0].pixels, pictures[0][1].pixels) << "object 1 and object 2 are named";
    for (size_t i = 1; i < pictures.size(); ++i)
        for (const size_t interval : {0u, 1u})
            EXPECT_EQ(pictures[i][interval].pixels, pictures[0][interval].pixels)
                << "trial " << i << ", interval " << interval + 1;
}

TEST_F(ExperimentWindowTest, SpaceAndEscapeTakeTheForceAwayAndTheAnswerWaits) {
    begin(kStudy);
    display_.key("Return");
    page("training");
    display_.move({corner_.x + 500, corner_.y + 200}); // in the air, then onto the arc
    later();
    display_.move({corner_.x + 500, corner_.y + 430});
    until("a force", [](const Json& s) { return s["command_n"] > 0.1; });
    for (const char* key : {"space", "Escape"}) {
        display_.key(key);
        until("no force", [](const Json& s) { return s["force"] == false && s["command_n"] == 0.0; });
        display_.key("Return");
        EXPECT_EQ(later()["page"], "training");
        display_.key("space");
        until("the force again", [](const Json& s) { return s["force"] == true && s["command_n"] > 0.1; });
    }
}

TEST_F(ExperimentWindowTest, ComparesModelsWithSettings) {
    const std::string doughnut = TOUCHSTONE_ASSETS "/doughnut.glb";
    begin(
        R"json({"touchstoneStudy": 1, "name": "Shading", "question": "Which one was shaded?", "conditions": [
        {"name": "S", "vary": "nothing", "trials": 2,
         "reference": {"model": ")json" +
        doughnut + R"json(", "set": {"forceShading": "twoPass"}},
         "comparison": {"model": ")json" +
        doughnut + R"json(", "set": {"forceShading": "off", "friction": "off"}}},
        {"name": "C", "vary": "nothing", "trials": 1, "reference": {"arc": {"radius": 0.1, "angle": 0.902}},
         "comparison": {"polygon": {"radius": 0.1, "angle": 0.902, "segments": 3}}}]})json");
    display_.key("Return");
    page("training");
    display_.move({corner_.x + 300, corner_.y + 390}); // the ring is seen from the front
    later();                                           // the hand comes to hover there
    display_.press();
    until("the doughnut to be felt",
          [](const Json& s) { return s["touching"] == true && s["command_n"] > 0.2; });
    display_.release();
    until("nothing to be felt",
          [](const Json& s) { return s["touching"] == false && s["command_n"] == 0.0; });
    display_.key("Return");
    trial("1");
    trial("2");
    page("training"); // of curves, by another servo
    display_.key("Return");
    trial("1");
    page("finished");
    EXPECT_EQ(program_->stop(), 0) << readFile(scratch_ / "log");
    EXPECT_TRUE(session().finished());
}

TEST_F(ExperimentWindowTest, RefusesASessionOfAnotherStudyAndKeepsIt) {
    begin(kStudy);
    display_.key("Return");
    page("training");
    EXPECT_EQ(program_->stop(), 0);
    const std::string before = readFile(out_ / "person_01.session");
    std::string other = kStudy;
    other.replace(other.find("Short"), 5, "Other");
    writeTextFile(study_, other);
    const ProgramResult result = runProgram(
        {TOUCHSTONE_BINARY, "experiment", study_.string(), "--person", "1", "--out", out_.string()},
        display_.environment());
    EXPECT_EQ(result.status, 1);
    EXPECT_NE(result.err.find("another study"), std::string::npos) << result.err;
    const std::string after = readFile(out_ / "person_01.session");
    EXPECT_EQ(after, before);
}

} // namespace
} // namespace touchstone::test
