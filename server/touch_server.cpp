#include "server/touch_server.h"

#include "server/access.h"
#include "server/tables.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <functional>
#include <utility>

namespace touchstone::server {

namespace {

constexpr size_t kKept = 20'000, kTickBlock = 1000;

} // namespace

TouchServer::TouchServer(const ServeOptions& options, std::string token)
    : options_(options), token_(std::move(token)), plan_(1.0 / options.rate),
      changedSettings_(Json::object()), ticks_(kTickBlock) {
    ts_session_options session = TS_STRUCT(ts_session_options);
    session.device = options_.device.c_str();
    session.rate = options_.rate;
    session.keep = kKept;
    session.control = options_.control;
    session.goal_power = options_.goalPower;
    ts::check(ts_session_create(&session, session_.out()));
    if (!options_.scene.empty())
        loading_.begin(options_.scene, 0);
}

TouchServer::Client* TouchServer::find(uint64_t client) {
    const auto found =
        std::ranges::find_if(clients_, [&](const Client& known) { return known.number == client; });
    return found != clients_.end() ? &*found : nullptr;
}

void TouchServer::join(uint64_t client, bool trusted) {
    clients_.push_back({.number = client, .known = trusted});
}

void TouchServer::leave(uint64_t client) {
    std::erase_if(clients_, [&](const Client& known) { return known.number == client; });
    offline_.forget(client);
    if (driver_ == client)
        dismissDriver();
}

/// Nobody drives, nobody's contact is followed, and what moves stops.
void TouchServer::dismissDriver() {
    driver_ = 0;
    haltObjects();
    if (rendered_)
        render(false);
    tell({{"event", "driver"}, {"driver", nullptr}});
}

void TouchServer::render(bool byClient) {
    if (touching_ || byClient)
        ts::check(ts_session_render(session_.get(), byClient ? 1 : 0));
    rendered_ = byClient;
    tell({{"event", "render"}, {"on", byClient}});
}

bool TouchServer::mayRead(std::string_view token) const {
    return sameToken(token, token_);
}

void TouchServer::tell(const Json& event, uint64_t client) {
    outgoing_.push_back({client, false, false, textOf(event)});
}

bool TouchServer::receive(uint64_t number, std::string_view text) {
    Client* client = find(number);
    if (client == nullptr)
        return false;
    Json reply{{"id", nullptr}, {"ok", true}};
    try {
        constexpr int kDepth = 8; // of arrays and objects: the parser recurses
        const Json message = Json::parse(
            text, [](int depth, Json::parse_event_t, Json&) { return depth <= kDepth; }, false);
        if (!message.is_object())
            throw Refusal("the message is no JSON object");
        if (const auto id = message.find("id"); id != message.end() && id->is_number_integer())
            reply["id"] = *id;
        const std::string verb = member<std::string>(message, "do");
        if (!client->known) {
            if (verb != "authenticate" || !sameToken(member<std::string>(message, "token"), token_))
                return false;
            client->known = true;
        }
        reply.update(answer(*client, verb, message));
    } catch (const Refusal& refusal) {
        reply["ok"] = false;
        reply["error"] = refusal.what();
    } catch (const ts::Error& error) {
        reply["ok"] = false;
        reply["error"] = error.what();
    }
    if (!client->known)
        return false;
    tell(reply, number);
    return true;
}

void TouchServer::requireDriver(const Client& client) const {
    if (driver_ != client.number)
        throw Refusal(driver_ == 0 ? "you do not drive: send \"drive\" first" : "another client drives");
}

Json TouchServer::answer(Client& client, const std::string& verb, const Json& message) {
    if (verb == "authenticate")
        return {{"protocol", kProtocol},
                {"version", ts_version()},
                {"client", client.number},
                {"scene", sceneFile_},
                {"write", options_.allowWrite}};
    if (verb == "ping")
        return Json::object();
    if (verb == "subscribe")
        return subscribe(client, message);
    if (verb == "settings")
        return settingsTable(changedSettings_);
    if (verb == "materials")
        return materialsTable(session_.get(), scene_.get());
    if (verb == "objects")
        return objectsTable(scene_.get());
    if (verb == "touch") {
        offline_.begin(message, client.number, scene_);
        return Json::object();
    }
    if (verb == "drive") {
        if (driver_ != 0 && driver_ != client.number)
            throw Refusal("another client drives");
        driver_ = client.number;
        tell({{"event", "driver"}, {"driver", driver_}});
        return Json::object();
    }
    if (verb == "force" && !member<bool>(message, "on")) { // anybody may take the force away
        forceOn_ = false;
        if (touching_)
            ts::check(ts_session_force(session_.get(), 0));
        return Json::object();
    }
    return drive(client, verb, message);
}

Json TouchServer::subscribe(Client& client, const Json& message) {
    if (!message.contains("ticks") && !message.contains("states"))
        throw Refusal("'ticks' is missing");
    if (message.contains("states")) {
        const auto rate = member<double>(message, "states");
        if (!(rate >= 1.0 && rate <= 1000.0))
            throw Refusal("'states' is not within 1 .. 1000 Hz");
        client.stateRate = rate;
    }
    if (message.contains("ticks"))
        client.ticks = member<bool>(message, "ticks");
    return Json::object();
}

void TouchServer::setMaterial(const Json& message) {
    const uint64_t material = numberIn(message, "material");
    const auto name = member<std::string>(message, "name");
    const bool asInFile = message.contains("value") && message["value"].is_null();
    const double value = asInFile ? std::nan("") : member<double>(message, "value");
    const auto all = [&] {
        return scene_ != nullptr ? numberOfMaterials(session_.get(), *scene_, name) : Json::array();
    };
    const Json before = all();
    ts::check(ts_session_material(session_.get(), material, name.c_str(), value));
    const Json now = all();
    for (size_t m = 0; m < now.size(); ++m) // those that are one with it in the file have changed, too
        if (m == material || now[m] != before[m])
            tell({{"event", "material"}, {"material", m}, {"name", name}, {"value", now[m]}});
}

/// A goal of an object's pose; it goes there no faster than the message and the library allow.
void TouchServer::moveObject(const Json& message) {
    const uint64_t object = numberIn(message, "object");
    ts_pose pose = TS_STRUCT(ts_pose);
    numbersOf(member<std::vector<double>>(message, "position"), pose.position, "position");
    if (message.contains("orientation"))
        numbersOf(member<std::vector<double>>(message, "orientation"), pose.orientation, "orientation");
    pose.speed = memberOr(message, "speed", 0.0);
    pose.turn = memberOr(message, "turn", 0.0);
    ts::check(ts_session_move(session_.get(), object, &pose));
    moved_.insert(object);
}

void TouchServer::haltObjects() {
    if (!moved_.empty())
        ts::check(ts_session_halt(session_.get()));
}

/// Where the objects are that were moved.
Json TouchServer::movedPoses() const {
    Json all = Json::array();
    for (const uint64_t object : moved_) {
        ts_pose pose = TS_STRUCT(ts_pose);
        ts::check(ts_session_pose(session_.get(), object, &pose));
        const auto& q = pose.orientation;
        all.push_back({{"object", object},
                       {"position", vectorOf(pose.position)},
                       {"orientation", {q[0], q[1], q[2], q[3]}}});
    }
    return all;
}

/// What a client sends that renders contact.
void TouchServer::hearGoal(const Json& message) {
    if (!rendered_)
        throw Refusal("you do not render: send \"render\" first");
    ts_goal goal = TS_STRUCT(ts_goal);
    goal.touching = member<bool>(message, "touching") ? 1 : 0;
    if (goal.touching != 0) {
        numbersOf(member<std::vector<double>>(message, "proxy"), goal.proxy, "proxy");
        goal.stiffness = memberOr(message, "stiffness", 0.0);
        goal.damping = memberOr(message, "damping", 0.0);
        if (message.contains("planes")) {
            const auto planes = member<std::vector<std::vector<double>>>(message, "planes");
            if (planes.size() > 3)
                throw Refusal("'planes' has more than 3 normals");
            for (const std::vector<double>& plane : planes)
                numbersOf(plane, goal.planes[goal.plane_count++], "planes");
        }
    }
    ts::check(ts_session_goal(session_.get(), &goal));
}

Json TouchServer::drive(Client& client, const std::string& verb, const Json& message) {
    requireDriver(client);
    if (verb == "release") {
        dismissDriver();
    } else if (verb == "render") {
        render(member<bool>(message, "on"));
    } else if (verb == "move") {
        moveObject(message);
    } else if (verb == "halt") {
        haltObjects();
    } else if (verb == "contact") {
        hearGoal(message);
    } else if (verb == "force") {
        forceOn_ = true;
        if (touching_)
            ts::check(ts_session_force(session_.get(), 1));
    } else if (verb == "set") {
        const auto name = member<std::string>(message, "name"), value = member<std::string>(message, "value");
        ts::check(ts_session_set(session_.get(), name.c_str(), value.c_str()));
        changedSettings_[name] = value;
        tell({{"event", "setting"}, {"name", name}, {"value", value}});
    } else if (verb == "material") {
        setMaterial(message);
    } else if (verb == "load") {
        loading_.begin(message, options_.root, client.number);
        return {{"loading", true}};
    } else if (verb == "record") {
        if (!options_.allowWrite)
            throw Refusal("the server was started without --allow-write");
        const auto name = member<std::string>(message, "file");
        const std::string file = name.empty() ? name : newFileBelow(options_.root, name);
        if (file.empty() && !name.empty())
            throw Refusal("'file' is not a new file below the root");
        ts::check(ts_session_record(session_.get(), file.empty() ? nullptr : file.c_str()));
    } else {
        throw Refusal("there is no message '" + verb + "'");
    }
    return Json::object();
}

void TouchServer::finishLoading() {
    std::optional<SceneLoading::Loaded> loaded = loading_.take();
    if (!loaded)
        return;
    const uint64_t client = loaded->client;
    try {
        if (loaded->scene == nullptr)
            throw ts::Error(TS_INPUT, loaded->error);
        touchNow(std::move(*loaded));
    } catch (const ts::Error& error) {
        tell({{"event", "error"}, {"error", error.what()}}, client);
    }
}

/// Throws ts::Error.
void TouchServer::touchNow(SceneLoading::Loaded loaded) {
    ts::check(ts_session_stop(session_.get())); // a simulated hand strokes what is there when it starts
    try {
        ts::check(ts_session_touch(session_.get(), loaded.scene->get()));
    } catch (const ts::Error&) { // no stroke can be laid on it, say: the old scene is touched on
        if (touching_) {
            ts::check(ts_session_force(session_.get(), forceOn_ ? 1 : 0));
            ts::check(ts_session_start(session_.get()));
        }
        throw;
    }
    ts::check(ts_session_force(session_.get(), forceOn_ ? 1 : 0));
    ts::check(ts_session_start(session_.get()));
    touching_ = true;
    if (rendered_)
        render(true);
    sceneFile_ = std::move(loaded.file);
    triangles_ = std::move(loaded.triangles);
    scene_ = std::move(loaded.scene);
    moved_.clear();
    const ts_scene_info info = scene_->info();
    tell({{"event", "scene"},
          {"file", sceneFile_},
          {"triangles", info.triangles},
          {"low", vectorOf(info.low)},
          {"high", vectorOf(info.high)}});
}

void TouchServer::pump() {
    finishLoading();
    sendTouched();
    if (!touching_)
        return;
    ts_state state = TS_STRUCT(ts_state);
    ts::check(ts_session_pump(session_.get(), &state));
    if (state.touching != 0)
        read_ = {state.started, state.time, 1e-9 * static_cast<double>(state.wake_ns + state.step_ns)};
    sendTicks();
    const auto now = std::chrono::steady_clock::now();
    for (Client& client : clients_)
        client.sinceState += std::chrono::duration<double>(now - pumped_).count();
    pumped_ = now;
    if (state.touching == 0 || (state.tick == lastTick_ && state.rendered == 0))
        return;
    lastTick_ = state.tick;
    sendState(state);
}

double TouchServer::nextPump() {
    double fastest = kUsualStates;
    for (const Client& client : clients_)
        fastest = std::max(fastest, client.stateRate);
    const double now = monotonicNow();
    // What a client renders changes with the control loop's ticks.
    return touching_ && !rendered_ ? plan_.after(now, read_, 1.0 / fastest) : plan_.idle(now, 1.0 / fastest);
}

/// To each client as often as it has asked for.
void TouchServer::sendState(const ts_state& state) {
    Json event = stateEvent(state);
    event["force_on"] = forceOn_;
    event["driver"] = driver_ != 0 ? Json(driver_) : Json();
    if (!moved_.empty())
        event["moved"] = movedPoses();
    const std::string text = textOf(event);
    for (Client& client : clients_) {
        constexpr double kSlack = 0.1; // of a period: timers are late by some of one
        if (!client.known || client.sinceState * client.stateRate < 1.0 - kSlack)
            continue;
        client.sinceState = 0.0;
        outgoing_.push_back({client.number, false, true, text});
    }
}

void TouchServer::sendTicks() {
    const bool wanted = std::ranges::any_of(clients_, [](const Client& client) { return client.ticks; });
    for (size_t count = kTickBlock; count == kTickBlock;) {
        const ts_ticks arrays = ticks_.arrays();
        ts::check(ts_session_take(session_.get(), &arrays, &count));
        if (!wanted || count == 0)
            continue;
        const std::string bytes = ticksFrame(ticks_, 0, count, 0);
        for (const Client& client : clients_)
            if (client.ticks)
                outgoing_.push_back({client.number, true, true, bytes});
    }
}

/// The ticks of a client's path, and then that they are whole.
void TouchServer::sendTouched() {
    const std::optional<OfflineTouch::Made> made = offline_.take();
    if (!made || find(made->client) == nullptr)
        return;
    if (!made->error.empty()) {
        tell({{"event", "error"}, {"error", made->error}, {"id", made->id}}, made->client);
        return;
    }
    constexpr size_t kInAFrame = 10'000;
    const size_t count = made->ticks.time.size();
    for (size_t first = 0; first < count; first += kInAFrame)
        outgoing_.push_back({made->client, true, false,
                             ticksFrame(made->ticks, first, std::min(kInAFrame, count - first), made->id)});
    tell({{"event", "touched"}, {"id", made->id}, {"ticks", count}}, made->client);
}

void TouchServer::takeBack() {
    driver_ = 0;
    haltObjects();
    forceOn_ = !forceOn_;
    if (rendered_)
        render(false);
    if (touching_)
        ts::check(ts_session_force(session_.get(), forceOn_ ? 1 : 0));
    tell({{"event", "driver"}, {"driver", nullptr}, {"taken_back", true}, {"force_on", forceOn_}});
}

} // namespace touchstone::server
