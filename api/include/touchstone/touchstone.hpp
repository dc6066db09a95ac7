// A C++ layer over touchstone.h: handles that close themselves, exceptions in place of status codes. Header
// only, C++17, so that nothing of a compiler's ABI crosses the library.
#ifndef TOUCHSTONE_TOUCHSTONE_HPP
#define TOUCHSTONE_TOUCHSTONE_HPP

#include "touchstone.h"

#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <exception>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace ts {

/// A call that failed, with ts_last_error.
class Error : public std::runtime_error {
  public:
    Error(ts_status status, const std::string& message) : std::runtime_error(message), status_(status) {}
    [[nodiscard]] ts_status status() const noexcept { return status_; }

  private:
    ts_status status_;
};

/// Throws Error unless `status` is TS_OK.
inline void check(ts_status status) {
    if (status != TS_OK)
        throw Error(status, ts_last_error());
}

/// Owns a handle.
template <class T, ts_status (*Close)(T)>
class Handle {
  public:
    Handle() = default;
    ~Handle() { (void)Close(handle_); }
    Handle(Handle&& other) noexcept : handle_(std::exchange(other.handle_, nullptr)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(handle_, other.handle_);
        return *this;
    }
    [[nodiscard]] T get() const noexcept { return handle_; }
    [[nodiscard]] T* out() noexcept { return &handle_; }
    /// Closes it now; every later call throws Error (TS_CLOSED).
    void close() { check(Close(handle_)); }

  private:
    T handle_ = nullptr;
};

using Vector = std::array<double, 3>;

/// A text of the library (ts_scene_warning), whatever its length.
template <class Ask>
[[nodiscard]] std::string text(const Ask& ask) {
    std::size_t needed = 0;
    check(ask(nullptr, std::size_t{0}, &needed));
    std::string text(needed, '\0');
    check(ask(text.data(), text.size(), &needed));
    text.resize(needed - 1);
    return text;
}

/// Triangles of a model; `indices` 3 per triangle, `positions` m.
struct Mesh {
    std::vector<std::array<float, 3>> positions, normals; ///< normals: empty, or one per vertex
    std::vector<std::array<std::uint32_t, 3>> triangles;
    std::vector<std::array<float, 2>> texture; ///< empty, or one per vertex
    std::uint32_t material = 0;
    std::string name;
};

/// What a surface feels like; NaN: not stated.
struct Material {
    double stiffness = NAN, damping = NAN, staticFriction = NAN, dynamicFriction = NAN, viscousFriction = NAN;
    std::string name;
};

class Scene {
  public:
    explicit Scene(const std::string& file, ts_fit fit = TS_FIT_NONE) {
        const ts_scene_options options = optionsOf(fit);
        check(ts_scene_load(file.c_str(), &options, handle_.out()));
    }
    explicit Scene(const std::vector<Mesh>& meshes, const std::vector<Material>& materials = {},
                   ts_fit fit = TS_FIT_NONE) {
        std::vector<ts_mesh> flat;
        for (const Mesh& mesh : meshes)
            flat.push_back(flatOf(mesh));
        std::vector<ts_material> surfaces;
        for (const Material& m : materials)
            surfaces.push_back({sizeof(ts_material), m.name.empty() ? nullptr : m.name.c_str(), m.stiffness,
                                m.damping, m.staticFriction, m.dynamicFriction, m.viscousFriction});
        const ts_scene_options options = optionsOf(fit);
        check(ts_scene_create(flat.data(), flat.size(), surfaces.data(), surfaces.size(), &options,
                              handle_.out()));
    }

    /// A glTF file in memory, without files beside it.
    [[nodiscard]] static Scene fromMemory(const std::string& bytes, ts_fit fit = TS_FIT_NONE) {
        Scene scene;
        const ts_scene_options options = optionsOf(fit);
        check(ts_scene_load_memory(bytes.data(), bytes.size(), nullptr, &options, scene.handle_.out()));
        return scene;
    }

    [[nodiscard]] ts_scene_info info() const {
        ts_scene_info info = TS_STRUCT(ts_scene_info);
        check(ts_scene_get_info(handle_.get(), &info));
        return info;
    }
    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> all;
        for (std::uint64_t i = 0, count = info().warnings; i < count; ++i)
            all.push_back(text([&](char* out, std::size_t room, std::size_t* needed) {
                return ts_scene_warning(handle_.get(), i, out, room, needed);
            }));
        return all;
    }
    /// Corners of the triangles at rest, 9 floats each, m, workspace.
    [[nodiscard]] std::vector<float> triangles() const {
        std::size_t count = 0;
        check(ts_scene_triangles(handle_.get(), nullptr, 0, &count));
        std::vector<float> corners(9 * count);
        check(ts_scene_triangles(handle_.get(), corners.data(), count, &count));
        return corners;
    }
    /// Positions of a simulated hand, `rate` a second for one period of a stroke.
    [[nodiscard]] std::vector<Vector> stroke(const std::string& name = "tour", double rate = 1000.0,
                                             double speed = 0.0, double depth = 0.0) const {
        std::size_t rows = 0;
        check(ts_stroke(handle_.get(), name.c_str(), speed, depth, rate, nullptr, 0, &rows));
        std::vector<Vector> positions(rows);
        check(ts_stroke(handle_.get(), name.c_str(), speed, depth, rate, positions.data()->data(), rows,
                        &rows));
        return positions;
    }
    void close() { handle_.close(); }
    [[nodiscard]] ts_scene get() const noexcept { return handle_.get(); }

  private:
    Scene() = default;
    static ts_scene_options optionsOf(ts_fit fit) {
        ts_scene_options options = TS_STRUCT(ts_scene_options);
        options.fit = fit;
        return options;
    }
    static ts_mesh flatOf(const Mesh& mesh) {
        const auto fits = [&](std::size_t count) { return count == 0 || count == mesh.positions.size(); };
        if (!fits(mesh.normals.size()) || !fits(mesh.texture.size()))
            throw Error(TS_ARGUMENT, "meshes: normals and texture have one entry per vertex, or none");
        ts_mesh flat = TS_STRUCT(ts_mesh);
        flat.name = mesh.name.empty() ? nullptr : mesh.name.c_str();
        flat.positions = mesh.positions.empty() ? nullptr : mesh.positions.data()->data();
        flat.vertex_count = mesh.positions.size();
        flat.indices = mesh.triangles.empty() ? nullptr : mesh.triangles.data()->data();
        flat.triangle_count = mesh.triangles.size();
        flat.normals = mesh.normals.empty() ? nullptr : mesh.normals.data()->data();
        flat.texture = mesh.texture.empty() ? nullptr : mesh.texture.data()->data();
        flat.material = mesh.material;
        return flat;
    }
    Handle<ts_scene, ts_scene_close> handle_;
};

/// Settings by name, as `--set`.
class Settings {
  public:
    Settings() { check(ts_settings_create(handle_.out())); }
    Settings& set(const std::string& name, const std::string& value) {
        check(ts_settings_set(handle_.get(), name.c_str(), value.c_str()));
        return *this;
    }
    [[nodiscard]] std::string get(const std::string& name) const {
        return text([&](char* out, std::size_t room, std::size_t* needed) {
            return ts_settings_get(handle_.get(), name.c_str(), out, room, needed);
        });
    }
    [[nodiscard]] ts_settings get() const noexcept { return handle_.get(); }

  private:
    Handle<ts_settings, ts_settings_close> handle_;
};

/// One entry a tick; SI, workspace.
struct Ticks {
    explicit Ticks(std::size_t count = 0)
        : time(count), penetration(count), hip(count), proxy(count), normal(count), force(count),
          command(count), contacts(count), flags(count) {}
    /// These arrays for the C interface.
    [[nodiscard]] ts_ticks arrays() {
        ts_ticks ticks = TS_STRUCT(ts_ticks);
        ticks.capacity = time.size();
        if (time.empty())
            return ticks;
        ticks.time = time.data();
        ticks.penetration = penetration.data();
        ticks.hip = hip.data()->data();
        ticks.proxy = proxy.data()->data();
        ticks.normal = normal.data()->data();
        ticks.force = force.data()->data();
        ticks.command = command.data()->data();
        ticks.contacts = contacts.data();
        ticks.flags = flags.data();
        return ticks;
    }
    std::vector<double> time, penetration;
    std::vector<Vector> hip, proxy, normal, force, command;
    std::vector<std::uint32_t> contacts, flags;
};

/// Touches a scene along positions at `rate` Hz.
[[nodiscard]] inline Ticks touch(const Scene& scene, const std::vector<Vector>& positions,
                                 double rate = 1000.0, const Settings* settings = nullptr) {
    Ticks result(positions.size());
    ts_path path = TS_STRUCT(ts_path);
    path.positions = positions.empty() ? nullptr : positions.data()->data();
    path.count = positions.size();
    path.rate = rate;
    const ts_ticks arrays = result.arrays();
    check(ts_touch(scene.get(), settings != nullptr ? settings->get() : nullptr, &path, &arrays));
    return result;
}

/// The same with several hands in one world, a path each of equal length.
[[nodiscard]] inline std::vector<Ticks> touch(const Scene& scene,
                                              const std::vector<std::vector<Vector>>& paths,
                                              double rate = 1000.0, const Settings* settings = nullptr) {
    Handle<ts_hand, ts_hand_close> hands;
    check(ts_hands_create(scene.get(), settings != nullptr ? settings->get() : nullptr, paths.size(),
                          hands.out()));
    std::vector<Ticks> results;
    std::vector<ts_path> flat;
    std::vector<ts_ticks> arrays;
    results.reserve(paths.size());
    for (const std::vector<Vector>& positions : paths) {
        ts_path path = TS_STRUCT(ts_path);
        path.positions = positions.empty() ? nullptr : positions.data()->data();
        path.count = positions.size();
        path.rate = rate;
        flat.push_back(path);
        arrays.push_back(results.emplace_back(positions.size()).arrays());
    }
    check(ts_hands_touch(hands.get(), flat.data(), arrays.data(), flat.size(), nullptr));
    return results;
}

/// Real time. `device`: "stroke", "stroke:NAME", or what `touchstone run --device` takes.
class Session {
  public:
    explicit Session(const std::string& device, double rate = 1000.0) {
        ts_session_options options = TS_STRUCT(ts_session_options);
        options.device = device.c_str();
        options.rate = rate;
        check(ts_session_create(&options, handle_.out()));
    }
    /// All options: ticks to keep, a control loop.
    explicit Session(const ts_session_options& options) { check(ts_session_create(&options, handle_.out())); }
    /// A device of the caller's; what its context names outlives the session.
    explicit Session(const ts_device& device, double rate = 1000.0) {
        ts_session_options options = TS_STRUCT(ts_session_options);
        options.own = &device;
        options.rate = rate;
        check(ts_session_create(&options, handle_.out()));
    }
    void touch(const Scene& scene) { check(ts_session_touch(handle_.get(), scene.get())); }
    void set(const std::string& name, const std::string& value) {
        check(ts_session_set(handle_.get(), name.c_str(), value.c_str()));
    }
    void force(bool on) { check(ts_session_force(handle_.get(), on ? 1 : 0)); }
    /// A number of a material; NaN: as in the file.
    void material(std::uint64_t material, const std::string& name, double value) {
        check(ts_session_material(handle_.get(), material, name.c_str(), value));
    }
    /// An object to a pose, with its bounded speeds (ts_session_move); all of them stop (halt).
    void move(std::uint64_t object, const ts_pose& pose) {
        check(ts_session_move(handle_.get(), object, &pose));
    }
    void halt() { check(ts_session_halt(handle_.get())); }
    [[nodiscard]] ts_pose pose(std::uint64_t object) const {
        ts_pose pose = TS_STRUCT(ts_pose);
        check(ts_session_pose(handle_.get(), object, &pose));
        return pose;
    }
    /// The caller renders contact, for a session with a control loop.
    void render(bool byCaller) { check(ts_session_render(handle_.get(), byCaller ? 1 : 0)); }
    void goal(const ts_goal& goal) { check(ts_session_goal(handle_.get(), &goal)); }
    void record(const std::string& file) { check(ts_session_record(handle_.get(), file.c_str())); }
    void endRecording() { check(ts_session_record(handle_.get(), nullptr)); }
    void start() { check(ts_session_start(handle_.get())); }
    void stop() { check(ts_session_stop(handle_.get())); }
    [[nodiscard]] ts_state pump() {
        ts_state state = TS_STRUCT(ts_state);
        check(ts_session_pump(handle_.get(), &state));
        return state;
    }
    /// Of a further hand, at the last `pump` (ts_session_options::others).
    [[nodiscard]] ts_state hand(std::size_t hand) const {
        ts_state state = TS_STRUCT(ts_state);
        check(ts_session_hand(handle_.get(), hand, &state));
        return state;
    }
    /// `callback` gets every picture's state and returns false to end; what it throws comes out of `run`.
    void run(double seconds, const std::function<bool(const ts_state&)>& callback, double rate = 60.0) {
        Call call{&callback, nullptr};
        const ts_status status = ts_session_run(handle_.get(), seconds, rate, &Call::made, &call);
        if (call.thrown)
            std::rethrow_exception(call.thrown);
        check(status);
    }
    [[nodiscard]] ts_session get() const noexcept { return handle_.get(); }
    void close() { handle_.close(); }

  private:
    struct Call {
        const std::function<bool(const ts_state&)>* callback;
        std::exception_ptr thrown;
        static int made(void* context, const ts_state* state) noexcept {
            Call& call = *static_cast<Call*>(context);
            try {
                return (*call.callback)(*state) ? 0 : 1;
            } catch (...) {
                call.thrown = std::current_exception();
                return 1;
            }
        }
    };
    Handle<ts_session, ts_session_close> handle_;
};

} // namespace ts

#endif
