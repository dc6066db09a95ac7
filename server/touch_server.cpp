#include "server/touch_server.h"

#include "server/access.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstring>
#include <functional>
#include <stdexcept>
#include <utility>

namespace touchstone::server {

namespace {

constexpr size_t kKept = 20'000, kTickBlock = 1000;
constexpr size_t kMostBytes = size_t{16} << 20; // of a scene in a message

/// A message that is refused; becomes the answer's `error`.
struct Refusal : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <class T>
T member(const nlohmann::json& message, const char* name) {
    const auto found = message.find(name);
    if (found == message.end())
        throw Refusal(std::string("'") + name + "' is missing");
    try {
        return found->get<T>();
    } catch (const nlohmann::json::exception&) {
        throw Refusal(std::string("'") + name + "' is of the wrong type");
    }
}

std::string decodedBase64(std::string_view text) {
    std::string bytes;
    uint32_t word = 0;
    int bits = 0;
    constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    for (const char c : text.substr(0, text.find('='))) {
        const size_t digit = kDigits.find(c);
        if (digit == std::string_view::npos)
            throw Refusal("'bytes' is not base64");
        word = (word << 6) | static_cast<uint32_t>(digit);
        if ((bits += 6) >= 8)
            bytes.push_back(static_cast<char>(word >> (bits -= 8)));
    }
    return bytes;
}

nlohmann::json vectorOf(const double (&v)[3]) {
    return {v[0], v[1], v[2]};
}

template <size_t Count>
void numbersOf(const std::vector<double>& from, double (&to)[Count], const char* name) {
    if (from.size() != Count)
        throw Refusal(std::string("'") + name + "' is not " + (Count == 3 ? "three" : "four") + " numbers");
    std::ranges::copy(from, to);
}

void append(std::string& bytes, const void* data, size_t size) {
    bytes.append(static_cast<const char*>(data), size);
}

} // namespace

TouchServer::TouchServer(const ServeOptions& options, std::string token)
    : options_(options), token_(std::move(token)), plan_(1.0 / options.rate),
      changedMaterials_(Json::object()), changedSettings_(Json::object()), ticks_(kTickBlock) {
    ts_session_options session = TS_STRUCT(ts_session_options);
    session.device = options_.device.c_str();
    session.rate = options_.rate;
    session.keep = kKept;
    session.control = options_.control;
    session.goal_power = options_.goalPower;
    ts::check(ts_session_create(&session, session_.out()));
    if (!options_.scene.empty())
        beginLoading([file = options_.scene] { return std::make_unique<ts::Scene>(file, TS_FIT_WORKSPACE); },
                     options_.scene, 0);
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
    outgoing_.push_back({client, false, event.dump(-1, ' ', false, Json::error_handler_t::replace)});
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

TouchServer::Json TouchServer::answer(Client& client, const std::string& verb, const Json& message) {
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
    if (verb == "settings") {
        Json all = Json::array();
        for (size_t i = 0; i < ts_setting_count(); ++i) {
            ts_setting_info info = TS_STRUCT(ts_setting_info);
            ts::check(ts_setting_get_info(i, &info));
            all.push_back({{"name", info.name},
                           {"unit", info.unit},
                           {"meaning", info.meaning},
                           {"allowed", info.allowed},
                           {"initial", info.initial},
                           {"value", changedSettings_.value(info.name, info.initial)}});
        }
        return {{"settings", all}};
    }
    if (verb == "materials")
        return materials();
    if (verb == "objects")
        return objects();
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

TouchServer::Json TouchServer::subscribe(Client& client, const Json& message) {
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

/// The numbers that may change, and what the materials of the scene have of them; null: not stated.
TouchServer::Json TouchServer::materials() const {
    Json numbers = Json::array(), all = Json::array();
    for (size_t i = 0; i < ts_material_number_count(); ++i) {
        ts_number_info info = TS_STRUCT(ts_number_info);
        ts::check(ts_material_number_get_info(i, &info));
        numbers.push_back({{"name", info.name},
                           {"label", info.label},
                           {"unit", info.unit},
                           {"meaning", info.meaning},
                           {"least", info.least},
                           {"most", info.most},
                           {"low", info.low},
                           {"high", info.high},
                           {"logarithmic", info.logarithmic != 0}});
    }
    for (uint64_t m = 0, count = scene_ != nullptr ? scene_->info().materials : 0; m < count; ++m) {
        Json values = Json::object();
        for (const Json& number : numbers) {
            const auto name = number["name"].get<std::string>();
            double value = 0.0;
            ts::check(ts_scene_material_number(scene_->get(), m, name.c_str(), &value));
            values[name] = std::isnan(value) ? Json() : Json(value);
        }
        if (const std::string key = std::to_string(m); changedMaterials_.contains(key))
            values.update(changedMaterials_[key]);
        all.push_back({{"name", ts::text([&](char* text, size_t room, size_t* needed) {
                            return ts_scene_material_name(scene_->get(), m, text, room, needed);
                        })},
                       {"values", values}});
    }
    return {{"numbers", numbers}, {"materials", all}};
}

void TouchServer::setMaterial(const Json& message) {
    const auto number = member<int64_t>(message, "material");
    if (number < 0)
        throw Refusal("'material' is negative");
    const auto material = static_cast<uint64_t>(number);
    const auto name = member<std::string>(message, "name");
    const bool asInFile = message.contains("value") && message["value"].is_null();
    double value = asInFile ? std::nan("") : member<double>(message, "value");
    ts::check(ts_session_material(session_.get(), material, name.c_str(), value));
    if (asInFile)
        ts::check(ts_scene_material_number(scene_->get(), material, name.c_str(), &value));
    const Json now = std::isnan(value) ? Json() : Json(value);
    changedMaterials_[std::to_string(material)][name] = now;
    tell({{"event", "material"}, {"material", material}, {"name", name}, {"value", now}});
}

TouchServer::Json TouchServer::objects() const {
    Json all = Json::array();
    for (uint64_t i = 0, count = scene_ != nullptr ? scene_->info().objects : 0; i < count; ++i) {
        ts_object_info info = TS_STRUCT(ts_object_info);
        ts::check(ts_scene_object(scene_->get(), i, &info));
        all.push_back({{"centre", vectorOf(info.centre)},
                       {"first_triangle", info.first_triangle},
                       {"triangles", info.triangles},
                       {"movable", info.movable != 0}});
    }
    return {{"objects", all}};
}

/// A goal of an object's pose; it goes there no faster than the message and the library allow.
void TouchServer::moveObject(const Json& message) {
    const auto number = member<int64_t>(message, "object");
    if (number < 0)
        throw Refusal("'object' is negative");
    const auto object = static_cast<uint64_t>(number);
    ts_pose pose = TS_STRUCT(ts_pose);
    numbersOf(member<std::vector<double>>(message, "position"), pose.position, "position");
    if (message.contains("orientation"))
        numbersOf(member<std::vector<double>>(message, "orientation"), pose.orientation, "orientation");
    pose.speed = message.contains("speed") ? member<double>(message, "speed") : 0.0;
    pose.turn = message.contains("turn") ? member<double>(message, "turn") : 0.0;
    ts::check(ts_session_move(session_.get(), object, &pose));
    moved_.insert(object);
}

void TouchServer::haltObjects() {
    if (!moved_.empty())
        ts::check(ts_session_halt(session_.get()));
}

/// Where the objects are that were moved.
TouchServer::Json TouchServer::movedPoses() const {
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
        goal.stiffness = message.contains("stiffness") ? member<double>(message, "stiffness") : 0.0;
        goal.damping = message.contains("damping") ? member<double>(message, "damping") : 0.0;
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

TouchServer::Json TouchServer::drive(Client& client, const std::string& verb, const Json& message) {
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
        return load(message, client.number);
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

TouchServer::Json TouchServer::load(const Json& message, uint64_t client) {
    if (loading_.valid())
        throw Refusal("a scene is being loaded");
    if (message.contains("bytes")) {
        auto bytes = std::make_shared<std::string>(decodedBase64(member<std::string>(message, "bytes")));
        if (bytes->size() > kMostBytes)
            throw Refusal("'bytes' holds more than 16 MiB");
        beginLoading(
            [bytes] { return std::make_unique<ts::Scene>(ts::Scene::fromMemory(*bytes, TS_FIT_WORKSPACE)); },
            "", client);
        return {{"loading", true}};
    }
    const std::string file = fileBelow(options_.root, member<std::string>(message, "scene"));
    if (file.empty())
        throw Refusal("'scene' names no file below the root");
    beginLoading([file] { return std::make_unique<ts::Scene>(file, TS_FIT_WORKSPACE); }, file, client);
    return {{"loading", true}};
}

void TouchServer::beginLoading(std::function<std::unique_ptr<ts::Scene>()> make, std::string file,
                               uint64_t client) {
    loadingFile_ = std::move(file);
    loader_ = client;
    loading_ = std::async(std::launch::async, [make = std::move(make)]() -> Loaded {
        try {
            Loaded loaded{make(), {}, {}};
            loaded.triangles = loaded.scene->triangles();
            return loaded;
        } catch (const ts::Error& error) {
            return {nullptr, error.what(), {}};
        }
    });
}

void TouchServer::finishLoading() {
    if (!loading_.valid() || loading_.wait_for(std::chrono::seconds(0)) != std::future_status::ready)
        return;
    Loaded loaded = loading_.get();
    try {
        if (loaded.scene == nullptr)
            throw ts::Error(TS_INPUT, loaded.error);
        ts::check(ts_session_stop(session_.get())); // a simulated hand strokes what is there when it starts
        ts::check(ts_session_touch(session_.get(), loaded.scene->get()));
        ts::check(ts_session_force(session_.get(), forceOn_ ? 1 : 0));
        ts::check(ts_session_start(session_.get()));
        touching_ = true;
        if (rendered_)
            render(true);
        sceneFile_ = loadingFile_;
        triangles_ = loaded.triangles;
        const ts_scene_info info = loaded.scene->info();
        scene_ = std::move(loaded.scene);
        changedMaterials_ = Json::object();
        moved_.clear();
        tell({{"event", "scene"},
              {"file", sceneFile_},
              {"triangles", info.triangles},
              {"low", vectorOf(info.low)},
              {"high", vectorOf(info.high)}});
    } catch (const ts::Error& error) {
        tell({{"event", "error"}, {"error", error.what()}}, loader_);
    }
}

void TouchServer::pump() {
    finishLoading();
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
    Json event{{"event", "state"},
               {"tick", state.tick},
               {"time", state.time},
               {"hip", vectorOf(state.hip)},
               {"proxy", vectorOf(state.proxy)},
               {"normal", vectorOf(state.normal)},
               {"force", vectorOf(state.force)},
               {"command", vectorOf(state.command)},
               {"penetration", state.penetration},
               {"contacts", state.contacts},
               {"friction", state.friction},
               {"flags", state.flags},
               {"ticks", state.ticks},
               {"missed", state.missed},
               {"started", state.started},
               {"wake_us", 1e-3 * static_cast<double>(state.wake_ns)},
               {"step_us", 1e-3 * static_cast<double>(state.step_ns)},
               {"rendered", state.rendered != 0},
               {"force_on", forceOn_},
               {"driver", driver_ != 0 ? Json(driver_) : Json()}};
    if (!moved_.empty())
        event["moved"] = movedPoses();
    const std::string text = event.dump(-1, ' ', false, Json::error_handler_t::replace);
    for (Client& client : clients_) {
        constexpr double kSlack = 0.1; // of a period: timers are late by some of one
        if (!client.known || client.sinceState * client.stateRate < 1.0 - kSlack)
            continue;
        client.sinceState = 0.0;
        outgoing_.push_back({client.number, false, text});
    }
}

void TouchServer::sendTicks() {
    const bool wanted = std::ranges::any_of(clients_, [](const Client& client) { return client.ticks; });
    for (size_t count = kTickBlock; count == kTickBlock;) {
        const ts_ticks arrays = ticks_.arrays();
        ts::check(ts_session_take(session_.get(), &arrays, &count));
        if (!wanted || count == 0)
            continue;
        // "TSTK", the protocol, the ticks, 0; then of each tick: time, hip, proxy, force, command (double),
        // contacts, flags (uint32).
        std::string bytes = "TSTK";
        const uint32_t head[3]{kProtocol, static_cast<uint32_t>(count), 0};
        append(bytes, head, sizeof head);
        for (size_t i = 0; i < count; ++i) {
            append(bytes, &ticks_.time[i], sizeof(double));
            for (const auto* rows : {&ticks_.hip, &ticks_.proxy, &ticks_.force, &ticks_.command})
                append(bytes, (*rows)[i].data(), sizeof(ts::Vector));
            append(bytes, &ticks_.contacts[i], sizeof(uint32_t));
            append(bytes, &ticks_.flags[i], sizeof(uint32_t));
        }
        for (const Client& client : clients_)
            if (client.ticks)
                outgoing_.push_back({client.number, true, bytes});
    }
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
