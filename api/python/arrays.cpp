#include "api/python/arrays.h"

namespace touchstone::python {

std::string shapeOf(const py::array& array) {
    std::string text = "(";
    for (py::ssize_t i = 0; i < array.ndim(); ++i)
        text += (i > 0 ? ", " : "") + std::to_string(array.shape(i));
    return text + (array.ndim() == 1 ? ",)" : ")");
}

void refuse(const std::string& argument, const std::string& problem) {
    throw ts::Error(TS_ARGUMENT, argument + ": " + problem);
}

} // namespace touchstone::python
