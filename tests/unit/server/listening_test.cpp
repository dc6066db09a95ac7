// Where the server may listen, who may call it how, and when it reads the servo.

#include "server/access.h"
#include "server/pump_timer.h"

#include <gtest/gtest.h>
#include <poll.h>

#include <algorithm>
#include <cmath>

namespace touchstone::server {
namespace {

ServeOptions at(const std::string& address, const std::string& certificate = "") {
    ServeOptions options;
    options.port = 8790;
    options.address = address;
    options.certificate = options.key = certificate;
    return options;
}

TEST(Listening, OffLoopbackNeedsTls) {
    EXPECT_EQ(listenProblem(at("127.0.0.1")), "");
    EXPECT_EQ(listenProblem(at("127.8.9.1")), "");
    for (const char* address : {"0.0.0.0", "10.0.0.1", "192.168.1.5", "8.8.8.8"}) {
        const std::string problem = listenProblem(at(address));
        EXPECT_NE(problem.find("not on loopback"), std::string::npos) << problem;
        EXPECT_NE(problem.find("stunnel"), std::string::npos) << problem;
    }
    for (const char* address : {"", "localhost", "127.1", "127.0.0.1 ", "::1", "127.0.0.256"})
        EXPECT_NE(listenProblem(at(address)).find("no IPv4 address"), std::string::npos) << address;
    EXPECT_NE(listenProblem(at("10.0.0.1", "/nowhere/key.pem")), "");
    ServeOptions socketAlone = at("0.0.0.0");
    socketAlone.port = 0;
    EXPECT_EQ(listenProblem(socketAlone), "");
}

TEST(Listening, NamesAreOwn) {
    const OwnNames loopback = ownNames(at("127.0.0.1"));
    EXPECT_TRUE(isOwnHost("127.0.0.1:8790", loopback));
    EXPECT_TRUE(isOwnHost("localhost:8790", loopback));
    for (const char* host : {"localhost", "localhost:879", "127.0.0.1:87900", "evil.example:8790", "",
                             ":8790", "127.0.0.1.evil.example:8790", "127.0.0.1:8790@evil.example"})
        EXPECT_FALSE(isOwnHost(host, loopback)) << host;
    EXPECT_TRUE(isOwnOrigin("", loopback));
    EXPECT_TRUE(isOwnOrigin("http://127.0.0.1:8790", loopback));
    for (const char* origin : {"null", "https://127.0.0.1:8790", "http://evil.example", "127.0.0.1:8790"})
        EXPECT_FALSE(isOwnOrigin(origin, loopback)) << origin;
    ServeOptions lab = at("10.0.0.1", "pem");
    lab.names = {"lab.example"};
    const OwnNames names = ownNames(lab);
    EXPECT_EQ(urlOf(names), "https://lab.example:8790");
    EXPECT_TRUE(isOwnHost("10.0.0.1:8790", names));
    EXPECT_TRUE(isOwnOrigin("https://lab.example:8790", names));
    EXPECT_FALSE(isOwnOrigin("http://lab.example:8790", names));
    EXPECT_FALSE(isOwnHost("localhost:8790", names));
    lab.port = 443;
    EXPECT_TRUE(isOwnHost("lab.example", ownNames(lab))); // browsers leave the usual port out
}

TEST(Listening, OtherPagesNeedTheirOrigin) {
    ServeOptions options = at("127.0.0.1");
    options.origins = {"http://a:443", "https://a:80", "http://a:8080"}; // not the usual port of each
    EXPECT_EQ(listenProblem(options), "");
    options.origins = {"http://localhost:8000", "https://lab.example"};
    EXPECT_EQ(listenProblem(options), "");
    const OwnNames names = ownNames(options);
    for (const char* origin : {"http://localhost:8000", "https://lab.example", "http://127.0.0.1:8790", ""})
        EXPECT_TRUE(isOwnOrigin(origin, names)) << origin;
    for (const char* origin : {"http://localhost:800", "http://localhost:80000", "https://localhost:8000",
                               "http://lab.example", "https://lab.example.evil.example", "null"})
        EXPECT_FALSE(isOwnOrigin(origin, names)) << origin;
    EXPECT_FALSE(isOwnHost("localhost:8000", names)) << "a page's place is no name of the server's";
    for (const char* wrong : {"", "null", "*", "localhost:8000", "http://", "http://a/", "http://A",
                              "ftp://a", "http://a b", "http://*.example", "http://a:80", "https://a:443"}) {
        options.origins = {wrong};
        EXPECT_NE(listenProblem(options).find("no origin"), std::string::npos) << wrong;
    }
}

TEST(Listening, EachAddressHasItsToken) {
    EXPECT_EQ(tokenFileName(at("127.0.0.1")), "serve-8790.token");
    EXPECT_EQ(tokenFileName(at("0.0.0.0")), "serve-8790.token"); // has the port of 127.0.0.1
    EXPECT_EQ(tokenFileName(at("127.0.0.2")), "serve-127.0.0.2-8790.token");
}

/// Reads after ticks that end `took` s after their deadlines, for `seconds`; the age of what it finds.
double worstAge(PumpPlan& plan, double tick, double took, double period, double seconds) {
    const double started = 100.0;
    double now = started + 0.3 * tick, worst = 0.0, read = 0.0;
    while (now < started + seconds) {
        const double newest = std::floor((now - started - took) / tick) * tick;
        if (newest > read && now > started + 0.5 * seconds) // it has learnt by then
            worst = std::max(worst, now - (started + newest + took));
        read = newest;
        const double next = plan.after(now, {started, newest, took}, period);
        EXPECT_GT(next, now);
        EXPECT_LT(next, now + period + 2.0 * tick);
        now = next;
    }
    return worst;
}

TEST(PumpPlan, ReadsSoonAfterTicksEnd) {
    for (const double took : {2e-6, 4e-5, 3e-4}) {
        PumpPlan every(1e-3), rare(1e-3), fast(2.5e-4);
        EXPECT_LT(worstAge(every, 1e-3, took, 1e-3, 4.0), 1.5e-4) << took;
        EXPECT_LT(worstAge(rare, 1e-3, took, 1.0 / 60.0, 60.0), 1.5e-4) << took;
        if (took < 1e-4) {
            EXPECT_LT(worstAge(fast, 2.5e-4, took, 1e-3, 4.0), 1.5e-4) << took;
        }
    }
}

TEST(PumpPlan, ASilentServoIsAskedAtItsRate) {
    PumpPlan plan(1e-3);
    double now = 10.0;
    int readings = 0;
    for (; now < 11.0; ++readings)
        now = plan.after(now, {0.0, 5.0, 1e-4}, 1.0 / 60.0);
    EXPECT_LT(readings, 80);
    EXPECT_GT(readings, 50);
}

TEST(KernelTimer, RingsOnce) {
    const KernelTimer timer;
    pollfd waits{timer.descriptor(), POLLIN, 0};
    EXPECT_EQ(poll(&waits, 1, 0), 0);
    timer.set(monotonicNow());
    EXPECT_EQ(poll(&waits, 1, 10'000), 1);
    timer.clear();
    EXPECT_EQ(poll(&waits, 1, 0), 0);
    timer.set(monotonicNow() - 5.0); // past: at once
    EXPECT_EQ(poll(&waits, 1, 10'000), 1);
}

} // namespace
} // namespace touchstone::server
