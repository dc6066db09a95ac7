#pragma once

#include "api/python/arrays.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::python {

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

} // namespace touchstone::python
