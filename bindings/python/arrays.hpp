#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <array>
#include <string>
#include <vector>

#include "exitance/error.hpp"
#include "exitance/solution.hpp"

// Conversions between NumPy arrays and the values of the library.

namespace python {

namespace py = pybind11;
namespace api = exitance::api;

/// An array of doubles in C order; arrays of another type or order are copied.
using Doubles = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Throws the Python exception of an error of the library.
[[noreturn]] void raise(const api::Error& error);
/// Throws the Python exception of a wrong argument.
[[noreturn]] void raise_usage(const std::string& message, const std::string& where, const std::string& hint = "");

/// The value of a result; throws the Python exception of its error.
template <class T>
T value_of(api::Result<T> result) {
    if (!result) raise(result.error());
    return std::move(*result);
}
inline void check(const api::Result<void>& result) {
    if (!result) raise(result.error());
}

/// A read-only array that shows memory of `owner` without a copy.
/// shape  extents, slowest first
template <class T>
py::array view_of(const T* data, std::vector<py::ssize_t> shape, const py::object& owner) {
    py::array_t<T> array(std::move(shape), data, owner);
    array.attr("flags").attr("writeable") = false;
    return array;
}

/// A read-only array of rows, which show memory of `owner`.
template <class T, std::size_t n>
py::array view_of_rows(const std::vector<std::array<T, n>>& rows, const py::object& owner) {
    return view_of(reinterpret_cast<const T*>(rows.data()),
                   {static_cast<py::ssize_t>(rows.size()), static_cast<py::ssize_t>(n)}, owner);
}

/// A read-only array that takes over the values of a vector.
template <class T>
py::array array_of(std::vector<T> values, std::vector<py::ssize_t> shape) {
    auto* const kept = new std::vector<T>(std::move(values));
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<T>*>(p); });
    return view_of(kept->data(), std::move(shape), owner);
}
template <class T, std::size_t n>
py::array array_of_rows(std::vector<std::array<T, n>> rows, std::vector<py::ssize_t> shape) {
    auto* const kept = new std::vector<std::array<T, n>>(std::move(rows));
    const py::capsule owner(kept, [](void* p) { delete static_cast<std::vector<std::array<T, n>>*>(p); });
    return view_of(reinterpret_cast<const T*>(kept->data()), std::move(shape), owner);
}

py::array array_of(const api::Vec3& v);
py::array array_of(const api::Spectrum& s);
/// Three numbers. `name`: the argument, for errors.
api::Vec3 vec3_of(const py::object& object, const std::string& name);
/// One number for all bands, or one per band.
api::Spectrum spectrum_of(const py::object& object, const std::string& name);
/// Points of shape (3,) or (n, 3), and normals of the same shape or (3,).
/// is_single  true if `points` is one point of shape (3,)
std::vector<api::Probe> probes_of(const py::object& points, const py::object& normals, bool& is_single);
/// Points of shape (n, 3). `name`: the argument, for errors.
Doubles points_of(const py::object& points, const std::string& name);
/// Index of an item of a list, where negative numbers count from the end, as in Python. Throws IndexError if there is
/// no such item. `name`: the kind of item, for errors.
std::size_t checked_index(std::ptrdiff_t index, std::size_t size, const char* name);
/// A path or a text as a text.
std::string path_of(const py::object& object);

/// numpy.broadcast_to of an array of doubles. `name`: the argument, for errors.
Doubles broadcast(const py::object& object, const std::vector<py::ssize_t>& shape, const std::string& name);

}  // namespace python
