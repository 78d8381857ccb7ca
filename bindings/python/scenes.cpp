#include <fmt/format.h>
#include <pybind11/stl.h>

#include <map>

#include "arrays.hpp"
#include "docs.hpp"
#include "exitance/load.hpp"
#include "exitance/scene.hpp"
#include "module.hpp"
#include "running.hpp"

namespace python {
namespace {

using namespace py::literals;

/// Index of an array of indices. Throws a usage error unless it is a whole number from 0 to below 2^32.
std::uint32_t index_of(double value, const std::string& name) {
    if (!(value >= 0 && value < 4294967295.0) || value != static_cast<double>(static_cast<std::uint32_t>(value)))
        raise_usage(fmt::format("{:g} is not an index", value), name, "indices are whole numbers from 0");
    return static_cast<std::uint32_t>(value);
}

/// Adds faces: an array (m, k) of indices, or a sequence of sequences of different lengths. A row of fewer than k
/// corners ends with -1, as in trimesh.
void add_faces(const py::object& faces, api::SceneDescription& d) {
    const auto add = [&](const double* row, py::ssize_t count) {
        while (count > 0 && row[count - 1] == -1) --count;
        d.corner_counts.push_back(static_cast<std::uint32_t>(count));
        for (py::ssize_t k = 0; k < count; ++k) d.corners.push_back(index_of(row[k], "faces"));
    };
    if (py::isinstance<py::array>(faces)) {
        const Doubles rows = faces.cast<Doubles>();
        if (rows.ndim() != 2) raise_usage("is not an array of shape (m, k)", "faces");
        for (py::ssize_t f = 0; f < rows.shape(0); ++f) add(rows.data(f, 0), rows.shape(1));
        return;
    }
    for (const py::handle face : faces) {
        std::vector<double> row;
        try {
            row = face.cast<std::vector<double>>();
        } catch (const py::cast_error&) {
            raise_usage("is not a list of lists of indices", "faces");
        }
        add(row.data(), static_cast<py::ssize_t>(row.size()));
    }
}

/// Row i of an array (n, bands).
api::Spectrum row_of(const Doubles& array, std::size_t i) {
    api::Spectrum out;
    for (std::size_t b = 0; b < api::bands; ++b)
        out[b] = array.at(static_cast<py::ssize_t>(i), static_cast<py::ssize_t>(b));
    return out;
}

/// Adds materials: those that `material` selects, or else one per distinct pair of reflectance and exitance.
void add_materials(const py::object& reflectance, const py::object& exitance, const py::object& material,
                   const std::vector<std::string>& names, api::SceneDescription& d) {
    const std::size_t faces = d.corner_counts.size();
    std::size_t rows = faces;
    if (!material.is_none()) {
        const Doubles index = broadcast(material, {static_cast<py::ssize_t>(faces)}, "material");
        rows = names.size();
        for (std::size_t f = 0; f < faces; ++f) {
            d.material.push_back(index_of(index.at(static_cast<py::ssize_t>(f)), "material"));
            rows = std::max(rows, std::size_t(d.material.back()) + 1);
        }
    }
    const std::vector<py::ssize_t> shape{static_cast<py::ssize_t>(rows), static_cast<py::ssize_t>(api::bands)};
    const Doubles rho = broadcast(reflectance, shape, "reflectance"), M = broadcast(exitance, shape, "exitance");
    std::map<std::pair<decltype(api::Spectrum::value), decltype(api::Spectrum::value)>, std::uint32_t> known;
    for (std::size_t i = 0; i < rows; ++i) {
        const api::Spectrum r = row_of(rho, i), e = row_of(M, i);
        const auto count = static_cast<std::uint32_t>(d.materials.size());
        const bool is_new = !material.is_none() || known.emplace(std::pair(r.value, e.value), count).second;
        if (is_new) d.materials.push_back({i < names.size() ? names[i] : fmt::format("material {}", count), r, e});
        if (material.is_none()) d.material.push_back(known.at({r.value, e.value}));
    }
}

/// Adds the names of groups, one per face.
void add_groups(const std::vector<std::string>& groups, api::SceneDescription& d) {
    std::map<std::string, std::uint32_t> known;
    for (const std::string& name : groups) {
        const auto [at, is_new] = known.emplace(name, static_cast<std::uint32_t>(d.groups.size()));
        if (is_new) d.groups.push_back(name);
        d.group.push_back(at->second);
    }
}

api::Scene make(const py::object& vertices, const py::object& faces, const py::object& reflectance,
                const py::object& exitance, const py::object& material, const std::vector<std::string>& names,
                const std::vector<std::string>& groups, bool photometric, const std::optional<std::string>& sky,
                const py::object& epw, bool light_groups) {
    api::SceneDescription d;
    const Doubles points = points_of(vertices, "vertices");
    for (py::ssize_t i = 0; i < points.shape(0); ++i)
        d.vertices.push_back({points.at(i, 0), points.at(i, 1), points.at(i, 2)});
    add_faces(faces, d);
    if (material.is_none() && !names.empty()) raise_usage("needs material", "names", "give one index per face");
    add_materials(reflectance, exitance, material, names, d);
    add_groups(groups, d);
    d.photometric = photometric;
    d.sky = sky.value_or("");
    if (!epw.is_none()) d.epw = path_of(epw);
    d.light_groups = light_groups;
    return without_lock<api::Scene>([&] { return api::make_scene(d); });
}

api::Scene load(const py::args& files, bool strict, const py::object& length_unit, const std::string& up,
                bool turn_bodies, const py::object& luminaires, const std::optional<std::string>& sky,
                const py::object& epw, std::optional<bool> photometric, bool light_groups,
                std::optional<std::size_t> texture_parts, const std::optional<std::string>& lod) {
    std::vector<std::string> paths;
    for (const py::handle file : files) paths.push_back(path_of(py::reinterpret_borrow<py::object>(file)));
    api::LoadOptions options;
    options.strict = strict;
    if (!length_unit.is_none()) options.length_unit = length_unit.cast<double>();
    if (up != "" && up != "y" && up != "z") raise_usage("must be 'y' or 'z'", "up");
    if (up != "") options.y_is_up = up == "y";
    options.turn_bodies = turn_bodies;
    if (!luminaires.is_none()) options.luminaires = path_of(luminaires);
    options.sky = sky.value_or("");
    if (!epw.is_none()) options.epw = path_of(epw);
    options.photometric = photometric;
    options.light_groups = light_groups;
    options.texture_parts = texture_parts;
    options.lod = lod.value_or("");
    return run<api::Scene>(py::none(),
                           [&](const api::Control& control) { return api::load(std::span(paths), options, control); });
}

std::string describe(const api::Scene& scene) {
    return fmt::format("<exitance.Scene: {} faces, {:.4g} m^2, {} materials>", scene.size(), scene.area(),
                       scene.materials().size());
}

api::Face checked_face(const api::Scene& scene, std::ptrdiff_t index) {
    return scene.face(checked_index(index, scene.size(), "face"));
}

/// One number per face, as an array.
py::array areas_of(const api::Scene& scene) {
    std::vector<double> out;
    for (std::size_t i = 0; i < scene.size(); ++i) out.push_back(scene.face(i).area);
    const auto count = static_cast<py::ssize_t>(out.size());
    return array_of(std::move(out), {count});
}

void add_parts(py::module_& m) {
    py::class_<api::Material>(m, "Material", docs::Material::self)
        .def_readonly("name", &api::Material::name)
        .def_property_readonly(
            "reflectance", [](const api::Material& s) { return array_of(s.reflectance); }, docs::Material::reflectance)
        .def_property_readonly(
            "exitance", [](const api::Material& s) { return array_of(s.exitance); }, docs::Material::exitance)
        .def("__repr__", [](const api::Material& s) { return fmt::format("<exitance.Material '{}'>", s.name); });
    py::class_<api::Finding>(m, "Finding", docs::Finding::self)
        .def_property_readonly("kind",
                               [](const api::Finding& f) {
                                   return f.kind == api::Finding::Kind::error     ? "error"
                                          : f.kind == api::Finding::Kind::warning ? "warning"
                                                                                  : "repair";
                               })
        .def_readonly("where", &api::Finding::where, docs::Finding::where)
        .def_readonly("message", &api::Finding::message, docs::Finding::message)
        .def_readonly("hint", &api::Finding::hint, docs::Finding::hint)
        .def("__repr__", [](const api::Finding& f) { return fmt::format("<exitance.Finding: {}>", f.message); });
    py::class_<api::Face>(m, "Face", docs::Face::self)
        .def_property_readonly(
            "outline",
            [](const api::Face& f) {
                std::vector<double> out;
                for (const api::Vec3& p : f.outline) out.insert(out.end(), {p.x, p.y, p.z});
                return array_of(std::move(out), {static_cast<py::ssize_t>(f.outline.size()), 3});
            },
            docs::Face::outline)
        .def_property_readonly(
            "normal", [](const api::Face& f) { return array_of(f.normal); }, docs::Face::normal)
        .def_readonly("area", &api::Face::area, docs::Face::area)
        .def_readonly("material", &api::Face::material, docs::Face::material)
        .def_readonly("group", &api::Face::group, docs::Face::group)
        .def("__repr__", [](const api::Face& f) {
            return fmt::format("<exitance.Face: {} corners, {:.4g} m^2>", f.outline.size(), f.area);
        });
}

constexpr const char* scene_arguments = R"doc(

Scene(vertices, faces, ...) makes a scene from arrays. It gives the same light, to the last bit, as a file with the same
content.
vertices      (n, 3) metres
faces         (m, k) indices of corners, counter-clockwise seen from the front, where -1 fills up rows of fewer corners;
              or a list of lists
reflectance   (m, bands), or of a shape that NumPy extends to it: one number, (bands,), (m, 1)
exitance      W/m^2, of such a shape
material      (m,) indices of materials; `reflectance` and `exitance` then have one row per material. Coplanar
              neighbours of one material are treated as one surface. None: equal rows are one material
names         names of the materials
groups        (m,) names of groups; emitting faces of a group can be dimmed together
photometric   emission is in lumens instead of watts
sky, epw, light_groups  as for load()
Errors: UsageError for arrays that do not fit together; Error for faces and materials that cannot be repaired.)doc";

constexpr const char* load_arguments = R"doc(

files         paths of the files of one scene
strict        repairs and unknown materials are errors
length_unit   metres per unit of .obj, .stl, .ply and .vs3 files
up            upright axis of these files, "y" or "z"
turn_bodies   reverses the faces of closed bodies that are inside out
luminaires    path of a table (CSV) of luminaires to add
sky           light from outside, such as "overcast" or "perez,lat=47.4,lon=8.5,time=06-21T12:00,dni=700,dhi=120"
epw           path of a weather file with place and irradiances for `sky`
photometric   emission is in lumens; None: as the file says
light_groups  keeps the emitters of each group apart; solve() then also solves each group, for Solution.mix()
texture_parts limit on the parts into which textured faces are cut where their colour varies; None: 500 and one more
              for each four faces, 0: faces are not cut
lod           level of detail to read from CityJSON files, such as "1.3"; None: the highest level of each object)doc";

}  // namespace

void add_scenes(py::module_& m) {
    add_parts(m);
    static const std::string scene_doc = std::string(docs::Scene::self) + scene_arguments;
    py::class_<api::Scene>(m, "Scene", scene_doc.c_str())
        .def(py::init(&make), "vertices"_a, "faces"_a, py::kw_only(), "reflectance"_a = 0.5, "exitance"_a = 0.0,
             "material"_a = py::none(), "names"_a = std::vector<std::string>(), "groups"_a = std::vector<std::string>(),
             "photometric"_a = false, "sky"_a = py::none(), "epw"_a = py::none(), "light_groups"_a = false)
        .def("__len__", &api::Scene::size, docs::Scene::size)
        .def("face", &checked_face, "index"_a, docs::Scene::face)
        .def_property_readonly("materials", &api::Scene::materials)
        .def_property_readonly("groups", &api::Scene::groups, docs::Scene::groups)
        .def_property_readonly("area", &api::Scene::area, docs::Scene::area)
        .def_property_readonly("areas", &areas_of, "Area of every face, m^2, as an array.")
        .def_property_readonly(
            "bounds",
            [](const api::Scene& s) {
                const api::Vec3 lo = s.lowest(), hi = s.highest();
                return array_of(std::vector<double>{lo.x, lo.y, lo.z, hi.x, hi.y, hi.z}, {2, 3});
            },
            docs::Scene::lowest)
        .def_property_readonly("has_light", &api::Scene::has_light, docs::Scene::has_light)
        .def_property_readonly("has_light_groups", &api::Scene::has_light_groups, docs::Scene::has_light_groups)
        .def_property_readonly("is_photometric", &api::Scene::is_photometric, docs::Scene::is_photometric)
        .def_property_readonly("findings", &api::Scene::findings, docs::Scene::findings)
        .def("__repr__", &describe);
    static const std::string load_doc = std::string(docs::load) + load_arguments;
    m.def("load", &load, "strict"_a = false, "length_unit"_a = py::none(), "up"_a = "", "turn_bodies"_a = false,
          "luminaires"_a = py::none(), "sky"_a = py::none(), "epw"_a = py::none(), "photometric"_a = py::none(),
          "light_groups"_a = false, "texture_parts"_a = py::none(), "lod"_a = py::none(), load_doc.c_str());
}

}  // namespace python
