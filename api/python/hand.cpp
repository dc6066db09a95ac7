// Hands that touch offline.

#include "api/python/bindings.h"
#include "api/python/scene.h"

#include <pybind11/stl.h>

#include <map>
#include <optional>
#include <string>
#include <vector>

namespace touchstone::python {

namespace {

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
            status = ts_hands_touch(handle_.get(), paths.data(), arrays.data(), paths.size(), nullptr);
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

} // namespace

void bindHand(py::module_& m) {
    py::class_<Hand>(m, "Hand")
        .def(py::init<const Scene&, const std::map<std::string, std::string>&, size_t>())
        .def("set", &Hand::set)
        .def("touch", &Hand::touch)
        .def("close", &Hand::close);
}

} // namespace touchstone::python
