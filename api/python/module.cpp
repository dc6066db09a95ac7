// The part of the Python module that is compiled: NumPy arrays to and from libtouchstone's C interface.

#include "api/python/python_device.h"
#include "touchstone/touchstone.hpp"

#include <pybind11/functional.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace py = pybind11;

namespace {

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

std::string shapeOf(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

[[noreturn]] void refuse(const std::string& argument, const std::string& problem) {
    throw ts::Error(TS_ARGUMENT, argument + ": " + problem);
}

/// Any array of numbers as (N, width), or (N,) for width 0; no copy where it is one already.
template <class T>
Array<T> rows(const py::object& given, const char* argument, py::ssize_t width) {
    const py::array array = py::array::ensure(given);
    if (!array) {
        PyErr_Clear();
        refuse(argument, "is no array");
    }
    const char kind = array.dtype().kind();
    if (kind != 'f' && kind != 'i' && kind != 'u')
        refuse(argument, "its type is " + std::string(py::str(array.dtype())) + ", and not a real number");
    if (std::is_integral_v<T> && kind == 'f')
        refuse(argument, "its type is " + std::string(py::str(array.dtype())) + ", and not an integer");
    if (array.ndim() != (width > 0 ? 2 : 1) || (width > 0 && array.shape(1) != width))
        refuse(argument, "its shape is " + shapeOf(array) + ", and not (N" +
                             (width > 0 ? ", " + std::to_string(width) : std::string(",")) + ")");
    if (std::is_unsigned_v<T> && array.size() > 0 && (kind == 'i' || array.itemsize() > 4)) {
        const py::object low = array.attr("min")(), high = array.attr("max")();
        if (low.cast<long long>() < 0 || high.cast<unsigned long long>() > UINT32_MAX)
            refuse(argument, "holds an index that is negative or too large");
    }
    Array<T> out = Array<T>::ensure(array);
    if (!out)
        throw py::error_already_set();
    return out;
}

/// The arrays of a ts_ticks as a dict of NumPy arrays.
class Ticks {
  public:
    Ticks(size_t count, bool recorded) {
        arrays_.capacity = count;
        add("time", arrays_.time, count, 0);
        add("hip", arrays_.hip, count, 3);
        add("proxy", arrays_.proxy, count, 3);
        add("force", arrays_.force, count, 3);
        add("command", arrays_.command, count, 3);
        add("contacts", arrays_.contacts, count, 0);
        add("flags", arrays_.flags, count, 0);
        add("step_ns", arrays_.step_ns, count, 0);
        if (recorded)
            return;
        add("normal", arrays_.normal, count, 3);
        add("penetration", arrays_.penetration, count, 0);
        add("friction", arrays_.friction, count, 0);
        add("object", arrays_.object, count, 0);
        add("triangle", arrays_.triangle, count, 0);
    }
    [[nodiscard]] const ts_ticks* get() const { return &arrays_; }
    /// The first `count` entries.
    [[nodiscard]] py::dict dict(size_t count) const {
        if (count == arrays_.capacity)
            return dict_;
        py::dict cut;
        for (const auto& [name, array] : dict_)
            cut[name] = array[py::slice(0, static_cast<py::ssize_t>(count), 1)].attr("copy")();
        return cut;
    }

  private:
    template <class T>
    void add(const char* name, T*& pointer, size_t count, py::ssize_t width) {
        std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(count)};
        if (width > 0)
            shape.push_back(width);
        py::array_t<T> array(shape);
        pointer = array.mutable_data();
        dict_[name] = std::move(array);
    }
    ts_ticks arrays_ = TS_STRUCT(ts_ticks);
    py::dict dict_;
};

/// Ctrl+C stops a long path.
int goesOn(void*, size_t, size_t) {
    const py::gil_scoped_acquire gil;
    return PyErr_CheckSignals() == 0 ? 0 : 1;
}

void throwIfPythonFailed() {
    if (PyErr_Occurred() != nullptr)
        throw py::error_already_set();
}

class Settings {
  public:
    explicit Settings(const std::map<std::string, std::string>& values) {
        for (const auto& [name, value] : values)
            settings_.set(name, value);
    }
    [[nodiscard]] ts_settings get() const { return settings_.get(); }

  private:
    ts::Settings settings_;
};

class Scene {
  public:
    Scene(const std::string& file, int fit, const std::optional<double>& iso) {
        const ts_scene_options options = optionsOf(fit, iso);
        ts_status status;
        {
            const py::gil_scoped_release released;
            status = ts_scene_load(file.c_str(), &options, handle_.out());
        }
        ts::check(status);
    }
    Scene(const py::bytes& bytes, const std::string& folder, int fit) {
        const std::string_view view = bytes;
        const ts_scene_options options = optionsOf(fit, std::nullopt);
        const py::gil_scoped_release released;
        ts::check(ts_scene_load_memory(view.data(), view.size(), folder.c_str(), &options, handle_.out()));
    }
    /// `meshes`: dicts of positions, triangles, normals, texture, material, name.
    Scene(const py::list& meshes, const std::vector<ts::Material>& materials, int fit) {
        std::vector<py::object> alive;
        std::vector<std::string> names;
        names.reserve(meshes.size());
        std::vector<ts_mesh> flat;
        for (const py::handle& item : meshes)
            flat.push_back(flatOf(py::reinterpret_borrow<py::dict>(item), alive, names));
        std::vector<ts_material> surfaces;
        for (const ts::Material& m : materials)
            surfaces.push_back({sizeof(ts_material), m.name.empty() ? nullptr : m.name.c_str(), m.stiffness,
                                m.damping, m.staticFriction, m.dynamicFriction, m.viscousFriction});
        const ts_scene_options options = optionsOf(fit, std::nullopt);
        const py::gil_scoped_release released;
        ts::check(ts_scene_create(flat.data(), flat.size(), surfaces.data(), surfaces.size(), &options,
                                  handle_.out()));
    }
    [[nodiscard]] ts_scene_info info() const {
        ts_scene_info info = TS_STRUCT(ts_scene_info);
        ts::check(ts_scene_get_info(handle_.get(), &info));
        return info;
    }
    [[nodiscard]] std::vector<std::string> warnings() const {
        std::vector<std::string> all;
        for (uint64_t i = 0, count = info().warnings; i < count; ++i)
            all.push_back(ts::text([&](char* out, size_t room, size_t* needed) {
                return ts_scene_warning(handle_.get(), i, out, room, needed);
            }));
        return all;
    }
    [[nodiscard]] py::array_t<double> stroke(const std::string& name, double rate, double speed,
                                             double depth) const {
        size_t count = 0;
        const auto lay = [&](double* positions) {
            const py::gil_scoped_release released;
            ts::check(ts_stroke(handle_.get(), name.c_str(), speed, depth, rate, positions, count, &count));
        };
        lay(nullptr);
        py::array_t<double> positions({static_cast<py::ssize_t>(count), py::ssize_t{3}});
        lay(positions.mutable_data());
        return positions;
    }
    [[nodiscard]] py::array_t<float> triangles() const {
        size_t count = 0;
        ts::check(ts_scene_triangles(handle_.get(), nullptr, 0, &count));
        py::array_t<float> corners({static_cast<py::ssize_t>(count), py::ssize_t{3}, py::ssize_t{3}});
        ts::check(ts_scene_triangles(handle_.get(), corners.mutable_data(), count, &count));
        return corners;
    }
    void close() { handle_.close(); }
    [[nodiscard]] ts_scene get() const { return handle_.get(); }

  private:
    static ts_scene_options optionsOf(int fit, const std::optional<double>& iso) {
        ts_scene_options options = TS_STRUCT(ts_scene_options);
        options.fit = fit;
        options.iso_given = iso ? 1 : 0;
        options.iso = iso.value_or(0.0);
        return options;
    }
    template <class T>
    static const T* keep(const Array<T>& array, std::vector<py::object>& alive) {
        alive.push_back(array);
        return array.data();
    }
    static ts_mesh flatOf(const py::dict& mesh, std::vector<py::object>& alive,
                          std::vector<std::string>& names) {
        const auto positions = rows<float>(mesh["positions"], "positions", 3);
        const auto triangles = rows<uint32_t>(mesh["triangles"], "triangles", 3);
        ts_mesh flat = TS_STRUCT(ts_mesh);
        flat.positions = keep(positions, alive);
        flat.vertex_count = static_cast<size_t>(positions.shape(0));
        flat.indices = keep(triangles, alive);
        flat.triangle_count = static_cast<size_t>(triangles.shape(0));
        const auto optional = [&](const char* name, py::ssize_t width) -> const float* {
            if (!mesh.contains(name) || mesh[name].is_none())
                return nullptr;
            const auto array = rows<float>(mesh[name], name, width);
            if (array.shape(0) != positions.shape(0))
                refuse(name, "has " + std::to_string(array.shape(0)) + " rows, and positions " +
                                 std::to_string(positions.shape(0)));
            return keep(array, alive);
        };
        flat.normals = optional("normals", 3);
        flat.texture = optional("texture", 2);
        flat.material = mesh["material"].cast<uint32_t>();
        if (names.emplace_back(mesh["name"].cast<std::string>()); !names.back().empty())
            flat.name = names.back().c_str();
        return flat;
    }
    ts::Handle<ts_scene, ts_scene_close> handle_;
};

class Hand {
  public:
    Hand(const Scene& scene, const std::map<std::string, std::string>& settings, size_t hands) {
        const Settings named(settings);
        const py::gil_scoped_release released;
        ts::check(ts_hands_create(scene.get(), named.get(), hands, handle_.out()));
    }
    void set(const std::string& name, const std::string& value) {
        const py::gil_scoped_release released;
        ts::check(ts_hand_set(handle_.get(), name.c_str(), value.c_str()));
    }
    /// `positions`: an array a hand. Returns the ticks of each.
    py::list touch(const std::vector<py::object>& positions, const py::object& times, double rate) {
        std::vector<Array<double>> places;
        for (const py::object& of : positions)
            places.push_back(rows<double>(of, "positions", 3));
        std::optional<Array<double>> moments;
        if (!times.is_none())
            moments = rows<double>(times, "times", 0);
        std::vector<ts_path> paths;
        std::vector<Ticks> ticks;
        std::vector<ts_ticks> arrays;
        for (const Array<double>& of : places) {
            if (moments && moments->shape(0) != of.shape(0))
                refuse("times", "has " + std::to_string(moments->shape(0)) + " entries, and positions " +
                                    std::to_string(of.shape(0)) + " rows");
            ts_path path = TS_STRUCT(ts_path);
            path.positions = of.data();
            path.count = static_cast<size_t>(of.shape(0));
            path.times = moments && paths.empty() ? moments->data() : nullptr;
            path.rate = rate;
            path.progress = goesOn;
            paths.push_back(path);
            arrays.push_back(*ticks.emplace_back(path.count, false).get());
        }
        ts_status status;
        {
            const py::gil_scoped_release released;
            status = paths.size() == 1 // whose messages name no hand
                         ? ts_hand_touch(handle_.get(), paths.data(), arrays.data(), nullptr)
                         : ts_hands_touch(handle_.get(), paths.data(), arrays.data(), paths.size(), nullptr);
        }
        throwIfPythonFailed();
        ts::check(status);
        py::list all;
        for (size_t hand = 0; hand < ticks.size(); ++hand)
            all.append(ticks[hand].dict(paths[hand].count));
        return all;
    }
    void close() { handle_.close(); }

  private:
    ts::Handle<ts_hand, ts_hand_close> handle_;
};

class Session {
  public:
    /// `hands`: of each a device's name, or two Python functions.
    Session(const py::list& hands, double deviceRate, double maxForce, double staleAge, double rate,
            size_t keep, double control) {
        std::vector<std::string> names;
        std::vector<ts_device> own;
        names.reserve(hands.size());
        own.reserve(hands.size());
        std::vector<ts_other_hand> all;
        for (const py::handle& hand : hands) {
            ts_other_hand flat = TS_STRUCT(ts_other_hand);
            if (py::isinstance<py::str>(hand)) {
                flat.device = names.emplace_back(hand.cast<std::string>()).c_str();
            } else {
                const auto functions = hand.cast<std::pair<py::object, py::object>>();
                devices_.push_back(std::make_unique<touchstone::python::PythonDevice>(
                    functions.first, functions.second, deviceRate));
                own.push_back(devices_.back()->device());
                own.back().max_force = maxForce;
                own.back().stale_age = staleAge;
                flat.own = &own.back();
            }
            all.push_back(flat);
        }
        if (all.empty())
            refuse("device", "names no hand");
        ts_session_options options = TS_STRUCT(ts_session_options);
        options.device = all.front().device;
        options.own = all.front().own;
        options.others = all.data() + 1;
        options.other_count = all.size() - 1;
        options.rate = rate;
        options.keep = keep;
        options.control = control;
        {
            const py::gil_scoped_release released;
            ts::check(ts_session_create(&options, handle_.out()));
        }
        for (const auto& device : devices_)
            device->start();
    }
    /// The servo ends before the device that it calls.
    ~Session() {
        const py::gil_scoped_release released;
        handle_ = {};
    }
    template <class Call>
    void call(const Call& what) {
        const py::gil_scoped_release released;
        ts::check(what(handle_.get()));
    }
    ts_state pump() {
        ts_state state = TS_STRUCT(ts_state);
        call([&](ts_session session) { return ts_session_pump(session, &state); });
        rethrowDevice();
        return state;
    }
    void run(double seconds, const py::object& callback, double rate) {
        Callback made{callback, this, {}};
        ts_status status;
        {
            const py::gil_scoped_release released;
            status = ts_session_run(handle_.get(), seconds, rate, &Callback::call, &made);
        }
        if (made.thrown)
            std::rethrow_exception(made.thrown);
        rethrowDevice();
        ts::check(status);
    }
    void move(uint64_t object, const std::array<double, 3>& position,
              const std::array<double, 4>& orientation, double speed, double turn) {
        ts_pose pose = TS_STRUCT(ts_pose);
        std::copy(position.begin(), position.end(), pose.position);
        std::copy(orientation.begin(), orientation.end(), pose.orientation);
        pose.speed = speed;
        pose.turn = turn;
        call([&](ts_session session) { return ts_session_move(session, object, &pose); });
    }
    /// Position and orientation.
    py::tuple pose(uint64_t object) {
        ts_pose pose = TS_STRUCT(ts_pose);
        call([&](ts_session session) { return ts_session_pose(session, object, &pose); });
        return py::make_tuple(py::array_t<double>(3, pose.position),
                              py::array_t<double>(4, pose.orientation));
    }
    void goal(const std::optional<std::array<double, 3>>& proxy, double stiffness, double damping,
              const std::vector<std::array<double, 3>>& planes) {
        ts_goal goal = TS_STRUCT(ts_goal);
        goal.touching = proxy ? 1 : 0;
        if (proxy)
            std::copy(proxy->begin(), proxy->end(), goal.proxy);
        goal.stiffness = stiffness;
        goal.damping = damping;
        if (planes.size() > 3)
            refuse("planes", "has " + std::to_string(planes.size()) + " normals, and not three at most");
        for (const std::array<double, 3>& plane : planes)
            std::copy(plane.begin(), plane.end(), goal.planes[goal.plane_count++]);
        call([&](ts_session session) { return ts_session_goal(session, &goal); });
    }
    ts_state hand(size_t number) {
        ts_state state = TS_STRUCT(ts_state);
        call([&](ts_session session) { return ts_session_hand(session, number, &state); });
        return state;
    }
    py::dict take(size_t most, size_t hand) {
        const Ticks ticks(most, false);
        size_t count = 0;
        call([&](ts_session session) { return ts_session_take_hand(session, hand, ticks.get(), &count); });
        return ticks.dict(count);
    }
    [[nodiscard]] ts_session get() const { return handle_.get(); }
    void close() {
        {
            const py::gil_scoped_release released;
            handle_.close();
        }
        for (const auto& device : devices_)
            device->stop();
        rethrowDevice();
    }

  private:
    void rethrowDevice() {
        for (const auto& device : devices_)
            device->rethrow();
    }
    [[nodiscard]] bool deviceFailed() const {
        return std::ranges::any_of(devices_, [](const auto& device) { return device->failed(); });
    }
    struct Callback {
        py::object function;
        const Session* session;
        std::exception_ptr thrown;
        static int call(void* context, const ts_state* state) noexcept {
            const py::gil_scoped_acquire gil;
            auto& self = *static_cast<Callback*>(context);
            try {
                if (PyErr_CheckSignals() != 0)
                    throw py::error_already_set();
                if (self.session->deviceFailed())
                    return 1; // run throws what it threw
                if (self.function.is_none())
                    return 0;
                const py::object answer = self.function(*state);
                return answer.is(py::bool_(false)) ? 1 : 0;
            } catch (...) {
                self.thrown = std::current_exception();
                return 1;
            }
        }
    };
    std::vector<std::unique_ptr<touchstone::python::PythonDevice>> devices_;
    ts::Handle<ts_session, ts_session_close> handle_;
};

class Recording {
  public:
    explicit Recording(const std::string& file) {
        const py::gil_scoped_release released;
        ts::check(ts_recording_open(file.c_str(), handle_.out()));
    }
    py::dict read(size_t most) {
        const Ticks ticks(most, true);
        size_t count = 0;
        {
            const py::gil_scoped_release released;
            ts::check(ts_recording_read(handle_.get(), ticks.get(), &count));
        }
        return ticks.dict(count);
    }
    [[nodiscard]] std::string text(const std::string& what) const {
        return ts::text([&](char* out, size_t room, size_t* needed) {
            return ts_recording_text(handle_.get(), what.c_str(), out, room, needed);
        });
    }
    void close() { handle_.close(); }

  private:
    ts::Handle<ts_recording, ts_recording_close> handle_;
};

py::array_t<double> vectorOf(const double (&values)[3]) {
    return py::array_t<double>(3, values);
}

/// The exception class of a status: touchstone.Error and one of Python's.
PyObject* exceptionOf(const py::dict& classes, ts_status status) {
    const char* name = ts_status_name(status);
    return classes.contains(name) ? classes[name].ptr() : classes["Error"].ptr();
}

void bindSession(py::module_& m) {
    py::class_<ts_state> state(m, "State");
    state.def_property_readonly("touching", [](const ts_state& s) { return s.touching != 0; })
        .def_property_readonly("realtime", [](const ts_state& s) { return s.realtime != 0; })
        .def_property_readonly("hip", [](const ts_state& s) { return vectorOf(s.hip); })
        .def_property_readonly("proxy", [](const ts_state& s) { return vectorOf(s.proxy); })
        .def_property_readonly("normal", [](const ts_state& s) { return vectorOf(s.normal); })
        .def_property_readonly("force", [](const ts_state& s) { return vectorOf(s.force); })
        .def_property_readonly("command", [](const ts_state& s) { return vectorOf(s.command); })
        .def_readonly("tick", &ts_state::tick)
        .def_readonly("time", &ts_state::time)
        .def_readonly("penetration", &ts_state::penetration)
        .def_readonly("contacts", &ts_state::contacts)
        .def_readonly("friction", &ts_state::friction)
        .def_readonly("flags", &ts_state::flags)
        .def_readonly("object", &ts_state::object)
        .def_readonly("ticks", &ts_state::ticks)
        .def_readonly("missed", &ts_state::missed)
        .def_readonly("skipped", &ts_state::skipped)
        .def_readonly("dropped", &ts_state::dropped);
    py::class_<Session>(m, "Session")
        .def(py::init<const py::list&, double, double, double, double, size_t, double>())
        .def("material",
             [](Session& s, uint64_t material, const std::string& name, double value) {
                 s.call([&](ts_session session) {
                     return ts_session_material(session, material, name.c_str(), value);
                 });
             })
        .def("move", &Session::move)
        .def("halt", [](Session& s) { s.call(ts_session_halt); })
        .def("pose", &Session::pose)
        .def("render",
             [](Session& s, bool on) {
                 s.call([&](ts_session session) { return ts_session_render(session, on ? 1 : 0); });
             })
        .def("goal", &Session::goal)
        .def("touch",
             [](Session& s, const Scene& scene) {
                 s.call([&](ts_session session) { return ts_session_touch(session, scene.get()); });
             })
        .def("set",
             [](Session& s, const std::string& name, const std::string& value) {
                 s.call([&](ts_session session) {
                     return ts_session_set(session, name.c_str(), value.c_str());
                 });
             })
        .def("force",
             [](Session& s, bool on) {
                 s.call([&](ts_session session) { return ts_session_force(session, on ? 1 : 0); });
             })
        .def("record",
             [](Session& s, const std::optional<std::string>& file) {
                 s.call([&](ts_session session) {
                     return ts_session_record(session, file ? file->c_str() : nullptr);
                 });
             })
        .def("start", [](Session& s) { s.call(ts_session_start); })
        .def("stop", [](Session& s) { s.call(ts_session_stop); })
        .def("pump", &Session::pump)
        .def("run", &Session::run)
        .def("hand", &Session::hand)
        .def("take", &Session::take)
        .def("close", &Session::close);
}

} // namespace

PYBIND11_MODULE(_touchstone, m) {
    py::class_<ts_scene_info>(m, "SceneInfo")
        .def_readonly("objects", &ts_scene_info::objects)
        .def_readonly("triangles", &ts_scene_info::triangles)
        .def_readonly("materials", &ts_scene_info::materials)
        .def_property_readonly("low", [](const ts_scene_info& i) { return vectorOf(i.low); })
        .def_property_readonly("high", [](const ts_scene_info& i) { return vectorOf(i.high); })
        .def_property_readonly("moves", [](const ts_scene_info& i) { return i.moves != 0; });
    py::class_<ts::Material>(m, "Material")
        .def(py::init([](double stiffness, double damping, double staticFriction, double dynamicFriction,
                         double viscousFriction, const std::string& name) {
                 return ts::Material{stiffness,       damping,         staticFriction,
                                     dynamicFriction, viscousFriction, name};
             }),
             py::kw_only(), py::arg("stiffness") = NAN, py::arg("damping") = NAN,
             py::arg("static_friction") = NAN, py::arg("dynamic_friction") = NAN,
             py::arg("viscous_friction") = NAN, py::arg("name") = "")
        .def_readwrite("stiffness", &ts::Material::stiffness)
        .def_readwrite("damping", &ts::Material::damping)
        .def_readwrite("static_friction", &ts::Material::staticFriction)
        .def_readwrite("dynamic_friction", &ts::Material::dynamicFriction)
        .def_readwrite("viscous_friction", &ts::Material::viscousFriction)
        .def_readwrite("name", &ts::Material::name);
    py::class_<Scene>(m, "Scene")
        .def(py::init<const std::string&, int, std::optional<double>>())
        .def(py::init<const py::bytes&, const std::string&, int>())
        .def(py::init<const py::list&, const std::vector<ts::Material>&, int>())
        .def("info", &Scene::info)
        .def("warnings", &Scene::warnings)
        .def("stroke", &Scene::stroke)
        .def("triangles", &Scene::triangles)
        .def("close", &Scene::close);
    py::class_<Hand>(m, "Hand")
        .def(py::init<const Scene&, const std::map<std::string, std::string>&, size_t>())
        .def("set", &Hand::set)
        .def("touch", &Hand::touch)
        .def("close", &Hand::close);
    py::class_<Recording>(m, "Recording")
        .def(py::init<const std::string&>())
        .def("read", &Recording::read)
        .def("text", &Recording::text)
        .def("close", &Recording::close);
    bindSession(m);
    m.def("version", ts_version);
    m.def("settings", [] {
        py::list all;
        for (size_t i = 0; i < ts_setting_count(); ++i) {
            ts_setting_info info = TS_STRUCT(ts_setting_info);
            ts::check(ts_setting_get_info(i, &info));
            all.append(py::make_tuple(info.name, info.unit, info.meaning, info.allowed, info.initial));
        }
        return all;
    });
    // Classes of the exceptions by status, filled by touchstone/__init__.py.
    m.attr("exceptions") = py::dict();
    py::register_exception_translator([](std::exception_ptr thrown) {
        try {
            std::rethrow_exception(thrown);
        } catch (const ts::Error& error) {
            const py::dict classes = py::module_::import("touchstone._touchstone").attr("exceptions");
            PyErr_SetString(exceptionOf(classes, error.status()), error.what());
        }
    });
}
