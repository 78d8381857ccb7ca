#include <fmt/format.h>
#include <pybind11/stl.h>

#include "arrays.hpp"
#include "docs.hpp"
#include "exitance/light_maps.hpp"
#include "exitance/picture.hpp"
#include "exitance/solution.hpp"
#include "exitance/solve.hpp"
#include "module.hpp"
#include "running.hpp"

namespace python {
namespace {

using namespace py::literals;

/// Options by keyword as options of the command line: mesh_size=0.1 is --mesh-size 0.1, True is a flag, None nothing.
std::vector<std::pair<std::string, std::string>> words_of(const py::kwargs& more) {
    std::vector<std::pair<std::string, std::string>> out;
    for (const auto& [key, value] : more) {
        std::string name = key.cast<std::string>();
        std::replace(name.begin(), name.end(), '_', '-');
        if (value.is_none() || value.is(py::bool_(false))) continue;
        out.emplace_back(name, value.is(py::bool_(true)) ? "" : py::str(value).cast<std::string>());
    }
    return out;
}

api::Solution solve(const api::Scene& scene, std::optional<double> error, const std::string& method,
                    std::optional<int> bounces, std::optional<double> time_limit,
                    std::optional<std::size_t> memory_limit, std::optional<int> threads, const py::object& progress,
                    const py::kwargs& more) {
    api::SolveOptions options;
    options.error = error;
    options.method = method;
    options.bounces = bounces.value_or(-1);
    options.time_limit = time_limit;
    options.memory_limit = memory_limit;
    options.threads = threads.value_or(0);
    options.more = words_of(more);
    return run<api::Solution>(progress,
                              [&](const api::Control& control) { return api::solve(scene, options, control); });
}

api::Component component_of(const std::string& name) {
    if (name == "total") return api::Component::total;
    if (name == "direct") return api::Component::direct;
    if (name == "indirect") return api::Component::indirect;
    raise_usage(fmt::format("'{}' is none", name), "component", "there are total, direct and indirect");
}

/// Light of one quantity at points, (n, bands) or (bands,). `value` takes a Light and returns a Spectrum.
template <class Value>
py::array light_at(const api::Solution& solution, const py::object& points, const py::object& normals,
                   const std::string& component, const Value& value) {
    bool is_single = false;
    const std::vector<api::Probe> probes = probes_of(points, normals, is_single);
    const api::Component part = component_of(component);
    const auto light = run<std::vector<api::Light>>(
        py::none(), [&](const api::Control& control) { return solution.light(probes, part, control); });
    std::vector<double> out;
    out.reserve(light.size() * api::bands);
    for (const api::Light& one : light) {
        const api::Spectrum v = value(one);
        out.insert(out.end(), v.value.begin(), v.value.end());
    }
    const auto count = static_cast<py::ssize_t>(light.size()), n = static_cast<py::ssize_t>(api::bands);
    return is_single ? array_of(std::move(out), {n}) : array_of(std::move(out), {count, n});
}

py::array irradiance(const api::Solution& solution, const py::object& points, const py::object& normals,
                     const std::string& component) {
    return light_at(solution, points, normals, component, [](const api::Light& l) { return l.irradiance; });
}

py::array radiosity(const api::Solution& solution, const py::object& points, const py::object& normals) {
    return light_at(solution, points, normals, "total",
                    [](const api::Light& l) { return l.on_surface ? l.radiosity : api::Spectrum(std::nan("")); });
}

py::dict energy(const api::Solution& solution) {
    const api::Energy e = solution.energy();
    return py::dict("emitted"_a = e.emitted, "absorbed"_a = e.absorbed, "escaped"_a = e.escaped, "defect"_a = e.defect);
}

api::Solution mix(const api::Solution& solution, const std::vector<std::pair<std::string, double>>& dim,
                  const std::vector<std::pair<std::string, api::Spectrum>>& reflectance) {
    return without_lock<api::Solution>([&] { return solution.mix({dim, reflectance}); });
}

api::Solution mix_dicts(const api::Solution& solution, const py::dict& dim, const py::dict& reflectance) {
    std::vector<std::pair<std::string, double>> factors;
    for (const auto& [name, factor] : dim) factors.emplace_back(name.cast<std::string>(), factor.cast<double>());
    std::vector<std::pair<std::string, api::Spectrum>> colours;
    for (const auto& [name, rho] : reflectance)
        colours.emplace_back(name.cast<std::string>(),
                             spectrum_of(py::reinterpret_borrow<py::object>(rho), "reflectance"));
    return mix(solution, factors, colours);
}

api::Picture render(const api::Solution& solution, const std::optional<api::Camera>& camera,
                    const std::pair<int, int>& size, int samples, const py::object& progress) {
    const api::PictureOptions options{camera, size.first, size.second, samples};
    return run<api::Picture>(progress,
                             [&](const api::Control& control) { return api::render(solution, options, control); });
}

api::LightMaps bake(const api::Solution& solution, double density, int padding, const std::string& uv,
                    const std::optional<std::pair<int, int>>& size, bool faceted, const py::object& progress) {
    api::BakeOptions options{.density = density, .padding = padding, .uv = uv, .faceted = faceted};
    if (size) options.width = size->first, options.height = size->second;
    return run<api::LightMaps>(progress,
                               [&](const api::Control& control) { return api::bake(solution, options, control); });
}

std::string describe(const api::Solution& solution) {
    const std::optional<double> error = solution.error();
    return fmt::format("<exitance.Solution: {} faces, estimated error {}{}>", solution.scene().size(),
                       error ? fmt::format("{:.3g}", *error) : std::string("unknown"),
                       solution.converged() ? "" : ", not converged");
}

constexpr const char* solve_arguments = R"doc(

scene         a Scene
error         requested relative RMS error of the light; None: 0.02
method        "auto", "matrix", "hierarchical", "wavelet", "progressive", "substructuring", "monte-carlo", ...
bounces       number of reflections; None: all, 0: direct light alone
time_limit    seconds; the light found so far is returned
memory_limit  memory of the whole process, bytes
threads       number of threads; the light does not depend on it
progress      True prints phases to sys.stderr; a function (phase, fraction) stops the solve if it returns False
more          further options of `exitance solve`, with underscores: mesh_size=0.1, output_light="elements"

Other Python threads run meanwhile. Ctrl-C stops the solve and raises KeyboardInterrupt.)doc";

constexpr const char* probe_arguments = R"doc(

points      (n, 3) or (3,), metres
normals     directions that the measuring planes face: of the same shape, or (3,) for all
component   "total", "direct" (from emitters without reflection) or "indirect"
returns     (n, bands) or (bands,): W/m^2, or lx if the scene is photometric

)doc";

void add_mesh(py::module_& m) {
    static const auto rows = [](const auto member) {
        return [member](const py::object& self) { return view_of_rows(self.cast<const api::Mesh&>().*member, self); };
    };
    py::class_<api::Mesh>(m, "Mesh", docs::Mesh::self)
        .def_property_readonly("vertices", rows(&api::Mesh::vertices), docs::Mesh::vertices)
        .def_property_readonly("triangles", rows(&api::Mesh::triangles), docs::Mesh::triangles)
        .def_property_readonly("irradiance", rows(&api::Mesh::irradiance), docs::Mesh::irradiance)
        .def_property_readonly("radiosity", rows(&api::Mesh::radiosity), docs::Mesh::radiosity)
        .def_property_readonly(
            "face",
            [](const py::object& self) {
                const auto& face = self.cast<const api::Mesh&>().face;
                return view_of(face.data(), {static_cast<py::ssize_t>(face.size())}, self);
            },
            docs::Mesh::face)
        .def("__repr__", [](const api::Mesh& mesh) {
            return fmt::format("<exitance.Mesh: {} vertices, {} triangles>", mesh.vertices.size(),
                               mesh.triangles.size());
        });
}

void add_solution(py::module_& m) {
    static const std::string irradiance_doc =
        std::string("Irradiance at points.") + probe_arguments + docs::Solution::light;
    static const std::string radiosity_doc =
        std::string("Emitted and reflected light at points of surfaces; NaN at points in the air.") + probe_arguments +
        docs::Solution::light;
    py::class_<api::Solution>(m, "Solution", docs::Solution::self)
        .def("irradiance", &irradiance, "points"_a, "normals"_a, py::kw_only(), "component"_a = "total",
             irradiance_doc.c_str())
        .def("radiosity", &radiosity, "points"_a, "normals"_a, radiosity_doc.c_str())
        .def_property_readonly("error", &api::Solution::error, docs::Solution::error)
        .def_property_readonly("error_bound", &api::Solution::error_bound, docs::Solution::error_bound)
        .def_property_readonly("converged", &api::Solution::converged, docs::Solution::converged)
        .def_property_readonly("stopped_by", &api::Solution::stopped_by, docs::Solution::stopped_by)
        .def_property_readonly("energy", &energy, docs::Energy::self)
        .def_property_readonly("warnings", &api::Solution::warnings, docs::Solution::warnings)
        .def_property_readonly(
            "stats",
            [](const api::Solution& s) { return py::module_::import("json").attr("loads")(s.statistics_json()); },
            "All statistics, as `exitance stats --json` prints them.")
        .def_property_readonly("scene", &api::Solution::scene)
        .def(
            "mesh", [](const api::Solution& s) { return without_lock<api::Mesh>([&] { return s.mesh(); }); },
            docs::Solution::mesh)
        .def(
            "export",
            [](const api::Solution& s, const py::object& path) {
                without_lock<void>([&, to = path_of(path)] { return s.export_mesh(to); });
            },
            "path"_a, docs::Solution::export_mesh)
        .def(
            "save",
            [](const api::Solution& s, const py::object& path) {
                without_lock<void>([&, to = path_of(path)] { return s.save(to); });
            },
            "path"_a, docs::Solution::save)
        .def_property_readonly("light_groups", &api::Solution::light_groups, docs::Solution::light_groups)
        .def("mix", &mix_dicts, "dim"_a = py::dict(), "reflectance"_a = py::dict(), docs::Solution::mix)
        .def("render", &render, "camera"_a = py::none(), "size"_a = std::pair(640, 400), "samples"_a = 16,
             "progress"_a = py::none(), docs::render)
        .def("bake", &bake, "density"_a = 0.0, "padding"_a = 4, "uv"_a = "", "size"_a = py::none(), "faceted"_a = false,
             "progress"_a = py::none(), docs::bake)
        .def("__repr__", &describe);
}

}  // namespace

void add_solutions(py::module_& m) {
    add_mesh(m);
    add_solution(m);
    static const std::string solve_doc = std::string(docs::solve) + solve_arguments;
    m.def("solve", &solve, "scene"_a, "error"_a = py::none(), py::kw_only(), "method"_a = "auto",
          "bounces"_a = py::none(), "time_limit"_a = py::none(), "memory_limit"_a = py::none(),
          "threads"_a = py::none(), "progress"_a = py::none(), solve_doc.c_str());
    m.def(
        "load_solution",
        [](const py::object& path) {
            return without_lock<api::Solution>([from = path_of(path)] { return api::load_solution(from); });
        },
        "path"_a, docs::load_solution);
    m.def(
        "set_threads",
        [](int count) {
            const py::gil_scoped_release release;
            api::set_threads(count);
        },
        "count"_a, docs::set_threads);
}

}  // namespace python
