#pragma once
// A hand that sculpts in a session, and what is recorded of it.

#include "session/device_port.h"
#include "session/session.h"
#include "tests/support/recorded_servo.h"

#include <glm/glm.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <string>
#include <thread>
#include <vector>

namespace touchstone::test {

inline constexpr double kToolRadius = 0.004; // m

/// Goes to and fro over a place, a millimetre and a half deep.
class RubbingDevice final : public Device {
  public:
    explicit RubbingDevice(const glm::dvec3& place) : place_(place) {}
    [[nodiscard]] std::string name() const override { return "rubbing"; }
    [[nodiscard]] DeviceLimits limits() const override { return {}; }
    [[nodiscard]] DeviceSample sample(double time) noexcept override {
        const double depth = 0.0015 - 0.01 * std::exp(-20.0 * time);
        DeviceSample made =
            at(place_ + glm::dvec3(0.006 * std::sin(9.0 * time), -depth, 0.006 * std::cos(7.0 * time)));
        made.buttons = time > 0.25 ? kSculptButton : 0;
        return made;
    }
    void apply(const DeviceCommand&) noexcept override {}

  private:
    glm::dvec3 place_;
};

/// Records a session, and keeps what was sculpted.
struct Recording final : TickSubscriber {
    explicit Recording(Session& session) : recorder(session.servo()) {}
    void sceneOffered(const OfferedScene& scene) override {
        recorder.sceneOffered(scene.number, scene.identity);
    }
    void sceneSculpted(const SculptedScene& scene) override {
        recorder.sceneSculpted(scene.number, scene.root, scene.hash, scene.entries);
        if (scene.root != root)
            entries.clear();
        root = scene.root;
        entries.insert(entries.end(), scene.entries.begin(), scene.entries.end());
        last = scene;
        ++published;
    }
    void take(const TickRecord& record, const HapticSettings&) override {
        recorder.take(record);
        edited += record.editDelay > 0 ? 1 : 0;
        force = std::max(force, glm::length(record.output.command.force()));
        contacts += record.output.contacts > 0 ? 1 : 0;
        resisted = std::max(resisted, record.output.contacts == 0 ? glm::length(record.output.force) : 0.0);
    }
    void flush(double) override { recorder.flush(); }

    ServoRecorder recorder;
    std::vector<SculptEntry> entries;
    SculptedScene last;
    uint32_t root = 0;
    size_t published = 0, edited = 0, contacts = 0;
    double force = 0.0, resisted = 0.0;
};

/// The servo makes so many ticks with the tool.
inline void sculptTicks(Session& session, const LiveTool& tool, uint64_t ticks) {
    session.sculptor().setTool(tool);
    session.start();
    const uint64_t goal = session.servo().counters().ticks + ticks;
    while (session.servo().counters().ticks < goal) {
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
        session.pump(0.0);
    }
}

/// The servo stops, and everything that the hand made is published.
inline void endSculpting(Session& session) {
    session.stop();
    session.sculptor().drain();
    session.pump(0.0);
}

} // namespace touchstone::test
