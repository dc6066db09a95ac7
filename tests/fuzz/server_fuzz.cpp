// Random messages of `touchstone serve`'s protocol from clients that come, drive and vanish: right ones,
// right ones with wrong members, and damaged texts. None may crash or pass a limit, and each is answered.
// server_fuzz [SECONDS [SEED]]; CTest runs ten seconds, the long form is an hour (3600).

#include "server/touch_server.h"

#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

using namespace touchstone::server;
using Json = nlohmann::json;

constexpr double kMostForce = 8.5; // N, of the simulated hand's device

[[noreturn]] void fail(const std::string& what, const std::string& message) {
    std::fprintf(stderr, "server_fuzz: %s\n%.2000s\n", what.c_str(), message.c_str());
    std::exit(1);
}

long residentPages() {
    long all = 0, resident = 0;
    std::ifstream("/proc/self/statm") >> all >> resident;
    return resident;
}

class Fuzz {
  public:
    Fuzz(const ServeOptions& options, uint64_t seed) : server_(options, kToken), random_(seed) {}

    void step() {
        if (clients_.size() < 3 || (clients_.size() < 16 && below(200) == 0))
            join();
        if (below(500) == 0)
            leave(below(clients_.size()));
        if (below(2000) == 0)
            server_.takeBack();
        if (below(8) == 0)
            server_.pump();
        if (clients_.empty())
            return;
        const size_t from = below(clients_.size());
        const std::string text = anyText();
        ++sent;
        if (!server_.receive(clients_[from], text))
            leave(from);
        read(text);
    }

    uint64_t sent = 0, answered = 0, refused = 0, states = 0, rendered = 0, touched = 0;

  private:
    size_t below(size_t count) { return count > 0 ? random_() % count : 0; }
    template <class T, size_t N>
    const T& oneOf(const T (&all)[N]) {
        return all[below(N)];
    }

    void join() {
        clients_.push_back(++numbers_);
        server_.join(numbers_, below(2) == 0);
        (void)server_.receive(numbers_,
                              Json{{"do", "authenticate"}, {"token", below(8) == 0 ? "" : kToken}}.dump());
    }
    void leave(size_t i) {
        server_.leave(clients_[i]);
        clients_.erase(clients_.begin() + static_cast<ptrdiff_t>(i));
    }

    /// Every message is JSON, every command within the device's limit.
    void read(const std::string& cause) {
        for (const Outgoing& message : server_.takeOutgoing()) {
            if (message.binary) {
                if (message.bytes.size() < 16 || (message.bytes.size() - 16) % 112 != 0)
                    fail("a torn block of ticks", cause);
                continue;
            }
            const Json json = Json::parse(message.bytes, nullptr, false);
            if (!json.is_object())
                fail("an answer is no JSON object: " + message.bytes, cause);
            if (json.contains("ok")) {
                ++answered;
                refused += json["ok"] == false ? 1 : 0;
                if (json["ok"] == false && json["error"].get<std::string>().empty())
                    fail("refused without a word", cause);
            }
            touched += json.value("event", "") == "touched" ? 1 : 0;
            if (json.value("event", "") != "state")
                continue;
            ++states;
            rendered += json["rendered"] == true ? 1 : 0;
            const auto command = json["command"].get<std::vector<double>>();
            const double force = std::hypot(command[0], command[1], command[2]);
            if (!(force <= kMostForce + 1e-9))
                fail("a command of " + std::to_string(force) + " N", cause);
        }
    }

    double anyNumber() {
        static constexpr double kSpecial[]{0.0,   -0.0, 1.0,  -1.0,   0.05, 1e-300,
                                           1e300, 1e9,  -1e9, 1000.0, 60.0};
        return below(3) == 0 ? oneOf(kSpecial) : std::uniform_real_distribution<double>(-0.2, 0.2)(random_);
    }
    Json anyVector() {
        Json vector = Json::array();
        for (size_t i = 0, count = below(20) == 0 ? below(5) : 3; i < count; ++i)
            vector.push_back(anyNumber());
        return vector;
    }
    Json anyPlanes() {
        Json planes = Json::array();
        for (size_t i = 0, count = below(below(20) == 0 ? 6 : 4); i < count; ++i)
            planes.push_back(below(8) == 0 ? anyVector()
                                           : Json::array({below(2) == 0 ? 1.0 : -1.0, 0.0, 0.0}));
        return planes;
    }
    Json anyValue(int depth = 0) {
        switch (below(depth < 3 ? 9 : 6)) {
        case 0:
            return nullptr;
        case 1:
            return below(2) == 0;
        case 2:
            return anyNumber();
        case 3:
            return static_cast<int64_t>(random_());
        case 4:
            return std::string(below(40), static_cast<char>(below(128)));
        case 5:
            return static_cast<uint64_t>(below(4));
        case 6:
            return anyVector();
        case 7:
            return Json{{"a", anyValue(depth + 1)}};
        default:
            return Json::array({anyValue(depth + 1), anyValue(depth + 1)});
        }
    }

    /// A message as a client would send it.
    Json plausible() {
        static const char* const kSettings[]{"stiffness", "damping", "staticFriction", "friction",
                                             "contact",   "texture", "proxyRadius",    "passivity",
                                             "none such", ""};
        static const char* const kValues[]{"0",      "1",     "900",  "-1",      "1e999",   "nan",   "off",
                                           "zilles", "sweep", "rays", "control", "observe", "0.001", ""};
        static const char* const kNumbers[]{
            "stiffness", "damping", "staticFriction", "dynamicFriction", "viscousFriction", "voxelSize", "x"};
        static const char* const kScenes[]{"box.glb", "plane.glb", "../box.glb", "/etc/passwd",
                                           "",        ".",         "none.glb"};
        static const char* const kPlain[]{"ping",    "settings",     "materials", "drive",
                                          "release", "authenticate", "objects",   "halt"};
        switch (below(below(50) == 0 ? 14 : 11)) {
        case 0:
            return {{"do", oneOf(kPlain)}, {"token", kToken}};
        case 1:
            return {{"do", "subscribe"}, {"ticks", below(2) == 0}, {"states", anyNumber() * 5000.0}};
        case 2:
            return {{"do", "force"}, {"on", below(4) != 0}};
        case 3:
            return {{"do", "set"}, {"name", oneOf(kSettings)}, {"value", oneOf(kValues)}};
        case 4:
            return {{"do", "material"},
                    {"material", below(3)},
                    {"name", oneOf(kNumbers)},
                    {"value", below(4) == 0 ? Json() : Json(std::abs(anyNumber()) * 1000.0)}};
        case 5:
            return {{"do", "render"}, {"on", below(4) != 0}};
        case 6:
        case 7:
        case 8:
            return {{"do", "contact"},
                    {"touching", below(8) != 0},
                    {"proxy", anyVector()},
                    {"stiffness", std::abs(anyNumber()) * 1e4},
                    {"damping", std::abs(anyNumber())},
                    {"planes", anyPlanes()}};
        case 9:
            return {{"do", "drive"}};
        case 10:
            return {{"do", "move"},
                    {"object", below(3)},
                    {"position", anyVector()},
                    {"orientation", below(3) == 0 ? Json::array({anyNumber(), 0.0, 1.0, 0.0})
                                                  : Json::array({0.0, 0.6, 0.8, 0.0})},
                    {"speed", std::abs(anyNumber())},
                    {"turn", std::abs(anyNumber())}};
        case 11:
            return below(4) == 0 ? Json{{"do", "load"}, {"bytes", std::string(below(60), 'A')}}
                                 : Json{{"do", "load"}, {"scene", oneOf(kScenes)}};
        case 12:
            return anyTouch();
        default:
            return {{"do", "record"},
                    {"file", below(2) == 0 ? "" : "r" + std::to_string(below(1000)) + ".tsrec"}};
        }
    }

    /// A path that is touched offline.
    Json anyTouch() {
        Json message{{"do", "touch"}};
        if (below(4) == 0)
            message["stroke"] = below(2) == 0 ? "circle" : "none such";
        if (below(4) != 0)
            for (size_t i = 0, count = below(200); i < count; ++i)
                message["positions"].push_back(anyVector());
        if (below(3) == 0)
            message["rate"] = anyNumber() * 1e5;
        if (below(3) == 0)
            message["settings"] = Json{{"friction", below(2) == 0 ? "off" : "nothing"}};
        return message;
    }

    std::string anyText() {
        Json message = plausible();
        message["id"] = below(8) == 0 ? anyValue() : Json(sent);
        if (below(6) == 0) { // one member is something else, or gone
            auto member = message.begin();
            std::advance(member, static_cast<ptrdiff_t>(below(message.size())));
            if (below(3) == 0)
                message.erase(member);
            else
                *member = anyValue();
        }
        std::string text = message.dump(-1, ' ', false, Json::error_handler_t::replace);
        if (below(6) == 0)
            for (size_t i = 0, count = 1 + below(4); i < count && !text.empty(); ++i) {
                const size_t at = below(text.size());
                switch (below(4)) {
                case 0:
                    text[at] = static_cast<char>(random_());
                    break;
                case 1:
                    text.erase(at, 1 + below(8));
                    break;
                case 2:
                    text.insert(at, text.substr(below(text.size()), below(20)));
                    break;
                default:
                    text.insert(at, below(10) == 0 ? 5000 : 3, "[{\"9e"[below(5)]);
                }
            }
        return text;
    }

    static constexpr const char* kToken = "0123456789abcdef";
    TouchServer server_;
    std::mt19937_64 random_;
    std::vector<uint64_t> clients_;
    uint64_t numbers_ = 0;
};

} // namespace

int main(int count, char** arguments) {
    const double seconds = count > 1 ? std::atof(arguments[1]) : 10.0;
    const uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
    const std::filesystem::path root =
        std::filesystem::temp_directory_path() / ("server_fuzz." + std::to_string(seed));
    std::filesystem::remove_all(root);
    std::filesystem::create_directory(root);
    for (const char* scene : {"box.glb", "plane.glb"})
        std::filesystem::copy_file(std::filesystem::path(TOUCHSTONE_ASSETS) / scene, root / scene);
    ServeOptions options;
    options.root = root.string();
    options.scene = (root / "box.glb").string();
    options.allowWrite = true;
    options.control = 1000.0;
    using Clock = std::chrono::steady_clock;
    const Clock::time_point begin = Clock::now(), end = begin + std::chrono::duration_cast<Clock::duration>(
                                                                    std::chrono::duration<double>(seconds));
    long early = 0;
    int status = 0;
    {
        Fuzz fuzz(options, seed);
        while (Clock::now() < end) {
            for (int i = 0; i < 50; ++i)
                fuzz.step();
            if (early == 0 && Clock::now() > begin + (end - begin) / 2)
                early = residentPages();
        }
        std::printf(
            "%llu messages, %llu answers, %llu of them refusals, %llu states, %llu rendered by a client, "
            "%llu paths touched offline; memory %+ld MB in the second half\n",
            static_cast<unsigned long long>(fuzz.sent), static_cast<unsigned long long>(fuzz.answered),
            static_cast<unsigned long long>(fuzz.refused), static_cast<unsigned long long>(fuzz.states),
            static_cast<unsigned long long>(fuzz.rendered), static_cast<unsigned long long>(fuzz.touched),
            (residentPages() - early) * 4096 / 1'000'000);
        const bool lively =
            fuzz.answered > 0 && fuzz.refused > 0 && fuzz.refused < fuzz.answered && fuzz.states > 0;
        status = lively ? 0 : 1;
    }
    std::filesystem::remove_all(root);
    return status;
}
