#pragma once
// NumPy arrays to and from the C interface.

#include "touchstone/touchstone.hpp"

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <algorithm>
#include <cstdint>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace touchstone::python {

namespace py = pybind11;

template <class T>
using Array = py::array_t<T, py::array::c_style | py::array::forcecast>;

[[nodiscard]] std::string shapeOf(const py::array& array);

/// Throws ts::Error.
[[noreturn]] void refuse(const std::string& argument, const std::string& problem);

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

[[nodiscard]] inline py::array_t<double> vectorOf(const double (&values)[3]) {
    return py::array_t<double>(3, values);
}

} // namespace touchstone::python
