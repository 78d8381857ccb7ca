#pragma once

#include <pybind11/pybind11.h>

namespace python {

// Each function adds one part of the module.

void add_scenes(pybind11::module_& m);     ///< Scene, load
void add_solutions(pybind11::module_& m);  ///< Solution, solve, load_solution
void add_pictures(pybind11::module_& m);   ///< Camera, Picture, LightMaps
void add_sensors(pybind11::module_& m);    ///< glare and probes of Solution, after add_solutions()
void add_measures(pybind11::module_& m);   ///< view_factors, daylight

}  // namespace python
