#pragma once
// A hand of the tests' own that presses into a floor, in a session.

#include "tests/unit/api/floor.h"

#include <algorithm>
#include <atomic>
#include <chrono>
#include <thread>

namespace touchstone::test {

/// A device that presses 2 mm into the floor, and what it was commanded.
struct Pressing {
    std::atomic<int> samples{0};
    std::atomic<double> force{0.0}, largest{0.0};

    ts_device device() {
        ts_device device = TS_STRUCT(ts_device);
        device.context = this;
        device.sample = [](void* context, double time, ts_reading* reading) {
            ++static_cast<Pressing*>(context)->samples;
            const double depth =
                std::min(0.002, 0.5 * time - 0.15); // a hand that begins near the model must leave it first
            reading->position[1] = -depth;
            reading->valid = 1;
        };
        device.apply = [](void* context, const double newtons[3]) {
            auto& self = *static_cast<Pressing*>(context);
            self.force = newtons[1];
            self.largest = std::max(self.largest.load(), newtons[1]);
        };
        device.max_force = 1.0;
        return device;
    }
};

/// False where it does not come to hold in a minute.
template <class Holds>
bool withinAMinute(const Holds& holds) {
    for (int i = 0; i < 6000; ++i) {
        if (holds())
            return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    return false;
}

/// A session with that device, by the C interface.
struct PressedSession {
    Pressing pressing;
    const ts_device device = pressing.device();
    ts::Handle<ts_session, ts_session_close> handle;
    ts_state state = TS_STRUCT(ts_state); ///< of the last pump

    explicit PressedSession(ts_session_options options = TS_STRUCT(ts_session_options)) {
        options.own = &device;
        ts::check(ts_session_create(&options, handle.out()));
    }
    /// Pumps until `done` holds; false after a minute.
    template <class Done>
    bool until(const Done& done) {
        return withinAMinute([&] {
            ts::check(ts_session_pump(handle.get(), &state));
            return done();
        });
    }
};

/// The same.
template <class Done>
bool pumpUntil(ts::Session& session, const Done& done) {
    return withinAMinute([&] { return done(session.pump()); });
}

} // namespace touchstone::test
