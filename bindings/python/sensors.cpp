#include <fmt/format.h>
#include <pybind11/stl.h>

#include <cstdlib>

#include "arrays.hpp"
#include "docs.hpp"
#include "exitance/glare.hpp"
#include "exitance/light_probes.hpp"
#include "module.hpp"
#include "running.hpp"

namespace python {
namespace {

using namespace py::literals;

/// Light probes of several points.
struct LightProbes {
    std::vector<api::LightProbe> probes;

    /// Coefficients of all probes, (n, 9, bands).
    py::array coefficients(std::array<api::Spectrum, api::harmonic_count> api::LightProbe::*member) const {
        std::vector<double> out;
        out.reserve(probes.size() * api::harmonic_count * api::bands);
        for (const api::LightProbe& probe : probes)
            for (const api::Spectrum& s : probe.*member) out.insert(out.end(), s.value.begin(), s.value.end());
        return array_of(std::move(out), {static_cast<py::ssize_t>(probes.size()), api::harmonic_count, api::bands});
    }

    py::array back_share() const {
        std::vector<double> out;
        for (const api::LightProbe& probe : probes) out.push_back(probe.back_share);
        return array_of(std::move(out), {static_cast<py::ssize_t>(probes.size())});
    }

    py::array irradiance(const py::object& normal) const {
        const api::Vec3 n = vec3_of(normal, "normal");
        std::vector<double> out;
        for (const api::LightProbe& probe : probes) {
            const api::Spectrum E = probe.irradiance(n);
            out.insert(out.end(), E.value.begin(), E.value.end());
        }
        return array_of(std::move(out), {static_cast<py::ssize_t>(probes.size()), api::bands});
    }
};

LightProbes probes(const api::Solution& solution, const py::object& points, int rays, const py::object& progress) {
    const Doubles given = points_of(points, "points");
    std::vector<api::Vec3> places;
    for (py::ssize_t i = 0; i < given.shape(0); ++i) places.push_back({given.at(i, 0), given.at(i, 1), given.at(i, 2)});
    return {run<std::vector<api::LightProbe>>(progress, [&](const api::Control& control) {
        return api::light_probes(solution, places, {.rays = rays}, control);
    })};
}

/// A luminance such as 2000, or a text such as "5x" for a multiple of the mean luminance.
api::GlareOptions glare_options(const py::object& threshold, double efficacy) {
    api::GlareOptions out{.efficacy = efficacy};
    if (!py::isinstance<py::str>(threshold)) {
        out.threshold = threshold.cast<double>();
        return out;
    }
    const std::string word = threshold.cast<std::string>();
    char* end = nullptr;
    out.threshold = std::strtod(word.c_str(), &end), out.is_multiple = true;
    if (end == word.c_str() || std::string(end) != "x")
        raise_usage(fmt::format("'{}' is neither a luminance such as 2000 nor a multiple such as '5x'", word),
                    "threshold");
    return out;
}

api::Glare glare(const api::Solution& solution, const py::object& eye, const py::object& direction,
                 const py::object& threshold, double efficacy, const py::object& progress) {
    const api::Vec3 from = vec3_of(eye, "eye"), towards = vec3_of(direction, "direction");
    const api::GlareOptions options = glare_options(threshold, efficacy);
    return run<api::Glare>(
        progress, [&](const api::Control& control) { return api::glare(solution, from, towards, options, control); });
}

constexpr const char* glare_arguments = R"doc(

eye         (3,), metres
direction   (3,), line of sight
threshold   cd/m^2, or "5x" for five times the mean luminance in view
efficacy    luminous efficacy of light in watts, lm/W
progress    as for solve())doc";

constexpr const char* probe_arguments = R"doc(

points      (n, 3), metres
rays        rays per probe for reflected light, a power of two
progress    as for solve()
returns     LightProbes)doc";

void add_glare(py::module_& m) {
    py::class_<api::GlareSource>(m, "GlareSource", docs::GlareSource::self)
        .def_readonly("name", &api::GlareSource::name, docs::GlareSource::name)
        .def_property_readonly(
            "direction", [](const api::GlareSource& s) { return array_of(s.direction); }, docs::GlareSource::direction)
        .def_readonly("luminance", &api::GlareSource::luminance, docs::GlareSource::luminance)
        .def_readonly("solid_angle", &api::GlareSource::solid_angle, docs::GlareSource::solid_angle)
        .def_readonly("position", &api::GlareSource::position, docs::GlareSource::position)
        .def("__repr__", [](const api::GlareSource& s) {
            return fmt::format("<exitance.GlareSource: {}, {:.4g} cd/m^2>", s.name, s.luminance);
        });
    py::class_<api::Glare>(m, "Glare", docs::Glare::self)
        .def_readonly("probability", &api::Glare::probability, docs::Glare::probability)
        .def_readonly("bounds", &api::Glare::bounds, docs::Glare::bounds)
        .def_readonly("level", &api::Glare::level, docs::Glare::level)
        .def_readonly("vertical_illuminance", &api::Glare::vertical_illuminance, docs::Glare::vertical_illuminance)
        .def_readonly("mean_luminance", &api::Glare::mean_luminance, docs::Glare::mean_luminance)
        .def_readonly("threshold", &api::Glare::threshold, docs::Glare::threshold)
        .def_readonly("sources", &api::Glare::sources, docs::Glare::sources)
        .def("__repr__", [](const api::Glare& g) {
            return fmt::format("<exitance.Glare: {:.3f}, {}, {} sources>", g.probability, g.level, g.sources.size());
        });
}

void add_light_probes(py::module_& m) {
    py::class_<LightProbes>(m, "LightProbes", docs::LightProbe::self)
        .def("__len__", [](const LightProbes& p) { return p.probes.size(); })
        .def_property_readonly(
            "radiance", [](const LightProbes& p) { return p.coefficients(&api::LightProbe::radiance); },
            docs::LightProbe::radiance)
        .def_property_readonly(
            "standard_error", [](const LightProbes& p) { return p.coefficients(&api::LightProbe::standard_error); },
            docs::LightProbe::standard_error)
        .def_property_readonly("back_share", &LightProbes::back_share, docs::LightProbe::back_share)
        .def("irradiance", &LightProbes::irradiance, "normal"_a, docs::LightProbe::irradiance)
        .def("__repr__",
             [](const LightProbes& p) { return fmt::format("<exitance.LightProbes: {}>", p.probes.size()); });
}

}  // namespace

void add_sensors(py::module_& m) {
    add_glare(m);
    add_light_probes(m);
    static const std::string glare_doc = std::string(docs::glare) + glare_arguments;
    static const std::string probes_doc = std::string(docs::light_probes) + probe_arguments;
    py::class_<api::Solution>(m.attr("Solution"))
        .def("glare", &glare, "eye"_a, "direction"_a, py::kw_only(), "threshold"_a = 2000.0, "efficacy"_a = 179.0,
             "progress"_a = py::none(), glare_doc.c_str())
        .def("probes", &probes, "points"_a, py::kw_only(), "rays"_a = 1024, "progress"_a = py::none(),
             probes_doc.c_str());
}

}  // namespace python
