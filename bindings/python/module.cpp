#include "module.hpp"

#include "exitance/spectrum.hpp"

PYBIND11_MODULE(_exitance, m) {
    m.doc() = "The compiled part of exitance.";
    m.attr("__version__") = EXITANCE_VERSION;
    m.attr("bands") = exitance::api::bands;
    python::add_scenes(m);
    python::add_pictures(m);
    python::add_solutions(m);
    python::add_sensors(m);
    python::add_measures(m);
}
