#pragma once
// A path that a client has touched offline, beside the servo.

#include "server/messages.h"
#include "touchstone/touchstone.hpp"

#include <atomic>
#include <cstdint>
#include <future>
#include <memory>
#include <optional>
#include <string>

namespace touchstone::server {

/// One path at a time, on a thread of its own below the priority of everything else: `touchstone touch` to
/// the last bit, of the scene as its file says, whatever clients have changed of it.
class OfflineTouch {
  public:
    OfflineTouch() = default;
    /// Waits until the stroke is laid, and then for the next 4096 ticks.
    ~OfflineTouch() { stop(); }
    OfflineTouch(const OfflineTouch&) = delete;
    OfflineTouch& operator=(const OfflineTouch&) = delete;

    struct Made {
        uint64_t client = 0;
        uint32_t id = 0; ///< of the message
        ts::Ticks ticks;
        std::string error; ///< empty: none
    };
    /// The message has `stroke` or `positions`, optional `rate` and `settings`. The scene stays open until
    /// the path is made, whatever is loaded meanwhile. Throws Refusal.
    void begin(const Json& message, uint64_t client, const std::shared_ptr<ts::Scene>& scene);
    /// Of a client that has gone; nothing where it is another one's.
    void forget(uint64_t client);
    /// What has been made, once.
    [[nodiscard]] std::optional<Made> take();

  private:
    void stop();

    std::future<Made> making_;
    uint64_t client_ = 0;
    std::atomic<bool> stopping_{false};
};

} // namespace touchstone::server
