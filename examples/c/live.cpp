// A real-time loop with a callback, own meshes from arrays, and an own device of two functions: a virtual
// spring that somebody presses into a table for five seconds.
//   c++ -std=c++17 live.cpp $(pkg-config --cflags --libs touchstone) -o live && ./live
#include <touchstone/touchstone.hpp>

#include <cstdio>

namespace {

/// A hand of 0.3 kg that a spring pulls to a point 5 mm below the table. Both functions run on the servo's
/// thread.
struct Hand {
    double height = 0.1, velocity = 0.0, force = 0.0, last = 0.0; // m, m/s, N, s

    static void sample(void* context, double time, ts_reading* reading) {
        Hand& hand = *static_cast<Hand*>(context);
        const double dt = time - hand.last;
        hand.last = time;
        const double pull =
            100.0 * (-0.005 - hand.height) - 8.0 * hand.velocity; // spring and damper of the arm
        hand.velocity += dt * (pull + hand.force) / 0.3;
        hand.height += dt * hand.velocity;
        reading->position[1] = hand.height;
        reading->valid = 1;
    }
    static void apply(void* context, const double force[3]) { static_cast<Hand*>(context)->force = force[1]; }
};

} // namespace

int main() {
    try {
        ts::Mesh table;
        table.positions = {{-0.1f, 0, -0.1f}, {-0.1f, 0, 0.1f}, {0.1f, 0, 0.1f}, {0.1f, 0, -0.1f}};
        table.triangles = {{0, 1, 2}, {0, 2, 3}};
        ts::Material wood;
        wood.stiffness = 1000.0;
        wood.damping = 2.0;
        Hand hand;
        ts_device device = TS_STRUCT(ts_device);
        device.context = &hand;
        device.sample = Hand::sample;
        device.apply = Hand::apply;
        ts::Session session(device);
        session.touch(ts::Scene({table}, {wood}));
        session.run(5.0, [n = 0](const ts_state& state) mutable {
            if (n++ % 30 == 0)
                std::printf("%5.2f s: hand %6.2f mm, force %5.3f N, %llu of %llu ticks missed\n", state.time,
                            1e3 * state.hip[1], state.force[1], static_cast<unsigned long long>(state.missed),
                            static_cast<unsigned long long>(state.ticks));
            return true;
        });
    } catch (const ts::Error& error) {
        std::fprintf(stderr, "%s\n", error.what());
        return 1;
    }
}
