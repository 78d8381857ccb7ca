#include "exitance/picture.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "docs.hpp"
#include "exitance/light_maps.hpp"
#include "module.hpp"
#include "running.hpp"

namespace python {
namespace {

using namespace py::literals;

constexpr std::array projections{"perspective", "orthographic", "fisheye", "panorama"};

api::Camera make_camera(const py::object& eye, const py::object& target, double fov, const py::object& up,
                        const std::string& projection) {
    const auto found = std::find(projections.begin(), projections.end(), projection);
    if (found == projections.end())
        raise_usage(fmt::format("'{}' is not a projection", projection), "projection",
                    "there are perspective, orthographic, fisheye and panorama");
    const api::Camera camera{vec3_of(eye, "eye"), vec3_of(target, "target"), fov, vec3_of(up, "up"),
                             static_cast<api::Projection>(found - projections.begin())};
    check(api::check_camera(camera));
    return camera;
}

std::vector<py::ssize_t> shape_of(const api::Picture& picture, std::size_t channels) {
    return {picture.height(), picture.width(), static_cast<py::ssize_t>(channels)};
}

void add_picture(py::module_& m) {
    py::class_<api::Camera>(m, "Camera", docs::Camera::self)
        .def(py::init(&make_camera), "eye"_a, "target"_a, "fov"_a = 60.0,
             "up"_a = py::cast(std::vector<double>{0, 0, 1}), "projection"_a = "perspective")
        .def_property_readonly("eye", [](const api::Camera& c) { return array_of(c.eye); })
        .def_property_readonly("target", [](const api::Camera& c) { return array_of(c.target); })
        .def_readonly("fov", &api::Camera::fov, docs::Camera::fov)
        .def_property_readonly(
            "up", [](const api::Camera& c) { return array_of(c.up); }, docs::Camera::up)
        .def_property_readonly("projection",
                               [](const api::Camera& c) { return projections[static_cast<std::size_t>(c.projection)]; })
        .def("__repr__", [](const api::Camera& c) {
            return fmt::format("exitance.Camera(({:g}, {:g}, {:g}), ({:g}, {:g}, {:g}), {:g})", c.eye.x, c.eye.y,
                               c.eye.z, c.target.x, c.target.y, c.target.z, c.fov);
        });
    py::class_<api::Picture>(m, "Picture", docs::Picture::self)
        .def_property_readonly(
            "size", [](const api::Picture& p) { return std::pair(p.width(), p.height()); }, "Width and height, pixels.")
        .def_property_readonly("camera", [](const api::Picture& p) { return p.camera(); })
        .def_property_readonly(
            "radiance", [](const api::Picture& p) { return array_of_rows(p.radiance(), shape_of(p, api::bands)); },
            docs::Picture::radiance)
        .def_property_readonly(
            "irradiance", [](const api::Picture& p) { return array_of_rows(p.irradiance(), shape_of(p, api::bands)); },
            docs::Picture::irradiance)
        .def(
            "display",
            [](const api::Picture& p, double exposure) { return array_of_rows(p.display(exposure), shape_of(p, 3)); },
            "exposure"_a = 0.0, docs::Picture::display)
        .def(
            "save",
            [](const api::Picture& p, const py::object& path, double exposure) {
                without_lock<void>([&, to = path_of(path)] { return p.save(to, exposure); });
            },
            "path"_a, "exposure"_a = 0.0, docs::Picture::save)
        .def("__repr__",
             [](const api::Picture& p) { return fmt::format("<exitance.Picture: {} x {}>", p.width(), p.height()); });
}

api::LightMap checked_map(const api::LightMaps& maps, std::ptrdiff_t index) {
    return maps.map(checked_index(index, maps.size(), "light map"));
}

void add_light_maps(py::module_& m) {
    py::class_<api::LightMap>(m, "LightMap", docs::LightMap::self)
        .def_property_readonly(
            "irradiance",
            [](const py::object& self) {
                const auto& map = self.cast<const api::LightMap&>();
                return view_of(reinterpret_cast<const float*>(map.irradiance.data()),
                               {map.height, map.width, static_cast<py::ssize_t>(api::bands)}, self);
            },
            docs::LightMap::irradiance)
        .def_property_readonly(
            "coverage",
            [](const py::object& self) {
                const auto& map = self.cast<const api::LightMap&>();
                return view_of(map.coverage.data(), {map.height, map.width}, self);
            },
            docs::LightMap::coverage)
        .def("__repr__", [](const api::LightMap& map) {
            return fmt::format("<exitance.LightMap: {} x {}>", map.width, map.height);
        });
    py::class_<api::Chart>(m, "Chart", docs::Chart::self)
        .def_readonly("map", &api::Chart::map, docs::Chart::map)
        .def_readonly("x", &api::Chart::x)
        .def_readonly("y", &api::Chart::y)
        .def_readonly("width", &api::Chart::width)
        .def_readonly("height", &api::Chart::height)
        .def_property_readonly(
            "origin", [](const api::Chart& c) { return array_of(c.origin); }, docs::Chart::origin)
        .def_property_readonly(
            "right", [](const api::Chart& c) { return array_of(c.right); }, docs::Chart::right)
        .def_property_readonly(
            "down", [](const api::Chart& c) { return array_of(c.down); }, docs::Chart::down)
        .def_readonly("faces", &api::Chart::faces, docs::Chart::faces)
        .def("__repr__", [](const api::Chart& c) {
            return fmt::format("<exitance.Chart: {} x {} texels of map {}>", c.width, c.height, c.map);
        });
    py::class_<api::LightMaps>(m, "LightMaps", docs::LightMaps::self)
        .def_property_readonly("density", &api::LightMaps::density, docs::LightMaps::density)
        .def("__len__", &api::LightMaps::size)
        .def("__getitem__", &checked_map, "index"_a, docs::LightMaps::map)
        .def_property_readonly("charts", &api::LightMaps::charts, docs::LightMaps::charts)
        .def_property_readonly("warnings", &api::LightMaps::warnings, docs::LightMaps::warnings)
        .def(
            "save",
            [](const api::LightMaps& maps, const py::object& folder) {
                without_lock<void>([&, to = path_of(folder)] { return maps.save(to); });
            },
            "folder"_a, docs::LightMaps::save)
        .def("__repr__", [](const api::LightMaps& maps) {
            return fmt::format("<exitance.LightMaps: {}, {:g} texels per metre>", maps.size(), maps.density());
        });
}

}  // namespace

void add_pictures(py::module_& m) {
    add_picture(m);
    add_light_maps(m);
}

}  // namespace python
