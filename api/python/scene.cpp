#include "api/python/scene.h"

#include "api/python/bindings.h"

#include <pybind11/stl.h>

#include <cmath>

namespace touchstone::python {

void bindScene(py::module_& m) {
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
}

} // namespace touchstone::python
