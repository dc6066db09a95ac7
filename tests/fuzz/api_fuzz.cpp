// Random calls of the C interface, with handles that are open, closed and invented, wrong sizes, wrong
// numbers, from two threads at once: none may crash, and each that fails says why. api_fuzz [SECONDS [SEED]].

#include "touchstone/touchstone.h"

#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <mutex>
#include <random>
#include <string>
#include <thread>
#include <vector>

namespace {

std::atomic<uint64_t> calls{0}, refused{0};

/// Handles that were given out, of all kinds, shared by the threads.
class Handles {
  public:
    void add(void* handle) {
        const std::lock_guard lock(mutex_);
        if (handle != nullptr)
            all_.push_back(handle);
    }
    void* any(std::mt19937_64& random) {
        const std::lock_guard lock(mutex_);
        if (all_.empty() || random() % 16 == 0)
            return reinterpret_cast<void*>(random() % 3 == 0 ? random() : random() % 4096);
        return all_[all_.size() - 1 - random() % std::min<size_t>(all_.size(), 40)];
    }

  private:
    std::mutex mutex_;
    std::vector<void*> all_;
} handles;

int nothing(void*, const ts_state*) {
    return 1;
}

class Caller {
  public:
    explicit Caller(uint64_t seed) : random_(seed) {}

    void call() {
        switch (random_() % 25) {
        case 0:
            createScene();
            break;
        case 1:
            touch();
            break;
        case 2: {
            ts_hand hand = nullptr;
            check(ts_hand_create(any<ts_scene>(), any<ts_settings>(), &hand));
            handles.add(hand);
            break;
        }
        case 3: {
            ts_settings settings = nullptr;
            check(ts_settings_create(&settings));
            handles.add(settings);
            break;
        }
        case 4:
            check(ts_settings_set(any<ts_settings>(), word(), word()));
            break;
        case 5:
            check(ts_hand_set(any<ts_hand>(), word(), word()));
            break;
        case 6:
            close();
            break;
        case 7:
            createSession();
            break;
        case 8:
            check(ts_session_touch(any<ts_session>(), any<ts_scene>()));
            break;
        case 9:
            check(ts_session_set(any<ts_session>(), word(), word()));
            break;
        case 10:
            check(ts_session_start(any<ts_session>()));
            break;
        case 11: {
            ts_state state = TS_STRUCT(ts_state);
            state.size = size(state.size);
            check(ts_session_pump(any<ts_session>(), pick(&state)));
            break;
        }
        case 12:
            check(ts_session_run(any<ts_session>(), number(), number(), random_() % 4 ? nothing : nullptr,
                                 nullptr));
            break;
        case 13:
            check(ts_session_force(any<ts_session>(), static_cast<int>(random_() % 2)));
            break;
        case 14: {
            char text[32];
            size_t needed = 0;
            check(ts_settings_get(any<ts_settings>(), word(), text, random_() % 33, &needed));
            check(ts_scene_warning(any<ts_scene>(), random_() % 3, nullptr, random_() % 2, pick(&needed)));
            break;
        }
        case 15:
            loadBytes();
            break;
        case 16:
            take();
            break;
        case 17:
            touchSeveral();
            break;
        case 18:
            move();
            break;
        case 19: {
            ts_goal goal = TS_STRUCT(ts_goal);
            goal.size = size(goal.size);
            goal.touching = static_cast<int>(random_() % 2);
            goal.stiffness = number();
            goal.damping = random_() % 2 ? 0.0 : number();
            goal.plane_count = random_() % 8 ? random_() % 4 : random_();
            for (double(&plane)[3] : goal.planes)
                plane[random_() % 3] = random_() % 4 ? 1.0 : number();
            goal.proxy[random_() % 3] = random_() % 2 ? 0.01 : number();
            check(ts_session_goal(any<ts_session>(), pick(&goal)));
            break;
        }
        case 20:
            check(ts_session_render(any<ts_session>(), static_cast<int>(random_() % 2)));
            break;
        case 21:
            material();
            break;
        case 22: {
            ts_state state = TS_STRUCT(ts_state);
            state.size = size(state.size);
            check(ts_session_hand(any<ts_session>(), random_() % 5, pick(&state)));
            break;
        }
        case 23:
            ask();
            break;
        default: {
            ts_scene_info info = TS_STRUCT(ts_scene_info);
            info.size = size(info.size);
            check(ts_scene_get_info(any<ts_scene>(), pick(&info)));
        }
        }
    }

  private:
    template <class T>
    T any() {
        return static_cast<T>(handles.any(random_));
    }
    template <class T>
    T* pick(T* pointer) {
        return random_() % 8 == 0 ? nullptr : pointer;
    }
    size_t size(size_t right) {
        // A size beyond the struct's own would read beyond it: that is no call that a caller's compiler can
        // make.
        return random_() % 8 == 0 ? random_() % (right + 1) : right;
    }
    double number() {
        static constexpr double kNumbers[]{
            0.0,    1.0,   -1.0,   1e-3,   60.0,
            1000.0, 1e300, -1e300, 5e-324, std::numeric_limits<double>::infinity(),
            NAN};
        return kNumbers[random_() % std::size(kNumbers)];
    }
    const char* word() {
        static const char* const kWords[]{"stiffness", "friction", "off",          "zilles",       "100",
                                          "-1",        "nan",      "contact",      "rays",         "sweep",
                                          "mm\xff",    "",         "forceEnabled", "neighbourhood"};
        return random_() % 20 == 0 ? nullptr : kWords[random_() % std::size(kWords)];
    }
    const char* materialWord() {
        static const char* const kWords[]{"stiffness", "damping", "staticFriction", "dynamicFriction",
                                          "hardness"};
        return random_() % 20 == 0 ? nullptr : kWords[random_() % std::size(kWords)];
    }
    void check(ts_status status) {
        ++calls;
        if (status == TS_OK)
            return;
        ++refused;
        if (ts_last_error()[0] == '\0' || status == TS_INTERNAL) {
            std::fprintf(stderr, "%s: '%s'\n", ts_status_name(status), ts_last_error());
            std::abort();
        }
    }
    void createScene() {
        std::vector<float> positions;
        for (int i = 0; i < 12; ++i)
            positions.push_back(random_() % 60 == 0 ? NAN : static_cast<float>(random_() % 100) * 1e-3f);
        std::vector<uint32_t> indices;
        for (int i = 0; i < 6; ++i)
            indices.push_back(static_cast<uint32_t>(random_() % (random_() % 10 == 0 ? 5 : 4)));
        ts_mesh mesh = TS_STRUCT(ts_mesh);
        mesh.size = size(mesh.size);
        mesh.positions = pick(positions.data());
        mesh.vertex_count = random_() % 8 == 0 ? random_() % 4 : 4;
        mesh.indices = pick(indices.data());
        mesh.triangle_count = random_() % 3;
        mesh.normals = random_() % 2 ? positions.data() : nullptr;
        ts_material material;
        ts_material_init(&material);
        material.stiffness = number();
        ts_scene scene = nullptr;
        check(ts_scene_create(&mesh, 1, pick(&material), random_() % 2, nullptr, &scene));
        handles.add(scene);
    }
    void touch() {
        const size_t rows = random_() % 200;
        std::vector<double> positions(3 * rows + 3), times(rows + 1);
        for (size_t i = 0; i < rows; ++i) {
            for (size_t axis = 0; axis < 3; ++axis)
                positions[3 * i + axis] =
                    random_() % 2000 == 0 ? number() : static_cast<double>(random_() % 100) * 1e-3;
            times[i] = random_() % 4000 == 0 ? number() : start_ + 1e-3 * static_cast<double>(i);
        }
        start_ += 1e-3 * static_cast<double>(rows);
        ts_path path = TS_STRUCT(ts_path);
        path.size = size(path.size);
        path.positions = pick(positions.data());
        path.count = rows;
        path.times = random_() % 2 ? times.data() : nullptr;
        path.rate = random_() % 8 ? 0.0 : number();
        std::vector<double> force(3 * rows + 1);
        ts_ticks ticks = TS_STRUCT(ts_ticks);
        ticks.size = size(ticks.size);
        ticks.capacity = random_() % 8 ? rows : rows / 2;
        ticks.force = force.data();
        size_t done = 0;
        if (random_() % 2)
            check(ts_touch(any<ts_scene>(), any<ts_settings>(), pick(&path), pick(&ticks)));
        else
            check(ts_hand_touch(any<ts_hand>(), pick(&path), pick(&ticks), pick(&done)));
    }
    /// Hands in one world along the same path.
    void touchSeveral() {
        ts_hand hands = nullptr;
        const size_t count = random_() % 6;
        check(ts_hands_create(any<ts_scene>(), any<ts_settings>(), count, &hands));
        handles.add(hands);
        const size_t rows = random_() % 50;
        std::vector<double> positions(3 * rows + 3, 0.001);
        positions[random_() % positions.size()] = random_() % 8 ? 0.02 : number();
        std::vector<double> force(3 * rows + 1);
        ts_path paths[6];
        ts_ticks ticks[6];
        for (size_t i = 0; i < 6; ++i) {
            paths[i] = TS_STRUCT(ts_path);
            paths[i].positions = pick(positions.data());
            paths[i].count = random_() % 20 ? rows : rows / 2;
            ticks[i] = TS_STRUCT(ts_ticks);
            ticks[i].force = force.data();
            ticks[i].capacity = random_() % 20 ? rows : rows / 2;
        }
        size_t done = 0;
        check(ts_hands_touch(random_() % 4 ? hands : any<ts_hand>(), pick(paths), pick(ticks),
                             random_() % 8 ? count : random_() % 6, pick(&done)));
    }
    /// Objects, from any thread, whatever becomes of the session.
    void move() {
        ts_pose pose = TS_STRUCT(ts_pose);
        pose.size = size(pose.size);
        pose.position[random_() % 3] = random_() % 2 ? 0.01 : number();
        pose.orientation[random_() % 4] = random_() % 2 ? 1.0 : number();
        pose.speed = random_() % 2 ? 0.1 : number();
        pose.turn = random_() % 2 ? 0.0 : number();
        const auto session = any<ts_session>();
        check(ts_session_move(session, random_() % 4 ? 0 : random_(), pick(&pose)));
        check(ts_session_pose(session, random_() % 2, pick(&pose)));
        if (random_() % 4 == 0)
            check(ts_session_halt(session));
    }
    void material() {
        const auto session = any<ts_session>();
        check(ts_session_material(session, random_() % 3, materialWord(), number()));
        double value = 0.0;
        check(ts_session_material_number(session, random_() % 3, materialWord(), pick(&value)));
    }
    /// What a scene knows of itself.
    void ask() {
        const auto scene = any<ts_scene>();
        ts_object_info object = TS_STRUCT(ts_object_info);
        object.size = size(object.size);
        check(ts_scene_object(scene, random_() % 3, pick(&object)));
        double value = 0.0;
        check(ts_scene_material_number(scene, random_() % 3, materialWord(), pick(&value)));
        float corners[18];
        size_t count = 0;
        check(ts_scene_triangles(scene, pick(corners), random_() % 3, pick(&count)));
        char text[8];
        check(ts_scene_material_name(scene, random_() % 2, pick(text), random_() % 9, pick(&count)));
        ts_number_info info = TS_STRUCT(ts_number_info);
        info.size = size(info.size);
        check(ts_material_number_get_info(random_() % 40, pick(&info)));
        double positions[30];
        check(ts_stroke(scene, random_() % 2 ? "circle" : word(), 0.0, 0.0, random_() % 2 ? 100.0 : number(),
                        pick(positions), random_() % 11, pick(&count)));
    }
    /// A device of two functions, some of whose numbers are none.
    ts_device device() {
        ts_device device = TS_STRUCT(ts_device);
        device.size = size(device.size);
        device.sample = [](void*, double time, ts_reading* reading) {
            reading->position[1] = 0.1 * std::sin(time);
            reading->position[0] = std::fmod(time, 1.0) < 0.01 ? NAN : 0.0;
            reading->valid = std::fmod(time, 0.5) < 0.4 ? 1 : 0;
        };
        device.apply = [](void*, const double force[3]) {
            if (!(std::hypot(force[0], force[1], force[2]) <= 8.5 + 1e-9))
                std::abort();
        };
        if (random_() % 8 == 0)
            device.apply = nullptr;
        device.max_force = random_() % 4 ? 0.0 : random_() % 2 ? 1.0 : number() > 8.5 ? NAN : 1.0;
        device.stale_age = random_() % 4 ? 0.0 : number();
        return device;
    }
    void createSession() {
        // A servo each, above everything else on the machine: a few are enough.
        static std::atomic<int> made{0};
        if (made >= 24 || random_() % 8 != 0)
            return;
        ++made;
        ts_session_options options = TS_STRUCT(ts_session_options);
        options.size = size(options.size);
        options.rate = random_() % 4 ? 0.0 : number();
        options.device = random_() % 4 ? "stroke" : word();
        const ts_device own = device();
        if (random_() % 2) {
            options.device = nullptr;
            options.own = &own;
        }
        ts_other_hand others[4];
        for (ts_other_hand& other : others) {
            other = TS_STRUCT(ts_other_hand);
            other.device = random_() % 8 ? "stroke" : word();
            if (random_() % 4 == 0) {
                other.device = nullptr;
                other.own = &own;
            }
        }
        options.others = pick(others);
        options.other_count = random_() % 2 ? 0 : random_() % 5;
        options.control = random_() % 4 ? 0.0 : random_() % 2 ? 1000.0 : number();
        options.keep = random_() % 4 ? 100 : random_();
        ts_session session = nullptr;
        check(ts_session_create(&options, &session));
        handles.add(session);
    }
    void loadBytes() {
        std::vector<unsigned char> bytes(random_() % 64);
        for (unsigned char& byte : bytes)
            byte = static_cast<unsigned char>(random_());
        if (bytes.size() > 12)
            std::memcpy(bytes.data(), "glTF\2\0\0\0", 8);
        ts_scene scene = nullptr;
        check(ts_scene_load_memory(bytes.data(), bytes.size(), word(), nullptr, &scene));
        handles.add(scene);
    }
    void take() {
        double time[64];
        ts_ticks ticks = TS_STRUCT(ts_ticks);
        ticks.capacity = random_() % 65;
        ticks.time = time;
        size_t count = 0;
        check(ts_session_take(any<ts_session>(), pick(&ticks), pick(&count)));
        check(ts_session_take_hand(any<ts_session>(), random_() % 5, pick(&ticks), pick(&count)));
        const auto recording = any<ts_recording>();
        check(ts_recording_read(recording, pick(&ticks), &count));
        check(ts_recording_read_hand(recording, random_() % 5, pick(&ticks), pick(&count)));
        check(ts_recording_hands(recording, pick(&count)));
    }
    void close() {
        switch (random_() % 4) {
        case 0:
            check(ts_scene_close(any<ts_scene>()));
            break;
        case 1:
            check(ts_hand_close(any<ts_hand>()));
            break;
        case 2:
            check(ts_session_close(any<ts_session>()));
            break;
        default:
            check(ts_settings_close(any<ts_settings>()));
        }
    }

    std::mt19937_64 random_;
    double start_ = 0.0;
};

} // namespace

int main(int count, char** arguments) {
    const double seconds = count > 1 ? std::atof(arguments[1]) : 5.0;
    const uint64_t seed = count > 2 ? std::strtoull(arguments[2], nullptr, 10) : 1;
    const auto end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds);
    std::vector<std::thread> threads;
    for (uint64_t thread = 0; thread < 2; ++thread)
        threads.emplace_back([&, thread] {
            for (Caller caller(2 * seed + thread); std::chrono::steady_clock::now() < end;)
                caller.call();
        });
    for (std::thread& thread : threads)
        thread.join();
    std::printf("%llu calls, %llu refused\n", static_cast<unsigned long long>(calls),
                static_cast<unsigned long long>(refused));
    return calls > 0 && refused > 0 && refused < calls ? 0 : 1;
}
