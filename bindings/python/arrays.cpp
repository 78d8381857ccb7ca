#include "arrays.hpp"

#include <fmt/format.h>
#include <pybind11/stl.h>

namespace python {
namespace {

/// numpy.asarray(object, dtype=float64); a failure is an error of the argument `name`.
Doubles doubles_of(const py::object& object, const std::string& name) {
    try {
        return py::module_::import("numpy").attr("asarray")(object, "float64").cast<Doubles>();
    } catch (const py::error_already_set& e) {
        if (!e.matches(PyExc_ValueError) && !e.matches(PyExc_TypeError)) throw;
        raise_usage("is not an array of numbers", name);
    }
}

std::string shape_of(const py::array& array) {
    return py::repr(array.attr("shape")).cast<std::string>();
}

}  // namespace

void raise(const api::Error& error) {
    static constexpr std::array codes{"usage", "bad_input", "cannot_read", "cannot_write", "limit", "failure"};
    const py::module_ errors = py::module_::import("exitance._errors");
    const py::object type = errors.attr(error.code == api::ErrorCode::usage ? "UsageError" : "Error");
    const py::object exception =
        type(error.message, error.where, error.hint, codes[static_cast<std::size_t>(error.code)]);
    PyErr_SetObject(type.ptr(), exception.ptr());
    throw py::error_already_set();
}

void raise_usage(const std::string& message, const std::string& where, const std::string& hint) {
    raise({api::ErrorCode::usage, message, where, hint});
}

py::array array_of(const api::Vec3& v) {
    return array_of(std::vector<double>{v.x, v.y, v.z}, {3});
}

py::array array_of(const api::Spectrum& s) {
    return array_of(std::vector<double>(s.value.begin(), s.value.end()), {static_cast<py::ssize_t>(api::bands)});
}

api::Vec3 vec3_of(const py::object& object, const std::string& name) {
    const Doubles v = doubles_of(object, name);
    if (v.ndim() != 1 || v.shape(0) != 3) raise_usage("has shape " + shape_of(v) + " in place of (3,)", name);
    return {v.at(0), v.at(1), v.at(2)};
}

Doubles broadcast(const py::object& object, const std::vector<py::ssize_t>& shape, const std::string& name) {
    const Doubles given = doubles_of(object, name);
    const py::tuple wanted = py::cast(shape);
    try {
        return py::module_::import("numpy").attr("broadcast_to")(given, wanted).cast<Doubles>();
    } catch (const py::error_already_set& e) {
        if (!e.matches(PyExc_ValueError)) throw;
        raise_usage(fmt::format("has shape {}, which cannot be extended to {}", shape_of(given),
                                py::repr(wanted).cast<std::string>()),
                    name);
    }
}

api::Spectrum spectrum_of(const py::object& object, const std::string& name) {
    const Doubles values = broadcast(object, {static_cast<py::ssize_t>(api::bands)}, name);
    api::Spectrum out;
    for (std::size_t b = 0; b < api::bands; ++b) out[b] = values.at(static_cast<py::ssize_t>(b));
    return out;
}

Doubles points_of(const py::object& points, const std::string& name) {
    const Doubles x = doubles_of(points, name);
    if (x.ndim() != 2 || x.shape(1) != 3) raise_usage("has shape " + shape_of(x) + " in place of (n, 3)", name);
    return x;
}

std::vector<api::Probe> probes_of(const py::object& points, const py::object& normals, bool& is_single) {
    is_single = doubles_of(points, "points").ndim() == 1;
    const Doubles x = points_of(is_single ? py::object(py::make_tuple(points)) : points, "points");
    const Doubles n = broadcast(normals, {x.shape(0), 3}, "normals");
    std::vector<api::Probe> out(static_cast<std::size_t>(x.shape(0)));
    for (std::size_t i = 0; i < out.size(); ++i) {
        const double *p = x.data() + 3 * i, *d = n.data() + 3 * i;
        out[i] = {{p[0], p[1], p[2]}, {d[0], d[1], d[2]}};
    }
    return out;
}

std::size_t checked_index(std::ptrdiff_t index, std::size_t size, const char* name) {
    const auto count = static_cast<std::ptrdiff_t>(size);
    if (index < -count || index >= count) throw py::index_error(fmt::format("{} {} of {}", name, index, count));
    return static_cast<std::size_t>(index < 0 ? index + count : index);
}

std::string path_of(const py::object& object) {
    return py::module_::import("os").attr("fspath")(object).cast<std::string>();
}

}  // namespace python
