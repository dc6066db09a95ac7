#pragma once
// What clients may ask for, whatever carries their messages. docs/server.md is the protocol; change both
// together.

#include "server/messages.h"
#include "server/offline_touch.h"
#include "server/pump_timer.h"
#include "server/scene_loading.h"
#include "server/serve_options.h"
#include "server/ticks_sent.h"
#include "touchstone/touchstone.hpp"

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::server {

/// A message to a client, or to all.
struct Outgoing {
    uint64_t client = 0; ///< 0: all that are authenticated
    bool binary = false;
    bool stream = false; ///< a newer one replaces it: who reads too slowly may lose it
    std::string bytes;
};

/// The session, its driver and its subscribers. One thread; the servo runs on its own and waits for nobody.
class TouchServer {
  public:
    /// Throws ts::Error.
    TouchServer(const ServeOptions& options, std::string token);

    /// A connection; one from the Unix socket needs no token.
    void join(uint64_t client, bool trusted);
    void leave(uint64_t client);
    /// A whole text message. False: the connection is to be closed.
    [[nodiscard]] bool receive(uint64_t client, std::string_view text);
    /// Reads the servo and gives everybody the state, as often as it has asked for.
    void pump();
    /// When to do so again: s on CLOCK_MONOTONIC.
    [[nodiscard]] double nextPump();
    /// The person at the device: the driver is dismissed and the force taken away; again: given back.
    void takeBack();
    [[nodiscard]] std::vector<Outgoing> takeOutgoing() { return std::move(outgoing_); }
    /// Corners of the scene's triangles, 9 floats each, workspace; for the page.
    [[nodiscard]] const std::vector<float>& triangles() const { return triangles_; }
    [[nodiscard]] bool mayRead(std::string_view token) const;

  private:
    struct Client {
        uint64_t number = 0;
        bool known = false, ticks = false;
        double stateRate = kUsualStates; ///< Hz
        double sinceState = 0.0;         ///< s
    };
    static constexpr double kUsualStates = 60.0;

    [[nodiscard]] Client* find(uint64_t client);
    [[nodiscard]] Json answer(Client& client, const std::string& verb, const Json& message);
    void finishLoading();
    void touchNow(SceneLoading::Loaded loaded);
    void requireDriver(const Client& client) const;
    [[nodiscard]] Json drive(Client& client, const std::string& verb, const Json& message);
    [[nodiscard]] Json subscribe(Client& client, const Json& message);
    void setMaterial(const Json& message);
    void hearGoal(const Json& message);
    void moveObject(const Json& message);
    void haltObjects();
    [[nodiscard]] Json movedPoses() const;
    void render(bool byClient);
    void dismissDriver();
    void tell(const Json& event, uint64_t client = 0);
    void sendTicks();
    void sendTouched();
    void sendState(const ts_state& state);

    ServeOptions options_;
    std::string token_;
    ts::Handle<ts_session, ts_session_close> session_;
    std::vector<Client> clients_;
    uint64_t driver_ = 0;
    bool forceOn_ = true, touching_ = false, rendered_ = false;
    std::chrono::steady_clock::time_point pumped_{};
    PumpPlan plan_;
    ReadTick read_; ///< the newest
    SceneLoading loading_;
    std::shared_ptr<ts::Scene> scene_; ///< that is touched; a path that is made of it keeps it
    std::set<uint64_t> moved_;         ///< objects of it that clients have moved
    Json changedSettings_;             ///< by name, since the start
    OfflineTouch offline_;
    std::string sceneFile_;
    uint64_t lastTick_ = ~uint64_t{0};
    std::vector<Outgoing> outgoing_;
    ts::Ticks ticks_;
    std::vector<float> triangles_;
};

} // namespace touchstone::server
