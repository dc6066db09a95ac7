#pragma once
// The classes of the module, by file.

#include <pybind11/pybind11.h>

namespace touchstone::python {

void bindScene(pybind11::module_& module);
void bindHand(pybind11::module_& module);
void bindSession(pybind11::module_& module);
void bindRecording(pybind11::module_& module);

} // namespace touchstone::python
