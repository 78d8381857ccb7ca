#include <fmt/format.h>
#include <pybind11/stl.h>

#include <algorithm>
#include <numeric>

#include "arrays.hpp"
#include "docs.hpp"
#include "exitance/daylight.hpp"
#include "exitance/view_factors.hpp"
#include "module.hpp"
#include "running.hpp"

namespace python {
namespace {

using namespace py::literals;

template <class T>
py::array vector_of(std::vector<T> values) {
    const auto count = static_cast<py::ssize_t>(values.size());
    return array_of(std::move(values), {count});
}

/// Options that view factors and operators share.
struct CommonOptions {
    std::optional<double> time_limit;
    std::optional<int> threads;
};

api::ViewFactorOptions options_of(double error, double smallest, std::uint64_t seed, const CommonOptions& common) {
    api::ViewFactorOptions options;
    options.error = error, options.smallest = smallest, options.seed = seed;
    options.time_limit = common.time_limit;
    options.threads = common.threads.value_or(0);
    return options;
}

/// Warns that some rows were not computed.
void warn_of_missing_rows(const api::ViewFactors& F) {
    const auto finished = std::count(F.finished.begin(), F.finished.end(), 1);
    const std::string text = fmt::format(
        "stopped after {} of {} rows of view factors: the others are empty (F.finished), and the matrix is not "
        "reciprocal",
        finished, F.areas.size());
    if (PyErr_WarnEx(PyExc_RuntimeWarning, text.c_str(), 1) != 0) throw py::error_already_set();
}

/// An attribute of the matrix: the array, or None if it is empty.
template <class T>
py::object array_or_none(std::vector<T> values) {
    if (values.empty()) return py::none();
    return vector_of(std::move(values));
}

/// View factors as a scipy.sparse.csr_array, with attributes.
py::object view_factors(const api::Scene& scene, std::optional<double> error, double smallest, std::uint64_t seed,
                        std::optional<double> tolerance, std::optional<double> time_limit, std::optional<int> threads,
                        const py::object& progress) {
    if (error && tolerance) raise_usage("cannot be combined with error", "tolerance", "give one of them");
    const py::object make = py::module_::import("scipy.sparse").attr("csr_array");
    const api::ViewFactorOptions standard;
    api::ViewFactorOptions options = options_of(error.value_or(standard.error), smallest, seed, {time_limit, threads});
    options.tolerance = tolerance;
    api::ViewFactors F = run<api::ViewFactors>(
        progress, [&](const api::Control& control) { return api::view_factors(scene, options, control); });
    if (!F.is_complete) warn_of_missing_rows(F);
    const std::size_t n = F.areas.size();
    std::vector<std::int64_t> starts(F.starts.begin(), F.starts.end());
    std::vector<std::int64_t> columns(F.columns.begin(), F.columns.end());
    const py::object out = make(
        py::make_tuple(vector_of(std::move(F.values)), vector_of(std::move(columns)), vector_of(std::move(starts))),
        "shape"_a = py::make_tuple(n, n));
    out.attr("areas") = vector_of(std::move(F.areas));
    out.attr("emittances") = vector_of(std::move(F.emittances));
    out.attr("sky") = array_or_none(std::move(F.sky));
    out.attr("back") = array_or_none(std::move(F.back));
    out.attr("row_errors") = array_or_none(std::move(F.row_errors));
    out.attr("finished") = vector_of(std::move(F.finished)).attr("astype")("bool");
    return out;
}

/// A scipy.sparse.linalg.LinearOperator with the attribute `transport`.
py::object linear_operator(api::TransportOperator transport) {
    const py::object inner = py::cast(std::move(transport));
    py::object out = py::module_::import("scipy.sparse.linalg").attr("aslinearoperator")(inner);
    out.attr("transport") = inner;
    return out;
}

py::object transport_operator(const api::Scene& scene, double error, std::uint64_t seed,
                              std::optional<double> time_limit, std::optional<int> threads,
                              const py::object& progress) {
    const api::ViewFactorOptions options = options_of(error, 0, seed, {time_limit, threads});
    return linear_operator(run<api::TransportOperator>(
        progress, [&](const api::Control& control) { return api::transport_operator(scene, options, control); }));
}

py::object load_transport_operator(const py::object& path) {
    const std::string file = path_of(path);
    return linear_operator(without_lock<api::TransportOperator>([&] { return api::load_transport_operator(file); }));
}

using Product = api::Result<std::vector<double>> (api::TransportOperator::*)(const std::vector<double>&) const;

/// A product with a vector of shape (n,) or (n, 1).
auto product(Product member) {
    return [member](const api::TransportOperator& transport, const Doubles& x) {
        const std::vector<double> values(x.data(), x.data() + x.size());
        return vector_of(without_lock<std::vector<double>>([&] { return (transport.*member)(values); }));
    };
}

/// A property that shows a vector of the operator without a copy, one number per face.
auto per_face(const std::vector<double>& (api::TransportOperator::*member)() const) {
    return [member](const py::object& self) {
        const std::vector<double>& values = (self.cast<const api::TransportOperator&>().*member)();
        return view_of(values.data(), {static_cast<py::ssize_t>(values.size())}, self);
    };
}

api::Daylight daylight(const api::Scene& scene, const py::object& epw, const py::object& sensors,
                       const py::object& normals, double error, int division, double north, double ground,
                       const py::object& states, const py::object& progress) {
    bool is_single = false;
    const std::vector<api::Probe> probes = probes_of(sensors, normals, is_single);
    const std::string path = path_of(epw);
    const api::DaylightOptions options{error, division, north, ground, states.is_none() ? "" : path_of(states)};
    return run<api::Daylight>(
        progress, [&](const api::Control& control) { return api::daylight(scene, path, probes, options, control); });
}

/// A property that shows a vector of the object without a copy, one number per sensor.
template <class T>
auto per_sensor(const std::vector<T> api::Daylight::*member) {
    return [member](const py::object& self) {
        const std::vector<T>& values = self.cast<const api::Daylight&>().*member;
        return view_of(values.data(), {static_cast<py::ssize_t>(values.size())}, self);
    };
}

/// A property that shows one row per hour and one column per sensor.
auto per_hour(const std::vector<float> api::Daylight::*member) {
    return [member](const py::object& self) {
        const auto& d = self.cast<const api::Daylight&>();
        return view_of((d.*member).data(),
                       {static_cast<py::ssize_t>(d.hours.size()), static_cast<py::ssize_t>(d.sensors)}, self);
    };
}

constexpr const char* view_factor_arguments = R"doc(

error      limit on the error of every row; None: 1e-3 unless there is a tolerance
smallest   smaller entries are dropped
seed       seed of the random points
tolerance  relative error of every entry above 1e-6, in place of error; entries are then computed without rays
time_limit seconds. After it, or if progress stops the work, unfinished rows are empty and a RuntimeWarning tells their
           number; without a finished row an Error is raised
threads    number of threads; None: all cores, or as set by set_threads()
progress   as for solve()
returns    scipy.sparse.csr_array (n, n): entry (i, j) is the share of the flux leaving face i that reaches face j.
           Attributes, one number per face: areas (m^2), emittances, finished (False: the row was not computed), and
           without a tolerance sky, back (shares that leave the scene or reach backs of faces) and row_errors. Matrices
           that are computed from it do not have them)doc";

constexpr const char* transport_arguments = R"doc(

error      limit on the error of products for |x| <= 1
seed       seed of the random points
time_limit seconds. After it, or if progress stops the work, an Error is raised: an operator needs all rows
threads    number of threads; None: all cores, or as set by set_threads()
progress   as for solve()
returns    scipy.sparse.linalg.LinearOperator (n, n): F @ x and F.rmatvec(x); its attribute `transport` is the
           TransportOperator with areas, errors and save())doc";

constexpr const char* daylight_arguments = R"doc(

sensors    (n, 3) metres
normals    of the same shape, or (3,) for all; up by default
error      requested relative RMS error of the daylight factors and of the lux hours of the year
division   parts of Tregenza's sky patches in each direction: 1, 2 or 4
north      degrees from the y axis to north, clockwise seen from above
ground     reflectance of the ground
states     path of a TOML file with groups of panes, their states and rules, as for `exitance daylight --states`
progress   as for solve())doc";

void add_operator(py::module_& m) {
    static const std::string doc = std::string(docs::transport_operator) + transport_arguments;
    using api::TransportOperator;
    py::class_<TransportOperator>(m, "TransportOperator", docs::TransportOperator::self)
        .def_property_readonly(
            "shape", [](const TransportOperator& t) { return py::make_tuple(t.size(), t.size()); }, "(n, n), n faces.")
        .def_property_readonly(
            "dtype", [](const TransportOperator&) { return py::dtype::of<double>(); }, "float64")
        .def("matvec", product(&TransportOperator::apply), "x"_a, docs::TransportOperator::apply)
        .def("rmatvec", product(&TransportOperator::apply_transposed), "x"_a, docs::TransportOperator::apply_transposed)
        .def_property_readonly("areas", per_face(&TransportOperator::areas), docs::TransportOperator::areas)
        .def_property_readonly("emittances", per_face(&TransportOperator::emittances),
                               docs::TransportOperator::emittances)
        .def_property_readonly("sky", per_face(&TransportOperator::sky), docs::TransportOperator::sky)
        .def_property_readonly("back", per_face(&TransportOperator::back), docs::TransportOperator::back)
        .def_property_readonly("row_errors", per_face(&TransportOperator::row_errors),
                               docs::TransportOperator::row_errors)
        .def_property_readonly("closure_defect", &TransportOperator::closure_defect,
                               docs::TransportOperator::closure_defect)
        .def(
            "save",
            [](const TransportOperator& t, const py::object& path) {
                const std::string file = path_of(path);
                without_lock<void>([&] { return t.save(file); });
            },
            "path"_a, docs::TransportOperator::save)
        .def("__repr__", [](const TransportOperator& t) {
            const std::vector<double>& errors = t.row_errors();
            const double error = errors.empty() ? 0 : *std::max_element(errors.begin(), errors.end());
            return fmt::format("<exitance.TransportOperator: {} faces, {:.4g} m^2, error of rows at most {:.2g}>",
                               t.size(), std::accumulate(t.areas().begin(), t.areas().end(), 0.0), error);
        });
    m.def("transport_operator", &transport_operator, "scene"_a, "error"_a = 1e-2, py::kw_only(), "seed"_a = 1,
          "time_limit"_a = py::none(), "threads"_a = py::none(), "progress"_a = py::none(), doc.c_str());
    m.def("load_transport_operator", &load_transport_operator, "path"_a, docs::load_transport_operator);
}

void add_states_of_panes(py::module_& m) {
    py::class_<api::PaneGroup>(m, "PaneGroup", docs::PaneGroup::self)
        .def_readonly("name", &api::PaneGroup::name, "Name of the group.")
        .def_readonly("states", &api::PaneGroup::states, docs::PaneGroup::states)
        .def_property_readonly(
            "chosen",
            [](const py::object& self) {
                const std::vector<std::uint8_t>& chosen = self.cast<const api::PaneGroup&>().chosen;
                return view_of(chosen.data(), {static_cast<py::ssize_t>(chosen.size())}, self);
            },
            docs::PaneGroup::chosen);
    py::class_<api::GlassVariant>(m, "GlassVariant", docs::GlassVariant::self)
        .def_readonly("name", &api::GlassVariant::name, "Name of the variant.")
        .def_readonly("spatial_autonomy", &api::GlassVariant::spatial_autonomy, docs::GlassVariant::spatial_autonomy)
        .def_readonly("spatial_autonomy_bounds", &api::GlassVariant::spatial_autonomy_bounds,
                      docs::GlassVariant::spatial_autonomy_bounds)
        .def_readonly("continuous_autonomy", &api::GlassVariant::continuous_autonomy,
                      docs::GlassVariant::continuous_autonomy)
        .def_readonly("mean_illuminance", &api::GlassVariant::mean_illuminance, docs::GlassVariant::mean_illuminance)
        .def_readonly("sunlight_exposure", &api::GlassVariant::sunlight_exposure,
                      docs::GlassVariant::sunlight_exposure);
}

void add_daylight(py::module_& m) {
    py::class_<api::Daylight>(m, "Daylight", docs::Daylight::self)
        .def_property_readonly(
            "hours",
            [](const api::Daylight& d) {
                std::vector<std::int32_t> out;
                for (const api::Hour& h : d.hours) out.insert(out.end(), {h.month, h.day, h.hour});
                return array_of(std::move(out), {static_cast<py::ssize_t>(d.hours.size()), 3});
            },
            "Month, day and hour (1 to 24, the end) of every row.")
        .def_property_readonly("illuminance", per_hour(&api::Daylight::illuminance), docs::Daylight::illuminance)
        .def_property_readonly("sun", per_hour(&api::Daylight::sun), docs::Daylight::sun)
        .def_property_readonly("daylight_factor", per_sensor<double>(&api::Daylight::daylight_factor),
                               docs::Daylight::daylight_factor)
        .def_property_readonly("autonomy", per_sensor<double>(&api::Daylight::autonomy), docs::Daylight::autonomy)
        .def_property_readonly(
            "useful",
            [](const py::object& self) { return view_of_rows(self.cast<const api::Daylight&>().useful, self); },
            docs::Daylight::useful)
        .def_property_readonly(
            "daylight_factor_bounds",
            [](const py::object& self) {
                return view_of_rows(self.cast<const api::Daylight&>().daylight_factor_bounds, self);
            },
            docs::Daylight::daylight_factor_bounds)
        .def_property_readonly(
            "autonomy_bounds",
            [](const py::object& self) {
                return view_of_rows(self.cast<const api::Daylight&>().autonomy_bounds, self);
            },
            docs::Daylight::autonomy_bounds)
        .def_property_readonly("sunny_hours", per_sensor<double>(&api::Daylight::sunny_hours),
                               docs::Daylight::sunny_hours)
        .def_readonly("spatial_autonomy", &api::Daylight::spatial_autonomy, docs::Daylight::spatial_autonomy)
        .def_readonly("sunlight_exposure", &api::Daylight::sunlight_exposure, docs::Daylight::sunlight_exposure)
        .def_readonly("error_daylight_factor", &api::Daylight::error_daylight_factor,
                      docs::Daylight::error_daylight_factor)
        .def_readonly("error_lux_hours", &api::Daylight::error_lux_hours, docs::Daylight::error_lux_hours)
        .def_readonly("pane_groups", &api::Daylight::pane_groups, docs::Daylight::pane_groups)
        .def_readonly("glass_variants", &api::Daylight::glass_variants, docs::Daylight::glass_variants)
        .def_readonly("warnings", &api::Daylight::warnings, docs::Daylight::warnings)
        .def("__repr__", [](const api::Daylight& d) {
            return fmt::format("<exitance.Daylight: {} hours, {} sensors>", d.hours.size(), d.sensors);
        });
    static const std::string daylight_doc = std::string(docs::daylight) + daylight_arguments;
    m.def("daylight", &daylight, "scene"_a, "epw"_a, "sensors"_a, "normals"_a = py::cast(std::vector<double>{0, 0, 1}),
          "error"_a = 0.02, py::kw_only(), "division"_a = 1, "north"_a = 0.0, "ground"_a = 0.2, "states"_a = py::none(),
          "progress"_a = py::none(), daylight_doc.c_str());
}

}  // namespace

void add_measures(py::module_& m) {
    add_operator(m);
    static const std::string factors_doc = std::string(docs::view_factors) + view_factor_arguments;
    m.def("view_factors", &view_factors, "scene"_a, "error"_a = py::none(), py::kw_only(), "smallest"_a = 0.0,
          "seed"_a = 1, "tolerance"_a = py::none(), "time_limit"_a = py::none(), "threads"_a = py::none(),
          "progress"_a = py::none(), factors_doc.c_str());
    add_states_of_panes(m);
    add_daylight(m);
}

}  // namespace python
