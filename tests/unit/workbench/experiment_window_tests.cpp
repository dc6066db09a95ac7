// A person's session in the real window: keys alone, killed in the middle, resumed, exported; and nothing on
// the screen that tells the two objects apart.

#include "devices/external/external_packet.h"
#include "experiment/people/person_session.h"
#include "tests/unit/workbench/virtual_display.h"
#include "tests/unit/workbench/window_status.h"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sys/socket.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <chrono>
#include <cmath>
#include <csignal>
#include <functional>
#include <span>
#include <thread>
#include <utility>

namespace touchstone::test::experiment_window_tests {
namespace {

using experiment::PersonSession;

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
    void begin(const std::string& study, const std::vector<std::string>& more = {}) {
        writeTextFile(study_, study);
        start(more);
    }
    void start(const std::vector<std::string>& more = {}) {
        std::filesystem::remove(status_.file());
        Environment environment = display_.environment();
        environment.emplace_back("TOUCHSTONE_VALIDATION=1");
        environment.emplace_back("XDG_STATE_HOME=" + (scratch_ / "state").string());
        std::vector<std::string> arguments{
            TOUCHSTONE_BINARY, "experiment",           study_.string(), "--person", "1",
            "--out",           out_.string(),          "--size",        "1000x780", "--no-noise",
            "--status-json",   status_.file().string()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        program_ = std::make_unique<BackgroundProgram>(arguments, environment, scratch_ / "log");
        corner_ = display_.waitForWindow("Touchstone experiment");
        page("welcome");
    }
    Json status() { return status_.newest(*program_); }
    Json until(const std::string& what, const std::function<bool(const Json&)>& holds) {
        return status_.until(*program_, what, holds);
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
    std::filesystem::path study_ = scratch_ / "study.json", out_ = scratch_ / "out";
    WindowStatus status_{scratch_ / "status.json", scratch_ / "log", Json{{"update", 0}, {"page", ""}}};
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

/// A finger with a contact location display, as a program of its own: it comes down onto the arc and goes to
/// and fro.
class DisplayedFinger {
  public:
    explicit DisplayedFinger(uint16_t port) : socket_(::socket(AF_INET, SOCK_DGRAM, 0)) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        to.sin_port = htons(port);
        (void)::connect(socket_, reinterpret_cast<sockaddr*>(&to), sizeof to);
        thread_ = std::jthread([this](const std::stop_token& stop) { run(stop); });
    }
    ~DisplayedFinger() {
        thread_.request_stop();
        thread_.join();
        ::close(socket_);
    }
    std::atomic<bool> declares{false};
    std::atomic<int> locations{0};
    std::atomic<double> least{0.0}, most{0.0}, force{0.0}, fastest{0.0}; // m, N; m a packet

  private:
    void run(const std::stop_token& stop) {
        bool declared = false;
        for (uint32_t n = 1; !stop.stop_requested(); ++n) {
            // The middle of the pad is 20 mm below the circle's centre, which goes round the arc's own.
            const double angle = 0.35 * std::sin(0.004 * n), depth = std::min(0.0015, -0.02 + 5e-5 * n);
            const double radius = 0.12 - depth;
            const glm::dvec3 pad(radius * std::sin(angle), radius * std::cos(angle) - 0.1 - 0.02, 0.0);
            say(placePacket({.sequence = 2 * n, .position = pad}));
            if (declares && !std::exchange(declared, true))
                say(padPacket({.sequence = 2 * n + 1, .reach = 0.008, .rate = 0.2}));
            listen();
            std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
    }
    void say(std::span<const uint8_t> bytes) { (void)!::send(socket_, bytes.data(), bytes.size(), 0); }
    void listen() {
        std::array<uint8_t, 256> bytes{};
        for (ssize_t size; (size = ::recv(socket_, bytes.data(), bytes.size(), MSG_DONTWAIT)) > 0;) {
            const std::span packet(bytes.data(), static_cast<size_t>(size));
            if (const auto heard = parseForcePacket(packet))
                force = std::max(force.load(), glm::length(heard->force));
            const auto heard = parseLocationPacket(packet);
            if (!heard)
                continue;
            least = std::min(least.load(), heard->location.x);
            most = std::max(most.load(), heard->location.x);
            fastest = std::max(fastest.load(), std::abs(heard->location.x - last_));
            last_ = heard->location.x;
            ++locations;
        }
    }

    int socket_;
    double last_ = 0.0;
    std::jthread thread_;
};

TEST_F(ExperimentWindowTest, ADeviceThatDeclaresADisplayHearsTheContactLocation) {
    const std::string arc =
        R"json({"arc": {"radius": 0.1, "angle": 0.902}, "force": "facets", "location": "facets"})json";
    begin(
        R"json({"touchstoneStudy": 1, "name": "L", "question": "q?", "conditions": [{"name": "C3", "reference": )json" +
            arc +
            R"json(, "comparison": {"polygon": {"radius": 0.1, "angle": 0.902, "segments": 9}, "location": "bezier"},
               "vary": "nothing", "trials": 1}]})json",
        {"--device", "udp:47913"});
    DisplayedFinger finger(47913);
    display_.key("Return");
    page("training");
    until("a force", [&](const Json&) { return finger.force > 0.5; });
    EXPECT_EQ(finger.locations, 0) << "it has declared none";
    finger.declares = true;
    until("locations to both sides",
          [&](const Json&) { return finger.least < -0.005 && finger.most > 0.005; });
    EXPECT_LE(finger.most, 0.008);
    EXPECT_GE(finger.least, -0.008);
    display_.key("Return");
    page("first");
    const int before = finger.locations;
    until("locations of the interval", [&](const Json&) { return finger.locations > before + 500; });
    EXPECT_EQ(program_->stop(), 0) << readFile(scratch_ / "log");
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
} // namespace touchstone::test::experiment_window_tests
