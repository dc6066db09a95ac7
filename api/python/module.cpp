// The part of the Python module that is compiled: NumPy arrays to and from libtouchstone's C interface.

#include "api/python/bindings.h"
#include "touchstone/touchstone.hpp"

namespace py = pybind11;

namespace {

/// The exception class of a status: touchstone.Error and one of Python's.
PyObject* exceptionOf(const py::dict& classes, ts_status status) {
    const char* name = ts_status_name(status);
    return classes.contains(name) ? classes[name].ptr() : classes["Error"].ptr();
}

} // namespace

PYBIND11_MODULE(_touchstone, m) {
    touchstone::python::bindScene(m);
    touchstone::python::bindHand(m);
    touchstone::python::bindSession(m);
    touchstone::python::bindRecording(m);
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
