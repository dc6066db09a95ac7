// Real time.

#include "api/python/bindings.h"
#include "api/python/python_device.h"
#include "api/python/scene.h"

#include <pybind11/functional.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace touchstone::python {

namespace {

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
                devices_.push_back(
                    std::make_unique<PythonDevice>(functions.first, functions.second, deviceRate));
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
    double materialNumber(uint64_t material, const std::string& name) {
        double value = 0.0;
        call([&](ts_session session) {
            return ts_session_material_number(session, material, name.c_str(), &value);
        });
        return value;
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
    std::vector<std::unique_ptr<PythonDevice>> devices_;
    ts::Handle<ts_session, ts_session_close> handle_;
};

/// The newest tick.
void bindState(py::module_& m) {
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
}

} // namespace

void bindSession(py::module_& m) {
    bindState(m);
    py::class_<Session>(m, "Session")
        .def(py::init<const py::list&, double, double, double, double, size_t, double>())
        .def("material",
             [](Session& s, uint64_t material, const std::string& name, double value) {
                 s.call([&](ts_session session) {
                     return ts_session_material(session, material, name.c_str(), value);
                 });
             })
        .def("material_number", &Session::materialNumber)
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

} // namespace touchstone::python
